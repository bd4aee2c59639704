#include "studies/claims/digits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "studies/models/exact_profile.hpp"

namespace acstudy {

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// int_0^z s eta(s) ds and int_0^z eta(s) ds, written down anew.
Exact exact_moment(const InverseKernel&, const Exact& z) { return z; }
Exact exact_moment(const PowerKernel& kernel, const Exact& z) {
  return z == 0 ? Exact(0) : Exact(pow(z, 2 - Exact(kernel.alpha())));
}
Exact exact_mass(const IntegrablePowerKernel& kernel, const Exact& z) {
  const Exact alpha = kernel.alpha();
  return z == 0 ? Exact(0) : Exact((2 - alpha) / (1 - alpha) * pow(z, 1 - alpha));
}
/// rho(zeta) = [(2 - zeta)_+^3 - 4 (1 - zeta)_+^3]/6 and its integral from zeta on.
Exact rho(const Exact& zeta, int power = 3) {
  const auto part = [&](int from) { return zeta < from ? Exact(pow(from - zeta, power)) : Exact(0); };
  return (part(2) - 4 * part(1)) / (power == 3 ? 6 : 24);
}
/// By parts, eta(z) = -8 rho'(2 z).
Exact exact_mass(const CubicSplineKernel&, const Exact& z) { return 4 * (rho(0) - rho(2 * z)); }
Exact exact_moment(const CubicSplineKernel&, const Exact& z) {
  return 2 * (rho(0, 4) - rho(2 * z, 4)) - 4 * z * rho(2 * z);
}

/// N positions in [0, 1) whose differences are exact in double precision: multiples of 2^-20 h, N a power of two.
std::vector<double> dyadic_positions(std::size_t N, bool equal_gaps) {
  std::mt19937 generator(1);
  const double h = 1.0 / static_cast<double>(N), unit = 0x1p-20 * h;
  std::vector<double> x = uniform_positions(N, 1.0);
  if (equal_gaps) return x;
  for (double& position : x) position += unit * static_cast<double>(generator() % (3U << 18U));
  for (std::size_t j = 7; j < N; j += 7) x[j] = x[j - 1] + unit;
  return x;
}

double relative_error(double value, const Exact& exact) {
  if (exact == 0) return value == 0.0 ? 0.0 : HUGE_VAL;
  return static_cast<double>(Exact(abs(Exact(value) / exact - 1)));
}

/// One particle and the neighbors on one side of it.
struct Side {
  const double* x;  ///< at the particle
  int side;         ///< -1: left, +1: right
  std::ptrdiff_t last;
  double delta;

  Exact distance(std::ptrdiff_t k) const { return side * (Exact(x[side * k]) - Exact(x[0])); }
  /// Where the cell of neighbor k ends, in units of the horizon.
  Exact exact_end(std::ptrdiff_t k) const {
    return k == last ? Exact(1) : Exact(std::min(Exact(distance(k) / delta), Exact(1)));
  }
  double end(std::ptrdiff_t k) const { return k == last ? 1.0 : std::min(side * (x[side * k] - x[0]) / delta, 1.0); }
};

/// The weights W_k of Model I, or the masses 2 delta |W_{j,k}| of Model II, nearest neighbor first.
template <Kernel K>
std::vector<double> weights(CellWeights of, const K& kernel, const Side& at, CellForm form) {
  std::vector<double> W(static_cast<std::size_t>(at.last));
  if (form == CellForm::difference) {
    const auto closed = [&](double z) {
      if constexpr (IntegrableKernel<K>) {
        if (of == CellWeights::masses) return kernel.mass(z);
      }
      return kernel.first_moment(z);
    };
    double inner = 0.0;
    for (std::ptrdiff_t k = 1; k <= at.last; ++k) {
      const double outer = closed(at.end(k)), d = at.side * (at.x[at.side * k] - at.x[0]);
      W[static_cast<std::size_t>(k - 1)] = of == CellWeights::masses ? outer - inner : (outer - inner) / d;
      inner = outer;
    }
  } else if (of == CellWeights::moments_over_distance) {
    at.side < 0 ? upwind_weights<+1>(kernel, at.x, at.delta, W) : upwind_weights<-1>(kernel, at.x, at.delta, W);
  } else if constexpr (IntegrableKernel<K>) {
    at.side < 0 ? set_masses<-1>(kernel, at.x, at.delta, at.last, W.data() + at.last - 1)
                : set_masses<+1>(kernel, at.x, at.delta, at.last, W.data());
    if (at.side < 0) std::reverse(W.begin(), W.end());
  }
  return W;
}

/// The integral of eta, or of s eta, over a cell. Of a kernel by its closed form, of a written one from its text.
template <Kernel K>
class ExactCells {
 public:
  ExactCells(const KernelChoice&, const K& kernel) : kernel_(kernel) {}
  Exact operator()(CellWeights of, const Exact& from, const Exact& to) const {
    const Exact inner = of == last_of_ && from == last_to_ ? last_within_ : within(of, from);
    last_of_ = of;
    last_to_ = to;
    last_within_ = within(of, to);
    return last_within_ - inner;
  }

