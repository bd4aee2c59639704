#include "studies/running/ensemble/team.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace acstudy {

namespace {

std::ptrdiff_t quotient_up(std::ptrdiff_t whole, std::ptrdiff_t part) { return (whole + part - 1) / part; }

/// Looks for a change for about a millisecond before it sleeps: rounds follow each other that closely, and to be woken
/// takes longer than many of them. Soon it lets others have the processor, for who is waited for may need this one.
template <class Changed>
bool spin(Changed&& changed) {
  using clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  const auto start = clock::now();
  for (auto waited = 0ns; waited < 1ms; waited = clock::now() - start) {
    for (int i = 0; i < 64; ++i) {
      if (changed()) return true;
    }
    if (waited > 20us) std::this_thread::yield();
  }
  return false;
}

}  // namespace

Team::Team(int threads) : parts_(static_cast<std::size_t>(threads)) {
  try {
    for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { serve(static_cast<std::size_t>(i)); });
  } catch (const std::system_error&) {
    // The machine gives no more; those that run share the work.
  }
}

Team::~Team() {
  ends_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& thread : others_) thread.join();
}

std::ptrdiff_t Team::piece_size(std::ptrdiff_t count, std::ptrdiff_t grain) const {
  // Several pieces a thread, so that one who is held up holds up no other.
  const std::ptrdiff_t threads = std::ssize(parts_), most_particles = 1024;
  const std::ptrdiff_t pieces =
      std::max(quotient_up(count, threads * most_particles), std::ptrdiff_t{threads > 1 ? 4 : 1}) * threads;
  return quotient_up(quotient_up(count, pieces), grain) * grain;
}

void Team::each(std::ptrdiff_t count, std::ptrdiff_t grain, const Work& work) {
  // Each begins with the same part of the range every time, which is in its cache.
  const std::ptrdiff_t threads = std::ssize(parts_);
  piece_ = piece_size(count, grain);
  const std::ptrdiff_t part = quotient_up(quotient_up(count, piece_), threads) * piece_;
  for (std::ptrdiff_t i = 0; i < threads; ++i) {
    parts_[i].next = std::min(i * part, count);
    parts_[i].end = std::min((i + 1) * part, count);
  }
  work_ = &work;
  if (others_.empty() || count <= piece_) {
    take_pieces(0);
    return;
  }
  busy_ = static_cast<int>(others_.size());
  ++round_;
  round_.notify_all();
  take_pieces(0);
  while (const int busy = busy_) {
    if (!spin([&] { return busy_ == 0; })) busy_.wait(busy);
  }
}

void Team::serve(std::size_t own) {
  unsigned seen = 0;
  for (;;) {
    if (!spin([&] { return round_ != seen; })) round_.wait(seen);
    seen = round_;
    if (ends_) return;
    take_pieces(own);
    if (--busy_ == 0) busy_.notify_all();
  }
}

void Team::take_pieces(std::size_t own) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[(own + i) % parts_.size()];
    for (;;) {
      const std::ptrdiff_t begin = part.next.fetch_add(piece_);
      if (begin >= part.end) break;
      (*work_)({begin, std::min(begin + piece_, part.end), own, own == 0 ? weight_ : 0.0});
    }
  }
}

}  // namespace acstudy
