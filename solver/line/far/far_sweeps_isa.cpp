// Compiled once per instruction set; ACSTUDY_ISA and ACSTUDY_ISA_NAME are given on the command line.

#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/far/symmetric.hpp"
#include "solver/line/far/upwind.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

extern const FarSweeps table;
const FarSweeps table = {ACSTUDY_ISA_NAME, upwind_sweep, symmetric_sweep};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
