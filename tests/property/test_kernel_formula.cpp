#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "solver/line/model1.hpp"
#include "studies/claims/digits.hpp"
#include "studies/models/kernel_choice.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinRel;

namespace {

/// Some units in the last place.
constexpr double few_units = 4e-15;

KernelFormula density(const std::string& text, const std::vector<std::string>& breaks = {}) {
  return {.text = text, .density = true, .breaks = breaks};
}
KernelFormula profile(const std::string& text, double exponent = 0.0, const std::vector<std::string>& breaks = {}) {
  return {.text = text, .breaks = breaks, .exponent = exponent};
}
IntegrablePiecewiseKernel integrable_kernel(const KernelFormula& formula) {
  return std::get<IntegrablePiecewiseKernel>(make_kernel(formula));
}

/// Cells of one particle with one neighbor, ten, a thousand, and some in between that are narrow.
template <class Check>
void for_each_cell(Check check) {
  for (const int neighbors : {1, 3, 10, 1000, 10'000}) {
    CellWalk walk(1.0);
    double d = 0.0;
    for (int k = 1; k < neighbors; ++k) {
      // Exact in binary, so that ends and gaps agree.
      const double gap = std::floor(0x1p40 * (k % 7 == 0 ? 1e-6 : 1.0) / neighbors) * 0x1p-40;
      check(walk.to(d += gap, gap));
    }
    check(walk.to_horizon());
  }
}

/// A polynomial with a leading power, in long double, over a cell, the width factored out: sum_k c_k z^(k + first).
long double over(const Cell& cell, const std::vector<long double>& c, int first) {
  const long double a = cell.inner, b = a + static_cast<long double>(cell.width);
  long double sum = 0.0L;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const int n = static_cast<int>(k) + first;
    long double powers = 0.0L;
    for (int i = 0; i <= n; ++i) powers += std::pow(a, i) * std::pow(b, n - i);
    sum += c[k] * powers / (n + 1);
  }
  return sum * cell.width;
}

}  // namespace

TEST_CASE("named and written kernels are the kernels that have types of their own", "[formula]") {
  const auto agree = [](const std::string& name, const auto& written, const auto& typed) {
    INFO(name);
    bool eta = true, moments = true, masses = true;
    for_each_cell([&](const Cell& cell) {
      const auto near = [](double a, double b) { return std::abs(a - b) <= few_units * std::abs(b); };
      const double z = 0.5 * (cell.inner + cell.outer);
      eta = eta && near(written.eta(z), typed.eta(z));
      moments = moments && near(written.first_moment(cell), typed.first_moment(cell)) &&
                std::abs(written.first_moment(z) - typed.first_moment(z)) <= 1e-15;
      if constexpr (IntegrableKernel<std::decay_t<decltype(typed)>>) {
        masses = masses && near(written.mass(cell), typed.mass(cell)) &&
                 std::abs(written.mass(z) - typed.mass(z)) <= 1e-15 * typed.mass(1.0);
      }
    });
    CHECK(eta);
    CHECK(moments);
    CHECK(masses);
  };
  agree("cubic spline", integrable_kernel(density("(2-2*s)^3 - 4*max(1-2*s, 0)^3", {"1/2"})), CubicSplineKernel{});
  agree("constant", integrable_kernel(density("1 - s")), IntegrablePowerKernel(0.0));
  agree("linear", integrable_kernel(profile("s")), IntegrablePowerKernel(-1.0));
  for (const double alpha : {0.5, 0.9, -0.5, -3.5}) {
    agree("power " + std::to_string(alpha), integrable_kernel(profile("1", alpha)), IntegrablePowerKernel(alpha));
  }
  for (const double alpha : {1.0, 1.5, 1.9}) {
    agree("power " + std::to_string(alpha), std::get<PiecewiseKernel>(make_kernel(profile("3", alpha))),
          PowerKernel(alpha));
  }
  // A power in front of what is singular makes it less so.
  agree("power -1/2", integrable_kernel(profile("s^2", 1.5)), IntegrablePowerKernel(-0.5));
  // (8/3)^-1 (s^-3/2 + s^-1/2), of two members of the power family.
  const auto sum = std::get<PiecewiseKernel>(make_kernel(profile("1 + s", 1.5)));
  bool sums = true;
  for_each_cell([&](const Cell& cell) {
    const double exact = 0.75 * PowerKernel(1.5).first_moment(cell) + 0.25 * PowerKernel(0.5).first_moment(cell);
    sums = sums && std::abs(sum.first_moment(cell) - exact) <= few_units * exact;
  });
  CHECK(sums);
  // Negative control: another kernel does not agree.
  const auto hat = integrable_kernel(density("(1-s)^2"));
  CHECK(std::abs(hat.eta(0.5) - IntegrablePowerKernel(0.0).eta(0.5)) > 0.5);
}

