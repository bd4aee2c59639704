// Values that others have published, with what they say of them.

#include <cmath>

#include "catch.hpp"
#include "reports/judging/values.hpp"

namespace acstudy {

using Catch::Matchers::WithinAbs;

namespace {

/// Three levels, finest first as the sources print them: ratios of fine to medium and medium to coarse.
ValueJudgement judge_three(double fine, double medium, double coarse, double r21, double r32, double digits) {
  return judge_values(std::vector<Value>{{r21 * r32, coarse, digits}, {r21, medium, digits}, {1.0, fine, digits}},
                      not_estimated);
}

}  // namespace

// I. B. Celik et al., Procedure for estimation and reporting of uncertainty due to discretization in CFD applications,
// J. Fluids Eng. 130 (2008) 078001, table 1: reattachment length behind a backward-facing step, and axial velocities
// with an order below 1 and with oscillating convergence. Orders are printed to two places, the index in percent to
// one.
TEST_CASE("Celik et al. 2008, table 1") {
  const ValueJudgement step = judge_three(6.063, 5.972, 5.863, 1.5, 4.0 / 3.0, 5e-4);
  CHECK_THAT(step.order, WithinAbs(1.53, 0.005));
  CHECK_THAT(step.extrapolated, WithinAbs(6.1685, 5e-5));
  CHECK_THAT(step.gci.uncertainty / 6.063, WithinAbs(0.022, 5e-4));
  CHECK(step.gci.safety_factor == 1.25);
  CHECK(step.verdict == Verdict::inconclusive);  // no interval from three levels

  const ValueJudgement slow = judge_three(10.7880, 10.7250, 10.6050, 2.0, 2.143, 5e-5);
  CHECK_THAT(slow.order, WithinAbs(0.75, 0.005));
  CHECK_THAT(slow.extrapolated, WithinAbs(10.8801, 5e-5));
  CHECK_THAT(slow.gci.uncertainty / 10.7880, WithinAbs(0.011, 5e-4));

  const ValueJudgement swings = judge_three(6.0042, 5.9624, 6.0909, 2.0, 2.143, 5e-5);
  CHECK_THAT(swings.order, WithinAbs(1.51, 0.005));
  CHECK_THAT(swings.extrapolated, WithinAbs(6.0269, 5e-5));
  // The paper takes 1.25 here too, and 0.5 %.
  CHECK(swings.gci.safety_factor == 3.0);
  CHECK_THAT(swings.gci.uncertainty / 6.0042 * 1.25 / 3.0, WithinAbs(0.005, 5e-4));
  CHECK(swings.reason.find("oscillate") != std::string::npos);
}

// NPARC Alliance CFD Verification and Validation, tutorial Examining Spatial (Grid) Convergence, NASA Glenn: pressure
// recovery of a supersonic diffuser. Numbers as the tutorial's program verify.f90 prints them, also in its Python port
// (github.com/Data-Only-Greater/convergence).
TEST_CASE("pressure recovery of NASA's tutorial on grid convergence") {
  const ValueJudgement recovery = judge_three(0.97050, 0.96854, 0.96178, 2.0, 2.0, 5e-6);
  CHECK_THAT(recovery.order, WithinAbs(1.786170, 5e-7));
  CHECK_THAT(recovery.extrapolated, WithinAbs(0.971300, 5e-7));
  CHECK_THAT(recovery.gci.uncertainty / 0.97050, WithinAbs(0.001031, 5e-7));
}

// deal.II, results of tutorial program step-13: value of the solution in a point on globally refined meshes of 4^2 to
// 256^2 bilinear elements, which converge with second order; the exact value is 1.59491554...
TEST_CASE("point values of a deal.II tutorial") {
  std::vector<Value> values;
  double h = 1.0 / 4.0;
  for (const double value : {1.2868, 1.6945, 1.4658, 1.5679, 1.5882, 1.5932, 1.5945}) {
    values.push_back({h, value, 5e-5});
    h /= 2.0;
  }
  const ValueJudgement judged = judge_values(values, 2.0);
  CHECK(judged.verdict != Verdict::above);
  CHECK(judged.verdict != Verdict::below);
  CHECK(judged.first >= 2);  // the coarse values swing
  CHECK(judged.contains(2.0));
  CHECK(judged.extrapolated_low < 1.59491554);
  CHECK(judged.extrapolated_high > 1.59491554);
  CHECK(judged.gci.uncertainty > 1.59491554 - 1.5945);
  CHECK(judged.least_squares.uncertainty > 1.59491554 - 1.5945);
  CHECK(judge_values(values, 4.0).verdict != Verdict::confirmed);
}

// Lid-driven cavity at Re = 1000, stream function in the center of the primary vortex by second-order differences on
// 128^2, 256^2 and 512^2 cells, against the spectral value of O. Botella and R. Peyret, Benchmark spectral results on
// the lid-driven cavity flow, Comput. Fluids 27 (1998) 421-433.
TEST_CASE("primary vortex of the driven cavity") {
  const ValueJudgement vortex = judge_three(-0.11872, -0.11807, -0.11547, 2.0, 2.0, 5e-6);
  CHECK_THAT(vortex.order, WithinAbs(2.0, 0.03));
  CHECK_THAT(vortex.extrapolated, WithinAbs(-0.1189366, 5e-6));
  CHECK(vortex.gci.uncertainty > 0.1189366 - 0.11872);
}

}  // namespace acstudy
