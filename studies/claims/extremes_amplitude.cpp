#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/claims/extreme_rows.hpp"

namespace acstudy {

namespace {

const std::string amplitude = "amplitude 1e300 and 1e-300";
constexpr std::int64_t N_amplitude = 32, steps_amplitude = 12;

/// The paper's scene to T = 1/8, u times a factor.
std::shared_ptr<const Scene> scaled(double factor, const std::string& plus = "") {
  SceneText text = scene_named("lee-du-2019")->text();
  text.name.clear();
  text.T = "1/8";
  text.u = fmt::format("{:.17g}*(cos(x - t){})", factor, plus);
  return std::make_shared<const Scene>(text);
}

/// A whole run with u times each factor, against the one with u itself.
/// @param plus  is added to u in the scaled run alone: "" but for a control
void compare_runs(Finding& row, const Subject& subject, double ratio, const std::vector<double>& factors,
                  const std::string& plus = "") {
  const auto solve = [&](double factor, const std::string& more) {
    Subject one = subject;
    one.scene = scaled(factor, more);
    const double h = one.scene->period() / static_cast<double>(N_amplitude);
    return run(case_of(one, N_amplitude, ratio * h, steps_amplitude, "ssprk3"));
  };
  const CaseResult base = solve(1.0, "");
  for (const double factor : factors) {
    const CaseResult result = solve(factor, plus);
    const bool exact = std::exp2(std::round(std::log2(factor))) == factor;
    // Three stages a step, each with a rounding per neighbor and a few more; nothing grows by more than e in this time.
    const double rounded = std::exp(1.0) * 3.0 * static_cast<double>(steps_amplitude) * (4.0 * ratio + 24.0) * epsilon;
    const auto add = [&](const std::string& what, double value, double upper) {
      row.points.push_back({.N = N_amplitude,
                            .delta = ratio * 2.0 * std::numbers::pi / static_cast<double>(N_amplitude),
                            .variable = factor,
                            .value = value,
                            .upper = upper,
                            .label = fmt::format("{}, factor {:.3g}", what, factor)});
    };
    double farthest = result.blow_up.empty() ? 0.0 : NAN;
    for (std::size_t j = 0; j < result.u.size(); ++j) {
      const double off = std::abs(result.u[j] / factor - base.u[j]);
      if (worse(off, farthest)) farthest = off;
    }
    add("u", farthest, exact ? 0.0 : rounded);
    const auto error = [&](const char* which, double scaled_error, double error_of_base, bool sum_of_squares) {
      // A sum of squares goes through roots, which are rounded.
      const double upper = exact ? (sum_of_squares ? 4.0 * static_cast<double>(N_amplitude) * epsilon : 0.0)
                                 : rounded / error_of_base + 4.0 * static_cast<double>(N_amplitude) * epsilon;
      add(which, std::abs(scaled_error / factor / error_of_base - 1.0), upper);
    };
    error("max error", result.error_linf, base.error_linf, false);
    error("L1 error", result.error_l1, base.error_l1, false);
    error("L2 error", result.error_l2, base.error_l2, true);
  }
  row.variable = "factor";
}

}  // namespace

void add_rows_of_amplitude(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : extremes.schemes) {
    const Subject subject = subject_on(scheme, scaled(1.0));
    for (const double ratio : {2.5, 1e-12}) {
      const auto named = [&](const std::string& claim, const std::string& factors) {
        return subject.check(amplitude, claim, {at_ratio(ratio), {"factors", factors}},
                             "max |u/factor - u of factor 1|, change of the errors");
      };
      const std::string bitwise = "u times 2^996 and 2^-996: solution and errors are the same, bit by bit";
      const std::string rounded = "u times 1e300 and 1e-300: solution and relative errors change by round-off";
      const std::vector<double> binary = {std::ldexp(1.0, 996), std::ldexp(1.0, -996)}, decimal = {1e300, 1e-300};
      rows.add(named(bitwise, "2^996, 2^-996"), [=](Finding& row) { compare_runs(row, subject, ratio, binary); });
      rows.add(named(rounded, "1e300, 1e-300"), [=](Finding& row) { compare_runs(row, subject, ratio, decimal); });
      if (ratio < 1.0) continue;
      rows.add_control(named(bitwise, "1e300, 1e-300, to the bit"), "these are no powers of two", [=](Finding& row) {
        compare_runs(row, subject, ratio, decimal);
        for (Point& point : row.points) {
          if (point.label.rfind("u,", 0) == 0) point.upper = 0.0;
        }
      });
      rows.add_control(named(rounded, "1e300 (1 + 1e-10 sin(x))"), "not the same u",
                       [=](Finding& row) { compare_runs(row, subject, ratio, {1e300}, " + 1e-10*sin(x)"); });
    }
  }
}

}  // namespace acstudy