 private:
  Exact within(CellWeights of, const Exact& z) const {
    if constexpr (IntegrableKernel<K>) {
      if (of == CellWeights::masses) return exact_mass(kernel_, z);
    }
    return exact_moment(kernel_, z);
  }

  const K& kernel_;
  /// A cell begins where the one before has ended, and powers of fifty digits take long.
  mutable CellWeights last_of_{};
  mutable Exact last_to_ = -1, last_within_ = 0;
};

template <Kernel K>
requires std::is_base_of_v<PiecewiseKernel, K>
class ExactCells<K> {
 public:
  ExactCells(const KernelChoice& choice, const K&) : profile_(*choice.its_formula()) {}
  Exact operator()(CellWeights of, const Exact& from, const Exact& to) const {
    return Exact(profile_.integral(of == CellWeights::masses ? 0 : 1, HundredDigits(from), HundredDigits(to)) / total_);
  }

 private:
  ExactProfile profile_;
  HundredDigits total_ = profile_.integral(1, 0, 1);
};

/// The largest relative error of the weights on one side: of the 64 nearest, the last, and every sixteenth between.
template <Kernel K>
double error_of_weights(CellWeights of, const K& kernel, const ExactCells<K>& exact_cell, const Side& at,
                        CellForm form) {
  const std::vector<double> W = weights(of, kernel, at, form);
  double largest = 0.0;
  for (std::ptrdiff_t k = 1; k <= at.last; ++k) {
    if (k > 64 && k % 16 != 0 && k != at.last) continue;
    Exact exact = exact_cell(of, k > 1 ? at.exact_end(k - 1) : Exact(0), at.exact_end(k));
    if (of == CellWeights::moments_over_distance) exact /= at.distance(k);
    const double error = relative_error(W[static_cast<std::size_t>(k - 1)], exact);
    if (worse(error, largest)) largest = error;
  }
  return largest;
}

/// sum_k d_k m_k over one side.
template <IntegrableKernel K>
Exact exact_moment_of_side(const ExactCells<K>& exact_cell, const Side& at) {
  Exact sum = 0, inner = 0;
  for (std::ptrdiff_t k = 1; k <= at.last; ++k) {
    const Exact outer = at.exact_end(k);
    sum += at.distance(k) * exact_cell(CellWeights::masses, inner, outer);
    inner = outer;
  }
  return sum;
}

/// A point per ratio: the largest of error(left side, right side) over some particles, on equal gaps and on uneven
/// ones.
template <class Error>
void measure(Finding& finding, const std::vector<double>& ratios, Error&& error) {
  for (const double ratio : ratios) {
    const std::size_t N = std::bit_ceil(static_cast<std::size_t>(std::max(64.0, 2.5 * ratio)));
    const auto wanted = static_cast<std::size_t>(std::clamp(1000.0 / ratio, 1.0, 16.0));
    const double h = 1.0 / static_cast<double>(N), delta = ratio * h;
    Point point{.N = static_cast<std::int64_t>(N), .h = h, .delta = delta, .variable = ratio, .value = 0.0};
    point.upper = digits_bound;
    for (const bool equal_gaps : {true, false}) {
      Particles particles(N, 1.0, delta);
      particles.place(dyadic_positions(N, equal_gaps));
      for (std::size_t one = 0; one < wanted; ++one) {
        // Not always the same place among the seven gaps of the pattern.
        const std::size_t j = (2 * one + 1) * N / (2 * wanted) + one % 2;
        const double* const x = particles.x.at(static_cast<std::ptrdiff_t>(j));
        const double value = error(Side{x, -1, particles.windows.left[j], delta},  //
                                   Side{x, +1, particles.windows.right[j], delta});
        if (worse(value, point.value)) point.value = value;
      }
    }
    finding.points.push_back(point);
  }
}

Check check_of(const WeightsChoice& choice, const std::string& statement, const std::string& claim,
               const std::string& what) {
  return {.statement = statement,
          .claim = claim,
          .subject = "kernel " + choice.kernel.label(),
          .coordinates = {{"of", fmt::format("{} of {}", what, choice.model->name)}},
          .quantity = "max |value / exact - 1|",
          .variable = "delta/h"};
}

}  // namespace

