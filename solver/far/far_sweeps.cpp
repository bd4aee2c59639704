#include "solver/far/far_sweeps.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "solver/far/exponential_sum.hpp"

namespace acstudy::far {

namespace baseline {
extern const FarSweeps table;
}
#ifdef ACSTUDY_X86_LEVELS
namespace v3 {
extern const FarSweeps table;
}
namespace v4 {
extern const FarSweeps table;
}
#endif

const FarSweeps& far_sweeps() {
  static const FarSweeps& chosen = []() -> const FarSweeps& {
    const std::string name = sweeps().name;
#ifdef ACSTUDY_X86_LEVELS
    for (const FarSweeps* table : {&v4::table, &v3::table}) {
      if (table->name == name) return *table;
    }
#endif
    if (baseline::table.name != name) throw std::logic_error("no far sweeps for " + name);
    return baseline::table;
  }();
  return chosen;
}

bool far_pays(SweepKernel::Form upwind_kernel, double neighbors) {
  return upwind_kernel == SweepKernel::Form::inverse && neighbors >= 256.0;
}

std::ptrdiff_t range_size(std::ptrdiff_t neighbors) { return std::max<std::ptrdiff_t>(1024, 4 * neighbors); }

int log2_ratio_for(std::ptrdiff_t neighbors) {
  int log2_ratio = 0;
  while (log2_ratio < max_log2_ratio && neighbors >= std::ptrdiff_t{48} << log2_ratio) ++log2_ratio;
  return log2_ratio;
}

}  // namespace acstudy::far
