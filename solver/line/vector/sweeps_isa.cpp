// Compiled once per instruction set; ACSTUDY_ISA and ACSTUDY_ISA_NAME are given on the command line.

#include "solver/line/vector/banded.hpp"
#include "solver/line/vector/rows.hpp"
#include "solver/line/vector/series.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "solver/line/vector/symmetric.hpp"
#include "solver/line/vector/upwind.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

extern const Sweeps table;
const Sweeps table = {ACSTUDY_ISA_NAME, lane_count,     upwind_sweep, symmetric_sweep,
                      upwind_rows,      symmetric_rows, banded_sweep, evaluate_series};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
