#include "studies/storing/estimates.hpp"

#include <cmath>

namespace acstudy {

std::vector<std::pair<std::string, double>> named_estimates(const Judgement& j) {
  const auto number = [](std::size_t level) { return static_cast<double>(level + 1); };
  return {{"order", j.order},
          {"low", j.low},
          {"high", j.high},
          {"window_first", number(j.window.first)},
          {"window_last", number(j.window.last)},
          {"fitted", j.fitted.order},
          {"fitted_low", j.fitted.low},
          {"fitted_high", j.fitted.high},
          {"extrapolated_low", j.corrected.low},
          {"extrapolated_high", j.corrected.high},
          {"correction_D", j.corrected.D},
          {"correction_q", j.corrected.q},
          {"floor", j.floored.F},
          {"floor_order", j.floored.order},
          {"floor_low", j.floored.low},
          {"floor_high", j.floored.high},
          {"leave_one_out", j.leave_one_out.change},
          {"leave_one_out_level", std::isnan(j.leave_one_out.change) ? not_estimated : number(j.leave_one_out.level)}};
}

}  // namespace acstudy
