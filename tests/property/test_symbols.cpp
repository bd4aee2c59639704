#include <gsl/gsl_sf_expint.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "mms/source.hpp"
#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "solver/time/integrate.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/kernel_integrals.hpp"
#include "tests/kernel_moments.hpp"
#include "tests/velocities.hpp"

using namespace acstudy;
using namespace acstudy::test;
using Catch::Matchers::WithinAbs;

namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi, period = 2.0 * pi;

/// A kernel with its integrals from the origin, int_0^z s eta(s) ds and int_0^z eta(s) ds, written down anew.
template <class K>
struct Analytic {
  std::string name;
  K kernel;
  std::function<double(double)> first_moment, mass;
  Moments moments;
};

Analytic<InverseKernel> inverse() {
  return {"inverse", {}, [](double z) { return z; }, nullptr, inverse_moment};
}
Analytic<IntegrablePowerKernel> constant() {
  return {"constant", IntegrablePowerKernel(0.0), [](double z) { return z * z; }, [](double z) { return 2.0 * z; },
          power_moments(0.0)};
}
Analytic<IntegrablePowerKernel> root() {
  return {"power 0.5", IntegrablePowerKernel(0.5), [](double z) { return z * std::sqrt(z); },
          [](double z) { return 3.0 * std::sqrt(z); }, power_moments(0.5)};
}
/// By parts from rho: int -8 rho'(2s) ds = 4 (rho(0) - rho(2z)), int s (-8 rho'(2s)) ds = 2 int_0^{2z} rho - 4 z
/// rho(2z).
Analytic<CubicSplineKernel> spline() {
  const auto integral_of_rho = [](double zeta) {
    const double y = 2.0 - zeta;
    return zeta <= 1.0 ? 2.0 / 3.0 * (zeta - 0.5 * std::pow(zeta, 3) + 0.1875 * std::pow(zeta, 4))
                       : 0.5 - std::pow(y, 4) / 24.0;
  };
  return {"cubic spline",
          {},
          [=](double z) { return 2.0 * integral_of_rho(2.0 * z) - 4.0 * z * rho(2.0 * z); },
          [](double z) { return 4.0 * (rho(0.0) - rho(2.0 * z)); },
          spline_moment};
}

/// -sum_m W_m (1 - e^(-ikmh)) on the uniform grid, c = 1; the W_m in closed form.
template <class K>
Complex discrete_upwind_symbol(const Analytic<K>& kernel, double k, double h, double delta) {
  const int L = std::max(static_cast<int>(delta / h), 1);
  Complex sum = 0.0;
  double inner = 0.0;
  for (int m = 1; m <= L; ++m) {
    const double outer = m == L ? 1.0 : kernel.first_moment(m * h / delta);
    sum += (outer - inner) / (m * h) * (1.0 - std::polar(1.0, -k * m * h));
    inner = outer;
  }
  return -sum;
}

/// -A + mu reach D on the uniform grid, c = 1.
template <class K>
Complex discrete_central_symbol(const Analytic<K>& kernel, double k, double h, double delta, double mu) {
  const int L = std::max(static_cast<int>(delta / h), 1);
  double inner = 0.0, N = 0.0, A = 0.0, D = 0.0;
  for (int m = 1; m <= L; ++m) {
    const double outer = kernel.mass(m == L ? 1.0 : m * h / delta);
    const double W = (outer - inner) / (2.0 * delta);
    N += 2.0 * m * h * W;
    A += 2.0 * std::sin(k * m * h) * W;
    D += -4.0 * std::pow(std::sin(0.5 * k * m * h), 2) / (m * h) * W;
    inner = outer;
  }
  return {mu * std::max(delta, h) * D / N, -A / N};
}

/// Forward Euler from Re e^(ikx) against Re (1 + dt lambda)^n e^(ikx); returns the error relative to |1 + dt lambda|^n,
/// for steps short enough that the wave is not damped into the round-off of others.
template <class Scheme>
double error_after_steps(Scheme scheme, std::size_t N, double delta, int k, Complex lambda, double dt,
                         std::int64_t steps) {
  const auto x = uniform_positions(N, period);
  scheme.place(placed(x, period, delta), constant_velocity(1.0));
  std::vector<double> start;
  for (const double y : x) start.push_back(std::cos(k * y));
  PeriodicArray u = periodic(start);
  integrate(integrators[0], u, EqualSteps(dt * static_cast<double>(steps), steps),
            ExplicitSystem{[&](double, PeriodicArray& values, std::span<double> du) { scheme.rate(values, du); }},
            [](std::int64_t, TimeStep) { return true; });
  const Complex growth = std::exp(static_cast<double>(steps) * std::log(1.0 + dt * lambda));
  double worst = 0.0;
  for (std::size_t j = 0; j < N; ++j) {
    worst = std::fmax(worst, std::abs(u[static_cast<std::ptrdiff_t>(j)] - (growth * std::polar(1.0, k * x[j])).real()));
  }
  return worst / std::abs(growth);
}

