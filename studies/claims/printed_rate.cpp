#include "studies/claims/printed_rate.hpp"

#include <algorithm>
#include <cmath>

namespace acstudy {

namespace {

/// A neighbor: its distance, not wrapped, and value.
struct Neighbor {
  double z, x, u;  ///< z = x_i - x_j
};

/// The neighbors within delta on the side s = +1 (left) or -1 (right), at least the nearest one.
std::vector<Neighbor> neighbors(const std::vector<double>& x, const std::vector<double>& u, double period, double delta,
                                std::size_t j, int s) {
  std::vector<Neighbor> near;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (const int turn : {-1, 0, 1}) {
      const double position = x[i] + turn * period, z = position - x[j];
      if (s * z < 0.0 && (turn != 0 || i != j)) near.push_back({z, position, u[i]});
    }
  }
  std::sort(near.begin(), near.end(),
            [](const Neighbor& a, const Neighbor& b) { return std::abs(a.z) < std::abs(b.z); });
  std::size_t count = 1;
  while (count < near.size() && std::abs(near[count].z) <= delta * (1.0 + horizon_tie_tolerance)) ++count;
  near.resize(count);
  return near;
}

struct Velocity {
  const Scene& scene;
  double c(double x) const {
    double value = 0.0;
    scene.c({&x, 1}, {&value, 1});
    return value;
  }
  double b(double x) const {
    double value = 0.0;
    if (!scene.standing()) scene.b({&x, 1}, {&value, 1});
    return value;
  }
  double b_prime(double x) const {
    double value = 0.0;
    if (!scene.standing()) scene.b_prime({&x, 1}, {&value, 1});
    return value;
  }
  double c_hat(double x) const { return c(x) - b(x); }
  double size(double x) const { return std::abs(c(x)) + std::abs(b(x)); }
};

struct Sum {
  double value = 0.0, size = 0.0;
  void add(double term, double size_of_term) {
    value += term;
    size += std::abs(size_of_term);
  }
};

}  // namespace

PrintedRate printed_rate(const Subject& subject, const std::vector<double>& x, const std::vector<double>& u,
                         double delta, std::size_t j) {
  const double period = subject.scene->period(), x_j = x[j], u_j = u[j];
  const Velocity v{*subject.scene};
  const bool nonlocal = subject.scheme.nonlocal_divergence;
  Sum rate;
  if (!nonlocal) rate.add(-v.b_prime(x_j) * u_j, v.b_prime(x_j) * u_j);

  with_kernel(subject.scheme.kernel, [&]<class K>(const K& kernel) {
    if (subject.scheme.model == 1) {
      const int s = v.c_hat(x_j) > 0.0 ? +1 : -1;
      const std::vector<Neighbor> near = neighbors(x, u, period, delta, j, s);
      double inner = 0.0;
      for (std::size_t k = 0; k < near.size(); ++k) {
        const Neighbor& i = near[k];
        const double d = std::abs(i.z);
        const double outer = k + 1 < near.size() ? kernel.first_moment(std::min(d / delta, 1.0)) : 1.0;
        const double W = (outer - inner) / d;
        const double own = nonlocal ? v.c(x_j) - v.b(i.x) : v.c_hat(x_j);
        rate.add(-s * (own * u_j - v.c_hat(i.x) * i.u) * W,
                 ((v.size(x_j) + v.size(i.x)) * std::abs(u_j) + v.size(i.x) * std::abs(i.u)) * W);
        inner = outer;
      }
      return;
    }
    if constexpr (IntegrableKernel<K>) {
      Sum N, A, D, B;
      double reach = delta;
      for (const int s : {+1, -1}) {
        const std::vector<Neighbor> near = neighbors(x, u, period, delta, j, s);
        double inner = 0.0;
        for (std::size_t k = 0; k < near.size(); ++k) {
          const Neighbor& i = near[k];
          const double outer = kernel.mass(k + 1 < near.size() ? std::min(std::abs(i.z) / delta, 1.0) : 1.0);
          const double W = -s * (outer - inner) / (2.0 * delta), middle = 0.5 * (x_j + i.x);
          N.add(i.z * W, i.z * W);
          A.add(v.c_hat(middle) * (u_j + i.u) * W, v.size(middle) * (std::abs(u_j) + std::abs(i.u)) * W);
          D.add((i.u - u_j) / i.z * W, (std::abs(i.u) + std::abs(u_j)) / i.z * W);
          B.add(2.0 * v.b(middle) * W, 2.0 * v.b(middle) * W);
          inner = outer;
        }
        reach = std::max(reach, std::abs(near.back().z));
      }
      rate.add(-A.value / N.value, A.size / N.value);
      rate.add(subject.mu * reach * D.value / N.value, subject.mu * reach * D.size / N.value);
      if (nonlocal) rate.add(-B.value / N.value * u_j, B.size / N.value * u_j);
    }
  });
  return {rate.value, rate.size};
}

}  // namespace acstudy