TEST_CASE("hat and Wendland's functions have their printed moments", "[formula]") {
  // eta = 6 (1 - z), and 30 z (1 - z)^2 of (1 - s)^3 (1 + 3 s).
  const auto hat = std::get<IntegrablePiecewiseKernel>(KernelChoice{"hat"}.kernel());
  const auto c2 = std::get<IntegrablePiecewiseKernel>(KernelChoice{"wendland-c2"}.kernel());
  bool hats = true, wendlands = true;
  for_each_cell([&](const Cell& cell) {
    if (cell.outer > 0.9) return;  // where the powers of z cancel; the study of digits looks there
    const auto near = [](double a, long double b) { return std::abs(a - b) <= 1e-14L * std::abs(b); };
    hats = hats && near(hat.mass(cell), over(cell, {6, -6}, 0)) && near(hat.first_moment(cell), over(cell, {6, -6}, 1));
    wendlands = wendlands && near(c2.mass(cell), over(cell, {30, -60, 30}, 1)) &&
                near(c2.first_moment(cell), over(cell, {30, -60, 30}, 2));
  });
  CHECK(hats);
  CHECK(wendlands);
}

TEST_CASE("weights of named and written kernels keep their digits from 1e-12 to 1e4 spacings", "[formula]") {
  std::vector<KernelChoice> kernels;
  for (const NamedKernel& row : named_kernels) {
    if (row.make == nullptr) kernels.push_back({std::string(row.name)});
  }
  CHECK(kernels.size() == 8);
  kernels.push_back(KernelChoice::written(density("1 + cos(pi*s)")));
  kernels.push_back(KernelChoice::written(profile("min(1, 2 - 2*s)", 0.0, {"0.5"})));
  for (const KernelChoice& kernel : kernels) {
    INFO(kernel.label());
    // The reference of other texts, in 100 digits, takes long.
    const std::vector<double> ratios =
        kernel.formula == nullptr ? std::vector{1e-12, 0.5, 2.5, 1e4} : std::vector{1e-12, 0.5, 2.5, 12.3};
    for (const ModelCard* const model : {&model_one, &model_two}) {
      if (model->needs_integrable_kernel() && !integrable(kernel)) continue;
      const Finding finding = round_off_of_weights({model, kernel}, ratios, CellForm::factored).take();
      double largest = 0.0;
      for (const Point& point : finding.points)
        largest = std::fmax(largest, std::isnan(point.value) ? 1.0 : point.value);
      CHECK(largest < 1e-14);
    }
    CHECK_THAT(first_moment(kernel, 1.0), WithinRel(1.0, 4e-16));
    CHECK(first_moment(kernel, 0.0) == 0.0);
  }
  // Negative control: differences of values at both ends do not.
  const Finding lost = round_off_of_weights({&model_one, {"wendland-c6"}}, {1e4}, CellForm::difference).take();
  CHECK(lost.points.front().value > 1e-12);
}

TEST_CASE("a text that is no kernel is refused, with the reason", "[formula]") {
  const auto refused = [](const KernelFormula& formula, const std::string& reason) {
    INFO(formula.label());
    std::string said = "nothing";
    try {
      make_kernel(formula);
    } catch (const KernelError& error) {
      said = error.what();
    }
    INFO(said);
    CHECK(said.find(reason) != std::string::npos);
  };
  refused(density("(1-s"), "a closing parenthesis is missing");
  refused(profile("1 + x"), "unknown name \"x\"");
  refused(density("1"), "eta is 0 everywhere");
  refused(density("s*(1-s)"), "it increases, so that eta = -rho' is negative, at s = 0.");
  refused(profile("1 - 2*s"), "it is negative at s = ");
  refused(profile("-1"), "nowhere negative");
  refused(profile("1/s"), "write exponent = 1");
  refused(profile("sqrt(s)"), "write exponent = -0.5");
  refused(density("2 - sqrt(s)"), "its slope goes like s^-0.5 at s = 0");
  refused(profile("1/(1-s)"), "not smooth near s = 1");
  refused(profile("log(s - 2)"), "it is not finite at s = ");
  refused(profile("1", 2.0), "exponent = 2");
  refused(density("max(0.3 - s, 0)"), "breaks = [0.3]");
  refused(profile("max(0.3 - s, 0)"), "not smooth near s = 0.3");
  refused(profile("1", 0.0, {"0.5", "0.5"}), "in increasing order");
  refused(profile("1", 0.0, {"1"}), "between 0 and 1");
  refused(profile("1", 0.0, {"s"}), "unknown name \"s\"");
  // Controls: with what the messages ask for they are kernels.
  CHECK_NOTHROW(make_kernel(profile("1", 1.0)));
  CHECK_NOTHROW(make_kernel(profile("1", -0.5)));
  CHECK_NOTHROW(make_kernel(profile("max(0.3 - s, 0)", 0.0, {"0.3"})));
  CHECK_NOTHROW(make_kernel(density("max(0.3 - s, 0)", {"0.3"})));
}

TEST_CASE("a kernel has one label however its text is spaced", "[formula]") {
  CHECK(density(" (1 - s)^3 * (1+3*s)").label() == "rho = (1-s)^3*(1+3*s)");
  CHECK(profile("exp(-s)", 0.5, {" 1/3", "0.5"}).label() == "eta = s^-0.5 (exp(-s)), breaks 1/3, 0.5");
  CHECK(kernel_pieces(density("1 - s")) == kernel_pieces(density("1-s")));
  CHECK(kernel_pieces(density("1 - s")) != kernel_pieces(profile("1 - s")));
}