constexpr std::size_t N = 48;
constexpr double h = period / N;
constexpr double horizons[] = {0.3 * h, 0.999 * h, 1.4 * h, 4.6 * h, 12.3 * h};
constexpr std::int64_t steps = 240;

SceneText wave(int k) {
  return {.name = "",
          .period = "2*pi",
          .T = "1",
          .c = "1",
          .b = std::nullopt,
          .u = "cos(" + std::to_string(k) + "*x)",
          .flow = std::nullopt};
}

/// max |f(x) - Re(S e^(ikx))| / |S| for the source of u = cos(kx), where S is the symbol of the whole operator.
double source_error(const NonlocalModel& model, int k, Complex S) {
  const Scene scene(wave(k));
  const auto source = nonlocal_source(scene, model);
  std::vector<double> x, f(37);
  for (int j = 0; j < 37; ++j) x.push_back(period * j / 37.0);
  source->place(x);
  source->evaluate(0.4, f);
  double worst = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    worst = std::fmax(worst, std::abs(f[j] - (S * std::polar(1.0, k * x[j])).real()));
  }
  return worst / std::abs(S);
}

}  // namespace

TEST_CASE("Model I propagates e^(ikx) by its discrete symbol") {
  const auto check = [](const auto& kernel) {
    for (const double delta : horizons) {
      for (const int k : {1, 3, 5}) {
        const double dt = 0.01 * h;
        const Complex lambda = discrete_upwind_symbol(kernel, k, h, delta);
        INFO(kernel.name << ", delta / h = " << delta / h << ", k = " << k << ", lambda = " << lambda);
        ModelI<std::decay_t<decltype(kernel.kernel)>, NoDivergence> scheme(kernel.kernel);
        CHECK(error_after_steps(scheme, N, delta, k, lambda, dt, steps) < 1e-11);
        // Negative control: a symbol that is off by 1e-9.
        CHECK(error_after_steps(scheme, N, delta, k, lambda * (1.0 + 1e-9), dt, steps) > 1e-11);
      }
    }
  };
  check(inverse());
  check(constant());
  check(root());
  check(spline());
}

TEST_CASE("Model I's discrete symbol for delta < h is that of the upwind difference") {
  for (const int k : {1, 2, 7}) {
    const Complex upwind = -(1.0 - std::polar(1.0, -k * h)) / h;
    CHECK(std::abs(discrete_upwind_symbol(spline(), k, h, 0.4 * h) - upwind) < 1e-14 / h);
    ModelI<CubicSplineKernel, NoDivergence> scheme(CubicSplineKernel{});
    CHECK(error_after_steps(scheme, N, 0.4 * h, k, upwind, 0.01 * h, steps) < 1e-11);
  }
}

TEST_CASE("Model II propagates e^(ikx) by its discrete symbol") {
  const auto check = [](const auto& kernel) {
    for (const double delta : horizons) {
      for (const int k : {1, 3, 5}) {
        for (const double mu : {1.0, 1.6}) {
          const double dt = 0.01 * h;
          const Complex lambda = discrete_central_symbol(kernel, k, h, delta, mu);
          INFO(kernel.name << ", delta / h = " << delta / h << ", k = " << k << ", mu = " << mu);
          ModelII<std::decay_t<decltype(kernel.kernel)>, NoDivergence> scheme(kernel.kernel, mu);
          CHECK(error_after_steps(scheme, N, delta, k, lambda, dt, steps) < 1e-11);
          CHECK(error_after_steps(scheme, N, delta, k, lambda * (1.0 + 1e-9), dt, steps) > 1e-11);
        }
      }
    }
  };
  check(constant());
  check(root());
  check(spline());
}

TEST_CASE("the exact symbols agree with their closed forms") {
  // k delta up to 7.5 loses nothing in the series; the closed forms are exact to a few units in the last place.
  for (const double delta : {0.3, 1.1, 2.5}) {
    for (const int k : {1, 2, 3}) {
      const double q = k * delta;
      CAPTURE(delta, k);
      const Complex inverse_form = Complex(std::numbers::egamma + std::log(q) - gsl_sf_Ci(q), gsl_sf_Si(q)) / delta;
      CHECK(std::abs(upwind_symbol(inverse_moment, k, delta) - inverse_form) < 1e-14 * std::abs(inverse_form));
      const Complex constant_form = 2.0 / (delta * delta) * Complex(delta - std::sin(q) / k, (1.0 - std::cos(q)) / k);
      CHECK(std::abs(upwind_symbol(power_moments(0.0), k, delta) - constant_form) < 1e-14 * std::abs(constant_form));
      // w = -rho_epsilon', epsilon = delta / 2: its transform is i k times that of the B-spline, sinc^4.
      const double sinc = std::sin(0.25 * q) / (0.25 * q);
      CHECK(std::abs(central_symbol(spline_moment, k, delta) - Complex(0.0, k * std::pow(sinc, 4))) < 1e-14 * k);
      // Constant kernel: (2 / delta^2) int_0^delta (cos(kz) - 1)/z dz = -(2 / delta^2) Cin(k delta).
      const double cin = std::numbers::egamma + std::log(q) - gsl_sf_Ci(q);
      CHECK_THAT(viscous_symbol(power_moments(0.0), k, delta), WithinAbs(-2.0 * cin / (delta * delta), 1e-13));
    }
  }
}