Measurement round_off_of_weights(const WeightsChoice& choice, const std::vector<double>& ratios, CellForm form) {
  const bool factored = form == CellForm::factored;
  Check check = check_of(choice, factored ? "round-off" : "round-off, not factored",
                         factored ? "weights from cell integrals in factored form are exact to 1e-13"
                                  : "weights from differences of closed forms are exact to 1e-13",
                         "weights");
  if (!factored) check.be_control("a narrow cell is the difference of two values that agree in most digits");
  return {check, [=](Finding& finding) {
            with_kernel(choice.kernel, [&](const auto& kernel) {
              const ExactCells exact_cell(choice.kernel, kernel);
              measure(finding, ratios, [&](const Side& left, const Side& right) {
                const double on_left = error_of_weights(choice.model->cell_weights, kernel, exact_cell, left, form);
                const double on_right = error_of_weights(choice.model->cell_weights, kernel, exact_cell, right, form);
                return worse(on_right, on_left) ? on_right : on_left;
              });
            });
          }};
}

Measurement round_off_of_renormalization(const WeightsChoice& choice, const std::vector<double>& ratios) {
  Check check = check_of(choice, "round-off", "N_j is exact to 1e-13", "N_j");
  check.remark = "plain sums: all terms are positive, and 2e4 of them round off less than the bound by far";
  return {check, [=](Finding& finding) {
            with_kernel(choice.kernel, [&]<class K>(const K& kernel) {
              if constexpr (IntegrableKernel<K>) {
                const ExactCells exact_cell(choice.kernel, kernel);
                measure(finding, ratios, [&](const Side& left, const Side& right) {
                  std::vector<double> m(static_cast<std::size_t>(left.last + right.last));
                  const double moment =
                      set_masses<-1>(kernel, left.x, left.delta, left.last, m.data() + left.last - 1) +
                      set_masses<+1>(kernel, right.x, right.delta, right.last, m.data() + left.last);
                  return relative_error(
                      moment, exact_moment_of_side(exact_cell, left) + exact_moment_of_side(exact_cell, right));
                });
              }
            });
          }};
}

namespace {

void measure_gaps(Finding& finding, const Scene& scene, std::int64_t N, const std::vector<double>& times) {
  const auto count = static_cast<std::size_t>(N);
  const Exact pi = boost::math::constants::pi<Exact>();
  std::vector<Exact> sine(count + 1), cosine(count + 1);
  for (std::size_t j = 0; j <= count; ++j) {
    sine[j] = sin(Exact(pi * j / N));
    cosine[j] = cos(Exact(pi * j / N));
  }
  Trajectories trajectories(scene, uniform_positions(count, scene.period()));
  for (const double t : times) {
    const auto moved = trajectories.at(t);
    std::vector<double> x(moved.begin(), moved.end());
    x.push_back(x.front() + scene.period());
    const Exact E = exp(Exact(t)), E_sine = E * sine[1];
    const Gaps gap = gaps({x.begin(), x.end() - 1}, scene.period());
    Point point{.N = N, .h = gap.largest, .variable = t, .value = 0.0};
    for (std::size_t j = 0; j < count; ++j) {
      const Exact exact = 2 * atan2(E_sine, Exact(cosine[j] * cosine[j + 1] + E * E * sine[j] * sine[j + 1]));
      const double error = relative_error(x[j + 1] - x[j], exact);
      if (worse(error, point.value)) point.value = error;
    }
    point.upper = 4.0 * epsilon * scene.period() / gap.smallest;
    finding.points.push_back(point);
    finding.remark = fmt::format(
        "bound: four ulps of the period over the smallest gap. At T = {:g}, where gaps are down to {:.2g}, {:.1f} of "
        "16 "
        "digits are lost: no scheme gets them back",
        t, gap.smallest, std::log10(point.value / epsilon));
  }
}

}  // namespace

Measurement round_off_of_gaps(const std::shared_ptr<const Scene>& scene, std::int64_t N,
                              const std::vector<double>& times) {
  return {{.statement = "round-off",
           .claim = "gaps keep the digits that positions carry of them",
           .subject = "flow of the scene",
           .coordinates = {{"of", "gaps"}, {"N", static_cast<double>(N), fmt::format("N = {}", N)}},
           .quantity = "max |value / exact - 1|",
           .variable = "T"},
          [=](Finding& finding) { measure_gaps(finding, *scene, N, times); }};
}

}  // namespace acstudy
