#pragma once

/// @file
/// Threads that share the work of one case.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "studies/running/stopwatch.hpp"

namespace acstudy {

/// A part of a range of particles, small enough that what one step of a pass leaves of it is in the cache for the next.
struct Piece {
  std::ptrdiff_t begin, end;
  std::size_t thread;  ///< who has it; 0 is the caller
  double weight;       ///< how many passes its times stand for; 0: they are not taken

  std::ptrdiff_t size() const { return end - begin; }
  /// The piece's part of an array over all particles.
  template <class T>
  std::span<T> of(std::span<T> all) const {
    return all.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(size()));
  }
};

/// Calls a function for pieces of a range, from several threads. With one thread there is none but the caller.
class Team {
 public:
  using Work = std::function<void(const Piece&)>;

  /// @param threads  >= 1, the caller among them; fewer if the machine gives no more
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  std::size_t threads() const { return parts_.size(); }

  /// Calls work(piece) for pieces that together are 0 .. count - 1; every piece but the last begins and ends at a
  /// multiple of `grain`, whatever the number of threads. Returns when all are done. `work` must not throw.
  void each(std::ptrdiff_t count, std::ptrdiff_t grain, const Work& work);
  /// The size of these pieces, but for the last one.
  std::ptrdiff_t piece_size(std::ptrdiff_t count, std::ptrdiff_t grain) const;

  /// From now on the times of a pass stand for so many passes; 0: none are taken. The clock takes a tenth of a short
  /// pass.
  void weigh(double weight) { weight_ = weight; }
  /// Adds to `seconds` how long `work` takes, by weight.
  template <class Work_>
  void timed(double& seconds, Work_&& work) const {
    if (weight_ == 0.0) return void(work());
    double own = 0.0;
    acstudy::timed(own, work);
    seconds += weight_ * own;
  }

 private:
  /// One thread's part of the range: what is not yet taken of it.
  struct alignas(64) Part {
    std::atomic<std::ptrdiff_t> next{0};
    std::ptrdiff_t end = 0;
  };
  void serve(std::size_t own);
  void take_pieces(std::size_t own);

  std::vector<std::thread> others_;
  std::atomic<unsigned> round_{0};  ///< counts calls of each() and the end
  std::atomic<int> busy_{0};        ///< others that have not finished the round
  std::atomic<bool> ends_{false};
  std::vector<Part> parts_;
  std::ptrdiff_t piece_ = 0;
  double weight_ = 1.0;
  const Work* work_ = nullptr;
};

/// A value of each thread of a team, in a cache line of its own.
template <class T>
class PerThread {
 public:
  PerThread(const Team& team, T value) : slots_(team.threads(), Slot{value}) {}
  void fill(T value) { std::fill(slots_.begin(), slots_.end(), Slot{value}); }
  T& operator[](const Piece& piece) { return slots_[piece.thread].value; }
  /// combine(... combine(first, second) ..., last).
  template <class Combine>
  T all(Combine&& combine) const {
    T value = slots_.front().value;
    for (std::size_t i = 1; i < slots_.size(); ++i) value = combine(value, slots_[i].value);
    return value;
  }

 private:
  struct alignas(64) Slot {
    T value;
  };
  std::vector<Slot> slots_;
};

/// Tells apart what the parts of a pass take: by the clock of the caller, who does the same as all others.
class Laps {
 public:
  explicit Laps(const Piece& piece) : weight_(piece.weight) {
    if (weight_ > 0.0) last_ = std::chrono::steady_clock::now();
  }
  /// Adds the time since the last call to a part, by weight.
  void end_of(double& part_seconds) {
    if (weight_ == 0.0) return;
    const auto now = std::chrono::steady_clock::now();
    part_seconds += weight_ * std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  double weight_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace acstudy
