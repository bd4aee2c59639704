#include "studies/running/ensemble/sweep_group.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "solver/clones.hpp"
#include "solver/line/far/far_sweeps.hpp"
#include "studies/models/kernel_choice.hpp"
#include "studies/models/scheme.hpp"

namespace acstudy {

namespace {

ACSTUDY_VECTOR_CLONES void product(const double* a, const double* b, std::span<double> out) {
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = a[j] * b[j];
}

}  // namespace

struct SweepGroup::Kernel {
  AnyKernel kernel;
  SweepKernel sweep;

  explicit Kernel(const KernelChoice& choice) : kernel(choice.kernel()) {
    sweep.form = choice.form();
    std::visit(
        [&]<class K>(const K& k) {
          sweep.kernel = &k;
          sweep.first_moment = [](const void* itself, double z) {
            return static_cast<const K*>(itself)->first_moment(z);
          };
          if constexpr (std::is_base_of_v<PiecewiseKernel, K>) {
            const KernelPieces& pieces = k.pieces();
            sweep.pieces = {.count = std::ssize(pieces.origin),
                            .terms = static_cast<std::ptrdiff_t>(pieces.terms),
                            .bounds = pieces.bounds.data(),
                            .origin = pieces.origin.data(),
                            .direction = pieces.direction.data(),
                            .moment = pieces.moment.data(),
                            .mass = pieces.mass.data()};
          }
          if constexpr (IntegrableKernel<K>) {
            sweep.mass = [](const void* itself, double z) { return static_cast<const K*>(itself)->mass(z); };
          }
        },
        kernel);
  }
};

SweepGroup::SweepGroup(const Case& c, const SharedParticles& particles, bool far)
    : particles_(particles),
      far_(far),
      kernel_(std::make_unique<Kernel>(c.scheme.kernel)),
      model_(c.scheme.model),
      delta_(c.delta),
      mu_(c.mu),
      kernel_label_(c.scheme.kernel.label()),
      by_rows_(c.step.bound == StepRule::Bound::rows) {
  const std::size_t of_rows = c.integrator->implicit() ? particles.size() + 16 : 0;
  if (!c.scene->standing()) {
    own_local_.resize(of_rows);
    own_nonlocal_.resize(of_rows);
    if (by_rows_) decay_.resize(particles.size() + 16);
    room_ = static_cast<std::ptrdiff_t>(c.delta / c.h) + 2;
    return;
  }
  const std::unique_ptr<LineScheme> readable = make_scheme(c.scheme, *c.scene, c.mu);
  Particles at_rest(particles.size(), c.scene->period(), c.delta);
  at_rest.place(particles.x.values());
  readable->place(at_rest);
  RateMatrix R;
  readable->rows()->matrix(R);
  strongest_decay_ = readable->rows()->strongest_decay();
  standing_ = std::make_unique<BandedMatrix>(R, sweeps().lanes);
  standing_pairs_ = std::ssize(R.value) - std::ssize(particles.x);
  work_.weight_builds = 1;
  if (of_rows > 0) standing_entries_ = std::move(R);
}

bool SweepGroup::far_pays(const Case& c, bool modes, bool both) {
  const SweepKernel::Form kernel = c.scheme.kernel.form();
  const double neighbors = c.delta / c.scene->period() * static_cast<double>(c.N);
  switch (c.scheme.model->vector_form) {
    case VectorForm::none:
      return false;
    case VectorForm::upwind:
      return far::upwind_far_pays(kernel, neighbors);
    case VectorForm::symmetric:
      return modes && far::symmetric_far_pays(kernel, neighbors, both);
  }
  return false;
}

SweepGroup::~SweepGroup() = default;
SweepGroup::SweepGroup(SweepGroup&&) noexcept = default;

bool SweepGroup::takes(const Case& c) const {
  const SweptValues* const there = c.scheme.nonlocal_divergence ? nonlocal_ : local_;
  return there == nullptr && c.scheme.model == model_ && c.delta == delta_ && c.mu == mu_ &&
         c.scheme.kernel.label() == kernel_label_;
}

void SweepGroup::add(const Case& c, SweptValues& values) {
  // Where particles stand still the two are one and the same; each has its own place all the same.
  (c.scheme.nonlocal_divergence ? nonlocal_ : local_) = &values;
}

void SweepGroup::remove(const SweptValues& values) {
  if (local_ == &values) local_ = nullptr;
  if (nonlocal_ == &values) nonlocal_ = nullptr;
}

void SweepGroup::prepare(const Piece& piece, Laps& laps) {
  if (standing_ || model_->vector_form != VectorForm::upwind) return;
  for (SweptValues* values : {local_, nonlocal_}) {
    if (values == nullptr) continue;
    product(particles_.c_hat.at(piece.begin), values->u.at(piece.begin), piece.of(values->flux.values()));
  }
  laps.end_of(seconds);
}

void SweepGroup::rates(Team& team, const AndThen& and_then) {
  standing_ ? sweep_standing(team, and_then) : sweep_moving(team, and_then);
}

void SweepGroup::sweep_standing(Team& team, const AndThen& and_then) {
  const std::ptrdiff_t lanes = sweeps().lanes;
  team.timed(seconds, [&] {
    for (SweptValues* values : {local_, nonlocal_}) {
      if (values != nullptr) values->u.wrap(standing_->reach);
    }
  });
  team.each(std::ssize(particles_.x), 32, [&](const Piece& piece) {
    Laps laps(piece);
    for (SweptValues* values : {local_, nonlocal_}) {
      if (values == nullptr) continue;
      sweeps().banded(standing_->blocks.data(), standing_->value.data(), values->u.at(0), values->rate.data(),
                      piece.begin / lanes, (piece.end + lanes - 1) / lanes);
    }
    laps.end_of(seconds);
    and_then(piece);
  });
  work_.pairs += standing_pairs_;
}

namespace {

const double* begin_of(const PeriodicArray& field) { return field.size() > 0 ? field.at(0) : nullptr; }

}  // namespace

UpwindSweep SweepGroup::upwind_sweep(const SweepScheme& local, const SweepScheme& nonlocal) const {
  return {kernel_->sweep,
          begin_of(particles_.c_hat),
          begin_of(particles_.b_prime),
          begin_of(particles_.c),
          begin_of(particles_.b),
          local,
          nonlocal};
}

SymmetricSweep SweepGroup::symmetric_sweep(const SweepScheme& local, const SweepScheme& nonlocal) const {
  const MidpointModes modes = particles_.modes.value_or(MidpointModes{});
  SymmetricSweep sweep{.kernel = kernel_->sweep,
                       .mu = mu_,
                       .x = particles_.x.at(0),
                       .panels = particles_.panels ? particles_.panels->view() : SweepPanels{},
                       .half_cosine = {},
                       .half_sine = {},
                       .c = modes.c,
                       .b = modes.b,
                       .b_prime = begin_of(particles_.b_prime),
                       .local = local,
                       .nonlocal = nonlocal};
  // Modes that there are not have coefficients of zero; what they are read from is of no matter.
  const int count_of_modes = static_cast<int>(modes.number.size());
  for (int k = 0; k < most_modes; ++k) {
    sweep.half_cosine[k] = k < count_of_modes ? particles_.mode_cosine[k].at(0) : particles_.x.at(0);
    sweep.half_sine[k] = k < count_of_modes ? particles_.mode_sine[k].at(0) : particles_.x.at(0);
  }
  return sweep;
}

void SweepGroup::sweep_moving(Team& team, const AndThen& and_then) {
  const std::ptrdiff_t count = std::ssize(particles_.x), reach = particles_.reach(delta_), lanes = sweeps().lanes;
  const bool upwind = model_->vector_form == VectorForm::upwind;
  const auto scheme = [&](SweptValues* values) {
    SweepScheme swept;
    if (values == nullptr) return swept;
    if (upwind) {
      values->flux.wrap(reach);
      swept.flux = values->flux.at(0);
    }
    values->u.wrap(upwind ? lanes : reach);
    swept.u = values->u.at(0);
    swept.rate = values->rate.data();
    return swept;
  };
  SweepScheme local, nonlocal;
  team.timed(seconds, [&] {
    local = scheme(local_);
    nonlocal = scheme(nonlocal_);
  });
  const SweepRange whole{particles_.x.at(0), delta_, particles_.inside(delta_), 0, count};
  PerThread<std::int64_t> pairs(team, 0);
  const auto each_range = [&](std::ptrdiff_t grain, auto run) {
    team.each(count, grain, [&](const Piece& piece) {
      Laps laps(piece);
      run(piece);
      laps.end_of(seconds);
      and_then(piece);
    });
  };
  const auto range_of = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    SweepRange range = whole;
    range.begin = begin;
    range.end = end;
    return range;
  };
  const auto run = [&](const auto& sweep, auto direct, auto far) {
    if (far_) {
      const double neighbors = delta_ / particles_.scene().period() * static_cast<double>(count);
      // Far sums depend on where a range begins, by round-off: ranges are cut the same way for any number of threads.
      const std::ptrdiff_t size = far::range_size(count, neighbors);
      each_range(size, [&, size](const Piece& piece) {
        thread_local far::Memory memory;
        for (std::ptrdiff_t begin = piece.begin; begin < piece.end; begin += size) {
          pairs[piece] += far(range_of(begin, std::min(begin + size, piece.end)), sweep, memory);
        }
      });
    } else {
      each_range(32, [&](const Piece& piece) { pairs[piece] += direct(range_of(piece.begin, piece.end), sweep); });
    }
  };
  if (upwind) {
    run(upwind_sweep(local, nonlocal), sweeps().upwind, far::far_sweeps().upwind);
  } else {
    run(symmetric_sweep(local, nonlocal), sweeps().symmetric, far::far_sweeps().symmetric);
  }
  work_.pairs += pairs.all(std::plus<>());
  ++work_.weight_builds;
}

}  // namespace acstudy
