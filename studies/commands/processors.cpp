#include "studies/commands/processors.hpp"

#include <sched.h>

#include <algorithm>
#include <thread>

namespace acstudy {

int available_processors() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace acstudy