TEST_CASE("the nonlocal source of Model I for u = cos(kx), c = 1 is the exact symbol") {
  const auto check = [](const std::string& name, const auto& kernel, const Moments& moments) {
    for (const double delta : {1e-6, 1e-3, 0.2, 1.0, 2.5}) {
      for (const int k : {1, 3}) {
        INFO(name << ", delta = " << delta << ", k = " << k);
        const Complex S = upwind_symbol(moments, k, delta);
        CHECK(source_error({&upwind_continuum, false, profile(kernel), delta, 0.0}, k, S) < 1e-13);
        CHECK(source_error({&upwind_continuum, true, profile(kernel), delta, 0.0}, k, S) < 1e-13);
      }
    }
  };
  check("inverse", InverseKernel{}, inverse_moment);
  for (const double alpha : {1.5, 0.5, 0.0, -1.0}) {
    check("power " + std::to_string(alpha), PowerKernel(alpha), power_moments(alpha));
  }
  check("cubic spline", CubicSplineKernel{}, spline_moment);
}

TEST_CASE("the nonlocal source of Model II for u = cos(kx), c = 1 is the exact symbol") {
  const auto check = [](const std::string& name, const auto& kernel, const Moments& moments) {
    for (const double delta : {1e-6, 1e-3, 0.2, 1.0, 2.5}) {
      for (const int k : {1, 3}) {
        for (const double mu : {0.0, 0.4, 1.3}) {
          // Without viscosity the symbol nearly vanishes for long horizons, and with it the scale of the error.
          if (mu == 0.0 && delta > 1.0) continue;
          INFO(name << ", delta = " << delta << ", k = " << k << ", mu = " << mu);
          const Complex S = central_symbol(moments, k, delta) - delta * mu * viscous_symbol(moments, k, delta);
          CHECK(source_error({&viscous_continuum, false, profile(kernel), delta, mu}, k, S) < 1e-13);
        }
      }
    }
  };
  for (const double alpha : {0.5, 0.0, -1.0}) {
    check("power " + std::to_string(alpha), IntegrablePowerKernel(alpha), power_moments(alpha));
  }
  check("cubic spline", CubicSplineKernel{}, spline_moment);
}

TEST_CASE("at fixed horizon the particle operators converge to the exact symbols at first order in h") {
  constexpr double delta = 0.7, mu = 1.2;
  const auto check = [](const std::string& name, Complex exact, auto discrete) {
    std::vector<double> error;
    for (const int count : {100, 200, 400, 800, 1600}) {
      const auto u = [&](double x) { return std::cos(2.0 * x); };
      const auto x = uniform_positions(static_cast<std::size_t>(count), period);
      std::vector<double> values;
      for (const double y : x) values.push_back(u(y));
      const auto rate = discrete(x, values);
      double worst = 0.0;
      for (std::size_t j = 0; j < x.size(); ++j) {
        worst = std::fmax(worst, std::abs(rate[j] - (exact * std::polar(1.0, 2.0 * x[j])).real()));
      }
      error.push_back(worst);
    }
    INFO(name);
    CAPTURE(error);
    for (std::size_t i = 1; i < error.size(); ++i) {
      const double order = std::log2(error[i - 1] / error[i]);
      CHECK(order > 0.8);
      CHECK(order < 1.2);
    }
  };
  check("Model I, inverse", -upwind_symbol(inverse_moment, 2, delta), [&](const auto& x, const auto& u) {
    ModelI<InverseKernel, NoDivergence> scheme(InverseKernel{});
    scheme.place(placed(x, period, delta), constant_velocity(1.0));
    return rates(scheme, u);
  });
  check("Model I, cubic spline", -upwind_symbol(spline_moment, 2, delta), [&](const auto& x, const auto& u) {
    ModelI<CubicSplineKernel, NoDivergence> scheme(CubicSplineKernel{});
    scheme.place(placed(x, period, delta), constant_velocity(1.0));
    return rates(scheme, u);
  });
  const Complex central =
      -central_symbol(spline_moment, 2, delta) + mu * delta * viscous_symbol(spline_moment, 2, delta);
  check("Model II, cubic spline", central, [&](const auto& x, const auto& u) {
    ModelII<CubicSplineKernel, NoDivergence> scheme(CubicSplineKernel{}, mu);
    scheme.place(placed(x, period, delta), constant_velocity(1.0));
    return rates(scheme, u);
  });
}
