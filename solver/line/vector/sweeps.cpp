#include "solver/line/vector/sweeps.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace acstudy {

namespace baseline {
extern const Sweeps table;
}
#ifdef ACSTUDY_X86_LEVELS
namespace v3 {
extern const Sweeps table;
}
namespace v4 {
extern const Sweeps table;
}
#endif

namespace {

/// Widest first.
std::vector<const Sweeps*> available() {
  std::vector<const Sweeps*> all;
#ifdef ACSTUDY_X86_LEVELS
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd")) {
    all.push_back(&v4::table);
  }
  if (v3) all.push_back(&v3::table);
#endif
  all.push_back(&baseline::table);
  return all;
}

const Sweeps& choose() {
  const auto all = available();
  const char* const wanted = std::getenv("ACSTUDY_VECTOR");
  if (wanted == nullptr) return *all.front();
  std::string names;
  for (const Sweeps* each : all) {
    if (each->name == std::string(wanted)) return *each;
    names += (names.empty() ? "" : ", ") + std::string(each->name);
  }
  throw std::runtime_error("ACSTUDY_VECTOR=" + std::string(wanted) + ": this machine has " + names);
}

}  // namespace

const Sweeps& sweeps() {
  static const Sweeps& chosen = choose();
  return chosen;
}

}  // namespace acstudy
