#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/line/model2.hpp"
#include "tests/catch.hpp"
#include "tests/kernel_integrals.hpp"
#include "tests/model_properties.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace acstudy::test;

template <class K>
concept UsableInModelII = requires {
  typename ModelII<K, NoDivergence>;
};
static_assert(UsableInModelII<CubicSplineKernel> && UsableInModelII<IntegrablePowerKernel>);
static_assert(!UsableInModelII<InverseKernel> && !UsableInModelII<PowerKernel>);

// An absent part takes no storage: b at the midpoints and the divergence factor, one array each.
static_assert(sizeof(ModelII<CubicSplineKernel, LocalDivergence>) ==
              sizeof(ModelII<CubicSplineKernel, NoDivergence>) + 2 * sizeof(std::vector<double>));
static_assert(sizeof(ModelII<CubicSplineKernel, NonlocalDivergence>) ==
              sizeof(ModelII<CubicSplineKernel, LocalDivergence>));

namespace {

constexpr double mu = 1.7;

template <class Check>
void for_each_kernel(Check check) {
  for (const double alpha : {0.9, 0.5, 0.0, -2.0})
    check("power " + std::to_string(alpha), IntegrablePowerKernel(alpha));
  check(std::string("cubic spline"), CubicSplineKernel{});
}

template <class Check>
void for_each_divergence(Check check) {
  check(std::string("(3.6)"), NoDivergence{});
  check(std::string("(3.8)"), LocalDivergence{});
  check(std::string("(3.10)"), NonlocalDivergence{});
}

template <class Divergence, class K>
ModelII<K, Divergence> placed_scheme(K kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v,
                                     double viscosity = mu) {
  ModelII<K, Divergence> scheme(kernel, viscosity);
  scheme.place(placed(x, period, delta), v);
  return scheme;
}

struct Term {
  std::size_t index;
  double offset, W;  ///< x_i - x_j and W_{j,k}
};

/// The neighbors of particle j with their weights, leftmost first, by quadrature.
template <class K>
std::vector<Term> written_out_terms(const K& kernel, const std::vector<double>& x, double delta, std::size_t j) {
  std::vector<Term> terms;
  for (const int side : {-1, +1}) {
    const auto window = neighbors(x, period, delta, j, side);
    double inner = 0.0;
    std::vector<Term> half;
    for (std::size_t k = 0; k < window.size(); ++k) {
      const double outer = std::fmin(window[k].distance / delta, 1.0);
      double mass = kernel_integral(kernel, 0, inner, outer);
      if (k + 1 == window.size()) mass += kernel_integral(kernel, 0, outer, 1.0);
      half.push_back({window[k].index, side * window[k].distance, side * mass / (2.0 * delta)});
      inner = outer;
    }
    if (side < 0) {
      terms.assign(half.rbegin(), half.rend());
    } else {
      terms.insert(terms.end(), half.begin(), half.end());
    }
  }
  return terms;
}

/// (3.6), (3.8) and (3.10) as they are printed, erratum 5 applied.
template <class Divergence, class K>
std::vector<double> written_out_rates(const K& kernel, const std::vector<double>& x, double delta,
                                      const PointwiseVelocity& v, const std::vector<double>& u) {
  constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
  std::vector<double> rate(x.size());
  for (std::size_t j = 0; j < x.size(); ++j) {
    const auto terms = written_out_terms(kernel, x, delta, j);
    double N_j = 0.0, A = 0.0, D = 0.0, B = 0.0, reach = delta;
    for (const auto& [i, offset, W] : terms) {
      const double middle = x[j] + 0.5 * offset;
      N_j += offset * W;
      A += (standing ? v.c_at(middle) : v.c_hat_at(middle)) * (u[j] + u[i]) * W;
      D += (u[i] - u[j]) / offset * W;
      B += 2.0 * v.b_at(middle) * W;
      reach = std::fmax(reach, std::abs(offset));
    }
    rate[j] = (-A + mu * reach * D) / N_j;
    if constexpr (std::is_same_v<Divergence, LocalDivergence>) rate[j] -= v.b_prime_at(x[j]) * u[j];
    if constexpr (std::is_same_v<Divergence, NonlocalDivergence>) rate[j] -= B / N_j * u[j];
  }
  return rate;
}

struct ModelIITested {
  static void for_each_kernel(auto check) { ::for_each_kernel(check); }
  static void for_each_divergence(auto check) { ::for_each_divergence(check); }
  template <class Divergence>
  static auto placed(const auto& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v) {
    return placed_scheme<Divergence>(kernel, x, delta, v);
  }
  template <class Divergence>
  static auto written_out(const auto& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v,
                          const std::vector<double>& u) {
    return written_out_rates<Divergence>(kernel, x, delta, v, u);
  }
};

}  // namespace

