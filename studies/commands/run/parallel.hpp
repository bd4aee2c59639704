#pragma once

/// @file
/// Threads that do the same until there is nothing left to do.

#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace acstudy {

/// Calls `work()` from so many threads, again and again until it returns false or throws in one of them; what is
/// thrown comes back. Where there is nothing to do for now, but may be later, `work` waits.
template <class Work>
std::exception_ptr in_parallel(std::size_t count, Work&& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (;;) {
      {
        const std::lock_guard lock(mutex);
        if (failure) return;
      }
      try {
        if (!work()) return;
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (std::size_t t = 1; t < count; ++t) threads.emplace_back(worker);
  } catch (const std::system_error&) {
    // The machine gives no more threads; those that run share the work.
  }
  worker();
  for (std::thread& thread : threads) thread.join();
  return failure;
}

}  // namespace acstudy
