// Implicit steps of a group, and steps that follow its rows.

#include <algorithm>
#include <span>
#include <stdexcept>

#include "studies/models/scheme.hpp"
#include "studies/running/ensemble/sweep_group.hpp"

namespace acstudy {

void SweepGroup::sweep_rows(Team& team, bool decay_alone) {
  const std::ptrdiff_t count = std::ssize(particles_.x), lanes = sweeps().lanes;
  SweepRange range{particles_.x.at(0), delta_, particles_.inside(delta_), 0, count};
  SweepRows rows;
  if (by_rows_) rows.decay = decay_.data();
  if (!decay_alone) {
    if (local_ != nullptr) rows.own_local = own_local_.data();
    if (nonlocal_ != nullptr) rows.own_nonlocal = own_nonlocal_.data();
  }
  const auto sweep_once = [&](const auto& sweep, auto run) {
    if (!decay_alone) {
      const std::ptrdiff_t blocks = (count + lanes - 1) / lanes;
      rows_.lanes = lanes;
      rows_.blocks.resize(static_cast<std::size_t>(blocks));
      rows_.value.resize(static_cast<std::size_t>(blocks * (2 * room_ + 1) * lanes));
      rows.room = room_;
      rows.blocks = rows_.blocks.data();
      rows.value = rows_.value.data();
    }
    PerThread<std::ptrdiff_t> widest(team, 0);
    team.each(count, 32, [&](const Piece& piece) {
      SweepRange part = range;
      part.begin = piece.begin;
      part.end = piece.end;
      widest[piece] = std::max(widest[piece], run(part, sweep, rows));
    });
    return widest.all([](std::ptrdiff_t a, std::ptrdiff_t b) { return std::max(a, b); });
  };
  const auto sweep_until_there_is_room = [&](const auto& sweep, auto run) {
    const std::ptrdiff_t widest = sweep_once(sweep, run);
    if (decay_alone || widest <= room_) return;
    room_ = widest + widest / 4;  // windows of particles that gather grow
    sweep_once(sweep, run);
  };
  if (model_->vector_form == VectorForm::upwind) {
    sweep_until_there_is_room(upwind_sweep({}, {}), sweeps().upwind_rows);
  } else {
    sweep_until_there_is_room(symmetric_sweep({}, {}), sweeps().symmetric_rows);
  }
  ++work_.weight_builds;
  if (!by_rows_) return;
  strongest_decay_ = *std::max_element(decay_.begin(), decay_.begin() + count);
  decay_known_for_ = particles_.times_moved();
}

double SweepGroup::strongest_decay(Team& team) {
  if (!standing_ && decay_known_for_ != particles_.times_moved()) {
    team.timed(seconds, [&] { sweep_rows(team, true); });
  }
  return strongest_decay_;
}

void SweepGroup::solve(Team& team, double scale) {
  team.timed(seconds, [&] {
    if (!standing_) sweep_rows(team, false);
    SweptValues* const both[] = {local_, nonlocal_};
    team.each(2, 1, [&](const Piece& piece) {
      for (std::ptrdiff_t i = piece.begin; i < piece.end; ++i) {
        if (both[i] == nullptr) continue;
        SweptValues& values = *both[i];
        try {
          if (!standing_) {
            const ZeroedVector& own = i == 0 ? own_local_ : own_nonlocal_;
            values.solver.factorize(rows_, std::span(own).first(particles_.size()), scale);
          } else if (values.factorized_for != scale) {
            values.factorized_for = 0.0;
            values.solver.factorize(standing_entries_, scale);
            values.factorized_for = scale;
          }
          values.solver.solve(values.u.values());
        } catch (const std::domain_error& error) {
          values.failure = error.what();
        }
      }
    });
  });
}

}  // namespace acstudy
