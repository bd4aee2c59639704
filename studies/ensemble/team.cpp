#include "studies/ensemble/team.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace acstudy {

namespace {

/// Looks for a change for about a millisecond before it lets the processor go: rounds follow each other that closely,
/// and to be woken takes longer than many of them.
template <class Changed>
bool spin(Changed&& changed) {
  using clock = std::chrono::steady_clock;
  for (const auto end = clock::now() + std::chrono::milliseconds(1); clock::now() < end;) {
    for (int i = 0; i < 64; ++i) {
      if (changed()) return true;
    }
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

void Team::each(std::ptrdiff_t count, std::ptrdiff_t grain,
                const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>& work) {
  if (others_.empty() || count <= grain) {
    work(0, count);
    return;
  }
  // Several pieces a thread, so that one who is held up holds up no other; each begins with the same part of the range
  // every time, which is in its cache.
  const std::ptrdiff_t threads = std::ssize(parts_), pieces = 32 * threads;
  piece_ = (count / pieces / grain + 1) * grain;
  const std::ptrdiff_t part = (count / threads / piece_ + 1) * piece_;
  for (std::ptrdiff_t i = 0; i < threads; ++i) {
    parts_[i].next = std::min(i * part, count);
    parts_[i].end = std::min((i + 1) * part, count);
  }
  work_ = &work;
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
      (*work_)(begin, std::min(begin + piece_, part.end));
    }
  }
}

}  // namespace acstudy
