/// @file
/// A program on the solver alone: Model I (2.4) on standing particles keeps a constant constant.
/// The build links it with acstudy_solver and nothing else.

#include <cmath>
#include <cstdio>

#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "solver/time/integrate.hpp"

namespace {

struct ConstantVelocity {
  void c(std::span<const double> x, std::span<double> out) const {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = 1.0;
  }
};

}  // namespace

int main() {
  constexpr std::size_t N = 64;
  constexpr double period = 1.0, delta = 0.1, T = 0.5;
  acstudy::Particles particles(N, period, delta);
  particles.place(acstudy::uniform_positions(N, period));
  acstudy::ModelI<acstudy::InverseKernel, acstudy::NoDivergence> scheme{acstudy::InverseKernel{}};
  scheme.place(particles, ConstantVelocity{});
  acstudy::PeriodicArray u(N);
  for (double& value : u.values()) value = 3.0;
  acstudy::integrate(acstudy::integrators[2], u, acstudy::EqualSteps(T, acstudy::steps_for(T, period / N)),
                     acstudy::ExplicitSystem{[&](double, acstudy::PeriodicArray& values, std::span<double> du) {
                       scheme.rate(values, du);
                     }},
                     [](std::int64_t, acstudy::TimeStep) { return true; });
  double worst = 0.0;
  for (const double value : u.values()) worst = std::fmax(worst, std::fabs(value - 3.0));
  std::printf("largest change of a constant: %g\n", worst);
  return worst < 1e-13 ? 0 : 1;
}