TEST_CASE("(3.4): Model II's weights cancel, and N_j is their first moment") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed);
    for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        const auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, uneven_velocity());
        double cancellation = 0.0, moment = 0.0;
        bool signs = true;
        for (std::size_t j = 0; j < N; ++j) {
          const auto left = neighbors(x, period, delta, j, -1), right = neighbors(x, period, delta, j, +1);
          const auto W = scheme.weights(j);
          REQUIRE(W.size() == left.size() + right.size());
          double sum = 0.0, absolute = 0.0, first = 0.0;
          for (std::size_t m = 0; m < W.size(); ++m) {
            const bool is_left = m < left.size();
            const double offset = is_left ? -left[left.size() - 1 - m].distance : right[m - left.size()].distance;
            signs = signs && (is_left ? W[m] <= 0.0 : W[m] >= 0.0);
            sum += W[m];
            absolute += std::abs(W[m]);
            first += offset * W[m];
          }
          cancellation = std::fmax(cancellation, std::abs(sum) / absolute);
          moment = std::fmax(moment, std::abs(first / scheme.renormalization(j) - 1.0));
        }
        CHECK(cancellation < 1e-14);
        CHECK(moment < 1e-13);
        CHECK(signs);
      }
    });
  }
}

TEST_CASE("(3.4) and the signs of the weights hold for neighbors that tie at the horizon, within its tolerance") {
  const std::vector<double> offsets = {-1.0 - 8e-12, -1.0 - 4e-12, -1.0, 0.0, 1.0, 1.0 + 4e-12, 1.0 + 8e-12};
  for_each_kernel([&](const std::string& name, auto kernel) {
    INFO(name);
    const auto scheme = placed_scheme<NoDivergence>(kernel, offsets, 1.0, constant_velocity(1.0));
    const auto W = scheme.weights(3);
    REQUIRE(W.size() == 6);
    double sum = 0.0;
    for (std::size_t m = 0; m < 6; ++m) {
      CHECK((m < 3 ? -W[m] : W[m]) >= 0.0);
      sum += W[m];
    }
    CHECK_THAT(sum, WithinAbs(0.0, 1e-14));
    CHECK_THAT(scheme.renormalization(3), WithinRel(kernel.mass(1.0), 1e-10));
  });
}

TEST_CASE("Lemma 3.1: N_j > 0 and |N_j - 1| <= ||w||_1 h_max") {
  // In the proof each cell contributes at most h_max int |w| over the cell; ||w^delta||_1 = mass(1) / delta.
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const auto x = irregular_positions(N, period, seed, 20.0);
    const double h_max = gaps(x, period).largest;
    for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        const auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, uneven_velocity());
        double gap = 0.0, least = INFINITY;
        for (std::size_t j = 0; j < N; ++j) {
          gap = std::fmax(gap, std::abs(scheme.renormalization(j) - 1.0));
          least = std::fmin(least, scheme.renormalization(j));
        }
        CHECK(gap <= kernel.mass(1.0) / delta * h_max * (1.0 + 1e-13));
        CHECK(least > 0.0);
      }
    });
  }
}

