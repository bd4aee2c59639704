#include "solver/line/vector/sweeps.hpp"

#include <algorithm>
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

BandedMatrix::BandedMatrix(const RateMatrix& R, int lanes) {
  const auto n = static_cast<std::ptrdiff_t>(R.size());
  // A column to the left of its row by less than half a turn, or to the right.
  const auto offset_of = [&](std::ptrdiff_t row, std::ptrdiff_t entry) {
    const std::ptrdiff_t offset = R.column[entry] - row;
    return 2 * offset > n ? offset - n : 2 * offset < -n ? offset + n : offset;
  };
  for (std::ptrdiff_t row = 0; row < n; row += lanes) {
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(row + lanes, n);
    std::ptrdiff_t first = 0, last = 0;
    for (std::ptrdiff_t j = row; j < end; ++j) {
      for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) {
        first = std::min(first, offset_of(j, e));
        last = std::max(last, offset_of(j, e));
      }
    }
    const Block block{std::ssize(value), first, last - first + 1};
    value.resize(value.size() + block.width * lanes);
    for (std::ptrdiff_t j = row; j < end; ++j) {
      for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) {
        value[block.begin + (offset_of(j, e) - first) * lanes + (j - row)] += R.value[e];
      }
    }
    blocks.push_back(block);
    reach = std::max({reach, -first, last + lanes});
  }
}

const Sweeps& sweeps() {
  static const Sweeps& chosen = choose();
  return chosen;
}

}  // namespace acstudy
