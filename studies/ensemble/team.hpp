#pragma once

/// @file
/// Threads that share the work of one case.

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace acstudy {

/// Calls a function for pieces of a range, from several threads. With one thread there is none but the caller.
class Team {
 public:
  /// @param threads  >= 1, the caller among them; fewer if the machine gives no more
  explicit Team(int threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls work(begin, end) for pieces that together are 0 .. count - 1; every piece but the last begins and ends at a
  /// multiple of `grain`, whatever the number of threads. Returns when all are done. `work` must not throw.
  void each(std::ptrdiff_t count, std::ptrdiff_t grain,
            const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>& work);

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
  const std::function<void(std::ptrdiff_t, std::ptrdiff_t)>* work_ = nullptr;
};

}  // namespace acstudy