TEST_CASE("Lemma 3.1: N_j >= 1 for the spline on equal gaps, and N_j - 1 falls like h / delta") {
  std::vector<double> excess;
  for (const std::size_t count : {50u, 100u, 200u, 400u, 800u}) {
    const auto x = uniform_positions(count, period);
    for (const double delta :
         {0.3, 1.0, 1.9 * period / static_cast<double>(count), 1e-3 * period / static_cast<double>(count)}) {
      CAPTURE(count, delta);
      const auto scheme = placed_scheme<NoDivergence>(CubicSplineKernel{}, x, delta, uneven_velocity());
      for (std::size_t j = 0; j < count; ++j) CHECK(scheme.renormalization(j) >= 1.0 - 1e-14);
      if (delta == 1.0) excess.push_back(scheme.renormalization(0) - 1.0);
    }
  }
  CAPTURE(excess);
  for (std::size_t i = 1; i < excess.size(); ++i) {
    const double order = std::log2(excess[i - 1] / excess[i]);
    CHECK(order > 0.95);
    CHECK(order < 1.05);
  }
}

TEST_CASE("Lemma 3.1's N_j >= 1 is not general: a gap at the end of the horizon leaves N_j below one") {
  // Neighbors at 0.1 delta, the next beyond the horizon: the whole weight sits at 0.1 delta.
  std::vector<double> x;
  for (int m = 0; m < 4; ++m) {
    for (const double offset : {0.0, 0.1}) x.push_back(0.25 * period * m + offset);
  }
  x.insert(x.begin() + 1, 0.05);
  const auto scheme = placed_scheme<NoDivergence>(CubicSplineKernel{}, x, 1.0, constant_velocity(1.0));
  CAPTURE(scheme.renormalization(1));
  CHECK(scheme.renormalization(1) > 0.0);
  CHECK(scheme.renormalization(1) < 0.2);
}

TEST_CASE("Model II's rates are (3.6), (3.8) and (3.10) written out") {
  check_rates_are_those_written_out<ModelIITested>();
}

TEST_CASE("the viscous term reaches to the nearest neighbor where the horizon does not") {
  // With delta below every gap and c = 0: rate = mu max(d_left, d_right) D_j, by hand from (3.6).
  const std::vector<double> x = {0.0, 1.0, 3.0}, u = {2.0, -1.0, 4.0};
  auto scheme = placed_scheme<NoDivergence>(CubicSplineKernel{}, x, 1e-3, constant_velocity(0.0));
  const auto rate = rates(scheme, u);
  // Particle 1: gaps 1 and 2, equal weights W, N = 3 W, D = ((4+1)/2 + (2+1)/1) W / N.
  CHECK_THAT(rate[1], WithinRel(mu * 2.0 * (5.0 / 2.0 + 3.0) / 3.0, 1e-13));
}

TEST_CASE("Model II does not tell left from right: x -> -x, c -> -c, b -> -b") {
  check_left_is_like_right<ModelIITested>();
}

TEST_CASE("Model II does not depend on the origin of x nor on which particle is the first") {
  check_origin_and_first_particle_are_free<ModelIITested>();
}

TEST_CASE("Model II keeps a constant under constant c: (3.6) at rest, (3.10) in any motion, (3.8) not") {
  check_constants_are_kept<ModelIITested>();
}

TEST_CASE("where particles move with the fluid, b = c, and mu = 0, Model II couples no particles") {
  const auto x = irregular_positions(N, period, 12);
  const auto u = irregular_values(N, 13);
  PointwiseVelocity v = uneven_velocity();
  v.c_at = v.b_at;
  auto local = placed_scheme<LocalDivergence>(CubicSplineKernel{}, x, 2.5 * h, v, 0.0);
  const auto rate = rates(local, u);
  for (std::size_t j = 0; j < N; ++j) CHECK(rate[j] == -v.b_prime_at(x[j]) * u[j]);
  auto nonlocal = placed_scheme<NonlocalDivergence>(CubicSplineKernel{}, x, 2.5 * h, v, 0.0);
  const auto coupled = rates(nonlocal, u);
  for (std::size_t j = 0; j < N; j += 5) {
    std::vector<double> alone(N, 0.0);
    alone[j] = u[j];
    CHECK_THAT(rates(nonlocal, alone)[j], WithinRel(coupled[j], 1e-13));
  }
}

namespace {

/// What Lemma 3.3 bounds, for velocities that are as large as the viscosity bound allows.
struct StabilityCheck {
  std::vector<double> x;
  double delta;

