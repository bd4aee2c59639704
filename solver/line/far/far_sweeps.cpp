#include "solver/line/far/far_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "solver/line/far/exponential_sum.hpp"

namespace acstudy::far {

namespace baseline {
extern const FarSweeps table;
}
#ifdef ACSTUDY_X86_64_V3
namespace v3 {
extern const FarSweeps table;
}
#endif
#ifdef ACSTUDY_X86_64_V4
namespace v4 {
extern const FarSweeps table;
}
#endif

const FarSweeps& far_sweeps() {
  static const FarSweeps& chosen = []() -> const FarSweeps& {
    const std::string name = sweeps().name;
#ifdef ACSTUDY_X86_64_V4
    if (v4::table.name == name) return v4::table;
#endif
#ifdef ACSTUDY_X86_64_V3
    if (v3::table.name == name) return v3::table;
#endif
    if (baseline::table.name != name) throw std::logic_error("no far sweeps for " + name);
    return baseline::table;
  }();
  return chosen;
}

bool upwind_far_pays(SweepKernel::Form kernel, double neighbors) {
  switch (kernel) {
    case SweepKernel::Form::inverse:
      return neighbors >= 160.0;
    case SweepKernel::Form::cubic_spline:
      return neighbors >= 208.0;
    default:
      return false;
  }
}

bool symmetric_far_pays(SweepKernel::Form kernel, double neighbors, bool both) {
  return kernel == SweepKernel::Form::cubic_spline && neighbors >= (both ? 256.0 : 208.0);
}

std::ptrdiff_t range_size(std::ptrdiff_t count, double neighbors) {
  const double wanted = std::max(1024.0, 4.0 * neighbors);
  const auto ranges = std::max<std::ptrdiff_t>(1, std::lround(static_cast<double>(count) / wanted));
  return (count + 8 * ranges - 1) / (8 * ranges) * 8;
}

}  // namespace acstudy::far
