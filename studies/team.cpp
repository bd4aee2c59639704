#include "studies/team.hpp"

#include <algorithm>
#include <system_error>

namespace acstudy {

namespace {

/// Looks for a change some microseconds long before it lets the processor go: rounds follow each other that closely.
template <class Changed>
bool spin(Changed&& changed) {
  constexpr int looks = 4000;
  for (int i = 0; i < looks; ++i) {
    if (changed()) return true;
  }
  return false;
}

}  // namespace

Team::Team(int threads) {
  try {
    for (int i = 1; i < threads; ++i) others_.emplace_back([this] { serve(); });
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
  // Several pieces a thread, so that one who is held up holds up no other.
  const std::ptrdiff_t pieces = 8 * (std::ssize(others_) + 1);
  count_ = count;
  piece_ = (count / pieces / grain + 1) * grain;
  work_ = &work;
  next_ = 0;
  busy_ = static_cast<int>(others_.size());
  ++round_;
  round_.notify_all();
  take_pieces();
  while (const int busy = busy_) {
    if (!spin([&] { return busy_ == 0; })) busy_.wait(busy);
  }
}

void Team::serve() {
  unsigned seen = 0;
  for (;;) {
    if (!spin([&] { return round_ != seen; })) round_.wait(seen);
    seen = round_;
    if (ends_) return;
    take_pieces();
    if (--busy_ == 0) busy_.notify_all();
  }
}

void Team::take_pieces() {
  for (;;) {
    const std::ptrdiff_t begin = next_.fetch_add(piece_);
    if (begin >= count_) return;
    (*work_)(begin, std::min(begin + piece_, count_));
  }
}

}  // namespace acstudy