  /// max_j (reach_j / N_j) sum_k W_{j,k} / (x_i - x_j): the share of u_j in the viscous term, over mu.
  template <class K>
  double viscous_share(const K& kernel) const {
    const auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(1.0));
    double share = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const auto left = neighbors(x, period, delta, j, -1), right = neighbors(x, period, delta, j, +1);
      const auto W = scheme.weights(j);
      double sum = 0.0;
      for (std::size_t k = 0; k < left.size(); ++k) sum -= W[left.size() - 1 - k] / left[k].distance;
      for (std::size_t k = 0; k < right.size(); ++k) sum += W[left.size() + k] / right[k].distance;
      const double reach = std::fmax(delta, std::fmax(left.back().distance, right.back().distance));
      share = std::fmax(share, reach * sum / scheme.renormalization(j));
    }
    return share;
  }

  /// Checks ||u^{n+1}|| <= (1 + dt slopes) ||u^n|| with mu = ||c_hat|| and dt = courant / mu.
  template <class K>
  void check(const K& kernel, double courant) const {
    const auto v = uneven_velocity();
    const auto top = [](auto f) {
      double value = 0.0;
      for (int i = 0; i < 10000; ++i) value = std::fmax(value, std::abs(f(period * i / 10000)));
      return value;
    };
    const auto c_prime = [](double y) { return -2.0 / 3.0 * std::sin(2.0 * y) + 0.1 * std::cos(y); };
    const double slope_c = top(c_prime), slope_b = top(v.b_prime_at);
    const double slope_c_hat = top([&](double y) { return c_prime(y) - v.b_prime_at(y); });
    const double mu_standing = top(v.c_at), mu_moving = top([&](double y) { return v.c_hat_at(y); });

    auto constant = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(-1.3), 1.3);
    CHECK(step_norm(constant, x.size(), courant / 1.3) <= 1.0 + 1e-13);
    auto standing = placed_scheme<NoDivergence>(kernel, x, delta, v, mu_standing);
    CHECK(step_norm(standing, x.size(), courant / mu_standing) <= 1.0 + courant / mu_standing * slope_c + 1e-13);
    const double moving_bound = 1.0 + courant / mu_moving * (slope_b + slope_c_hat) + 1e-13;
    auto local = placed_scheme<LocalDivergence>(kernel, x, delta, v, mu_moving);
    CHECK(step_norm(local, x.size(), courant / mu_moving) <= moving_bound);
    auto nonlocal = placed_scheme<NonlocalDivergence>(kernel, x, delta, v, mu_moving);
    CHECK(step_norm(nonlocal, x.size(), courant / mu_moving) <= moving_bound);
    // Negative control: half the viscosity does not damp the advection.
    auto thin = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(-1.3), 0.65);
    CHECK(step_norm(thin, x.size(), courant / 1.3) > 1.0 + 1e-4);
  }
};

/// The paper's particles at time t: gaps that vary by a factor e^(2t), smoothly.
std::vector<double> paper_particles(std::size_t count, double t) {
  std::vector<double> x;
  for (const double start : uniform_positions(count, period)) {
    x.push_back(2.0 * std::atan2(std::sin(0.5 * start) * std::exp(t), std::cos(0.5 * start)));
  }
  return x;
}

}  // namespace

TEST_CASE("Lemma 3.3: on the paper's particles a step with 2 dt mu = h_min grows by no more than the slopes") {
  for (const double t : {0.0, 1.0}) {
    const auto x = paper_particles(80, t);
    const double h_min = gaps(x, period).smallest;
    for_each_kernel([&](const std::string& name, auto kernel) {
      if (name.starts_with("power 0.9")) return;
      for (const double in_spacings : {1e-6, 0.5, 1.0, 2.5, 4.0, 12.3, 35.0}) {
        INFO(name << ", delta / h = " << in_spacings << ", t = " << t);
        StabilityCheck{x, in_spacings * period / 80.0}.check(kernel, 0.5 * h_min);
      }
    });
  }
}

