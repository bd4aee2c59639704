#include "studies/running/watch.hpp"

#include <cmath>

#include "solver/clones.hpp"

namespace acstudy {

bool gave_out(CaseResult& result, const Case& c, double seconds, double t) {
  if (!(seconds > c.limit)) return false;
  result.failure =
      fmt::format("{}{:g} s, at t = {:.3g} of {:.3g} with N = {}", over_limit, c.limit, t, c.scene->T(), c.N);
  return true;
}

void BoundWatch::step(std::int64_t n, TimeStep step) {
  const double ratio = step.dt / bound_;
  if (ratio > result_.largest) result_.largest = ratio;
  // A step that is equal to the bound up to round-off keeps it.
  if (ratio > 1.0 + 1e-12 && result_.first_step == 0) {
    result_.first_step = n;
    result_.first_time = step.begin;
    result_.first_place = place_;
  }
  bound_ = std::numeric_limits<double>::infinity();
}

GrowthWatch::GrowthWatch(std::span<const double> u) : exact_(size(u)), last_u_(u.begin(), u.end()) {}

namespace {

ACSTUDY_VECTOR_CLONES double largest_or_not_finite(const double* u, std::size_t count) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::size_t j = 0; j < count; ++j) {
    largest = std::abs(u[j]) > largest ? std::abs(u[j]) : largest;
    sum += 0.0 * u[j];  // NaN if the value is not finite, which the comparison passes over
  }
  return largest + sum;
}

}  // namespace

double GrowthWatch::size(std::span<const double> u) { return largest_or_not_finite(u.data(), u.size()); }

void GrowthWatch::give_up(std::int64_t n, double t, std::span<const double> u, std::int64_t last_step, double last_t,
                          const std::string& how) {
  const auto worse = [](double a, double b) { return !std::isnan(a) && (std::isnan(b) || std::abs(a) < std::abs(b)); };
  const auto worst = std::max_element(u.begin(), u.end(), worse);
  last_.step = last_step;
  last_.time = last_t;
  last_.particle = worst - u.begin();
  blow_up_ = fmt::format("the solution {} after step {}, at t = {:.6g}, particle {}", how, n, t, last_.particle);
}

}  // namespace acstudy