TEST_CASE(
    "Lemma 3.3 on any particles: dt mu max_j (reach_j/N_j) sum W/(x_i - x_j) = 1 is the step that its proof needs") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed);
    for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        const StabilityCheck lemma{x, delta};
        lemma.check(kernel, 1.0 / lemma.viscous_share(kernel));
        // Negative control: a step 5 % longer loses the bound by twice the excess.
        auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(1.0), 1.0);
        CHECK_THAT(step_norm(scheme, N, 1.05 / lemma.viscous_share(kernel)), WithinRel(1.1, 1e-10));
      }
    });
  }
}

TEST_CASE("Lemma 3.3 as printed is not general: 2 dt mu = h_min can be too long a step") {
  const auto norm = [](auto kernel, const std::vector<double>& x, double delta) {
    auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(1.0), 1.0);
    return step_norm(scheme, x.size(), 0.5 * gaps(x, period).smallest);
  };
  // A kernel that nearly fails to be integrable, on equal gaps: its weight sits at the nearest neighbors.
  const auto even = uniform_positions(120, period);
  CHECK(norm(IntegrablePowerKernel(0.9), even, 12.3 * period / 120.0) > 2.0);
  CHECK(norm(IntegrablePowerKernel(0.5), even, 12.3 * period / 120.0) <= 1.0 + 1e-13);
  // Uneven gaps: the reach of the far side meets the near neighbor of the other.
  CHECK(norm(CubicSplineKernel{}, irregular_positions(120, period, 3, 2.0), 1.5 * period / 120.0) > 1.1);
}

TEST_CASE("nothing in a rate of Model II overflows at a horizon of 1e-200 with values of 1e300") {
  const auto x = irregular_positions(N, period, 1);
  std::vector<double> u = irregular_values(N, 2);
  for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
    INFO(equation);
    const auto rates_at = [&](double delta, double amplitude) {
      std::vector<double> values = u;
      for (double& value : values) value *= amplitude;
      auto scheme = placed_scheme<Divergence>(CubicSplineKernel{}, x, delta, uneven_velocity());
      std::vector<double> result = rates(scheme, values);
      for (double& value : result) value /= amplitude;
      return result;
    };
    CHECK(relative_gap(rates_at(1e-200, 1e300), rates_at(1e-3 * h, 1.0)) < 1e-14);
    CHECK(relative_gap(rates_at(1e-200, 1e-300), rates_at(1e-3 * h, 1.0)) < 1e-14);
  });
}

TEST_CASE("Model II counts its work") {
  constexpr std::int64_t count = 20;
  const Particles particles = placed(uniform_positions(count, period), period, 3.0 * period / count);
  const auto u = irregular_values(count, 1);
  const auto work_of = [&](auto scheme) {
    scheme.place(particles, uneven_velocity());
    rates(scheme, u);
    rates(scheme, u);
    return scheme.work();
  };
  const WorkCounts standing = work_of(ModelII<CubicSplineKernel, NoDivergence>({}, 1.0));
  CHECK(standing.pairs == 2 * 6 * count);
  CHECK(standing.weight_builds == 1);
  CHECK(standing.velocity_evaluations == 3 * count);
  CHECK(work_of(ModelII<CubicSplineKernel, LocalDivergence>({}, 1.0)).velocity_evaluations == 7 * count);
  CHECK(work_of(ModelII<CubicSplineKernel, NonlocalDivergence>({}, 1.0)).velocity_evaluations == 6 * count);
}

TEST_CASE("Model II can be placed again: nothing of the last place is left") {
  const auto u = irregular_values(N, 17);
  for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
    INFO(equation);
    ModelII<CubicSplineKernel, Divergence> used(CubicSplineKernel{}, mu);
    used.place(placed(irregular_positions(N, period, 1), period, 0.4 * period), constant_velocity(-2.0));
    rates(used, u);
    const Particles particles = placed(irregular_positions(N, period, 2), period, 2.5 * h);
    used.place(particles, uneven_velocity());
    ModelII<CubicSplineKernel, Divergence> fresh(CubicSplineKernel{}, mu);
    fresh.place(particles, uneven_velocity());
    CHECK(rates(used, u) == rates(fresh, u));
  });
}
