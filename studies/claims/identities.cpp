#include "studies/claims/identities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "mms/line/adaptive.hpp"

namespace acstudy {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// What is measured at one particle and what it may be at most.
struct Measured {
  double value, upper;
  double excess() const { return upper > 0.0 ? value / upper : value; }
};

/// A particle with what it sees: distances z = x_i - x_j, weights W and N_j.
struct View {
  std::vector<double> z, W;
  double N, h, delta;  ///< h: the largest gap of the arrangement
  double ulp_of_gap;   ///< an ulp of a position, relative to the smallest gap
  /// Round-off of a sum over the neighbors whose terms sum to one in absolute value.
  double round_off() const { return (static_cast<double>(z.size()) + 4.0) * epsilon; }
  double sum(const std::function<double(double z, double W)>& term) const {
    double total = 0.0;
    for (std::size_t k = 0; k < z.size(); ++k) total += term(z[k], W[k]);
    return total;
  }
};

View view(const PlacedScheme& placed, std::ptrdiff_t j, const Gaps& gap) {
  Stencil stencil = placed.scheme().stencil(j);
  View view{{},          std::move(stencil.weight), stencil.renormalization,
            gap.largest, placed.particles().delta,  epsilon * placed.particles().period / gap.smallest};
  const double* const x = placed.particles().x.at(j);
  for (const std::ptrdiff_t k : stencil.offset) view.z.push_back(x[k] - x[0]);
  return view;
}

using OfParticle = std::function<Measured(const View&)>;

/// A point per N and horizon: what is worst of all particles and arrangements.
std::vector<Point> worst_points(const Subject& subject, const Resolutions& resolutions, const OfParticle& of) {
  std::vector<Point> points;
  for (const std::int64_t N : resolutions.N) {
    for (const double delta : resolutions.deltas(N, subject.scene->period())) {
      Point point{.N = N, .delta = delta};
      Measured worst{-HUGE_VAL, 0.0};
      for (const std::vector<double>& x : subject.positions(N)) {
        const PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
        const Gaps gap = gaps(x, subject.scene->period());
        for (std::ptrdiff_t j = 0; j < static_cast<std::ptrdiff_t>(x.size()); ++j) {
          const Measured measured = of(view(placed, j, gap));
          if (!worse(measured.excess(), worst.excess())) continue;
          worst = measured;
          point.h = gap.largest;
        }
      }
      point.variable = delta / point.h;
      point.value = worst.value;
      point.upper = worst.upper;
      points.push_back(point);
    }
  }
  return points;
}

Measurement over_horizons(Check check, const Subject& subject, const Resolutions& resolutions, const OfParticle& of) {
  check.variable = "delta/h";
  return {std::move(check), [=](Finding& finding) { finding.points = worst_points(subject, resolutions, of); }};
}

/// The largest difference of any entry of the operator to that row, in units of max|c_hat| / h_min.
Point distance_to_difference(const Subject& subject, const std::vector<double>& x, double ratio) {
  const Scene& scene = *subject.scene;
  const Gaps gap = gaps(x, scene.period());
  PlacedScheme placed(subject.scheme, scene, subject.mu, x, ratio * gap.smallest);
  const PlacedScheme::Rows rows = placed.rows();
  const std::ptrdiff_t n = std::ssize(x);
  const Particles& particles = placed.particles();
  double largest = 0.0;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const std::array<double, 3> near =
        subject.scheme.model->nearest.row(subject.scheme, scene, subject.mu, particles.delta, particles.x.at(j));
    for (std::size_t k = 0; k < rows.width; ++k) {
      const std::ptrdiff_t offset = (rows.first + static_cast<std::ptrdiff_t>(k) + 1 + n) % n;
      const double expected = offset < 3 ? near[static_cast<std::size_t>(offset)] : 0.0;
      const double off = std::abs(rows(static_cast<std::size_t>(j), k) - expected) * gap.smallest;
      if (worse(off, largest)) largest = off;
    }
  }
  return {.N = n,
          .h = gap.largest,
          .delta = ratio * gap.smallest,
          .variable = gap.largest,
          .value = largest / scene.max_relative_velocity(),
          .upper = 32.0 * epsilon + 2.0 * epsilon * scene.period() / gap.smallest};
}

}  // namespace

Measurement nearest_neighbor_rows(const Subject& subject, const std::vector<std::int64_t>& N, double ratio) {
  const NearestNeighbors& nearest = subject.scheme.model->nearest;
  Check check = subject.check(std::string(nearest.statement), std::string(nearest.claim),
                              {{"delta/h_min", ratio, fmt::format("delta = {:g} h_min", ratio)}},
                              "max |row - that of the difference| h_min / max|c_hat|");
  if (ratio > 1.0) {
    check.be_control("farther neighbors count");
    check.promised = Verdict::violated;
  }
  return {check, [=](Finding& finding) {
            for (const std::int64_t count : N) {
              for (const std::vector<double>& x : subject.positions(count)) {
                finding.points.push_back(distance_to_difference(subject, x, ratio));
              }
            }
          }};
}

Measurement weights_are_not_negative(const Subject& subject, const Resolutions& resolutions) {
  const bool one_sided = subject.scheme.model->upwind;
  const WeightClaims& claims = subject.scheme.model->weights;
  const Check check = subject.check(std::string(claims.not_negative), std::string(claims.not_negative_claim),
                                    {{"of", "weights"}}, "max -W_k h");
  return over_horizons(check, subject, resolutions, [=](const View& particle) {
    double largest = -HUGE_VAL;
    for (std::size_t k = 0; k < particle.z.size(); ++k) {
      const double negative = one_sided || particle.z[k] > 0.0 ? -particle.W[k] : particle.W[k];
      if (worse(negative, largest)) largest = negative;
    }
    return Measured{largest * particle.h, 0.0};
  });
}

Measurement first_moment_is_one(const Subject& subject, const Resolutions& resolutions) {
  const WeightClaims& claims = subject.scheme.model->weights;
  Check check = subject.check(std::string(claims.first_moment), std::string(claims.first_moment_claim),
                              {{"of", "first moment"}}, "max |sum - 1|");
  check.remark = "bound: an ulp per neighbor and four more, and an ulp of a position relative to a gap";
  return over_horizons(check, subject, resolutions, [](const View& particle) {
    const double moment = particle.sum([](double z, double W) { return std::abs(z * W); }) / particle.N;
    return Measured{std::abs(moment - 1.0), particle.round_off() + particle.ulp_of_gap};
  });
}

Measurement weights_cancel(const Subject& subject, const Resolutions& resolutions) {
  Check check =
      subject.check("(3.4), sum of weights", "sum W_k = 0", {{"of", "sum of weights"}}, "max |sum W_k| / sum |W_k|");
  check.remark = "bound: an ulp per neighbor and four more";
  return over_horizons(check, subject, resolutions, [](const View& particle) {
    const double sum = particle.sum([](double, double W) { return W; });
    return Measured{std::abs(sum) / particle.sum([](double, double W) { return std::abs(W); }), particle.round_off()};
  });
}

Measurement second_moment_is_bounded(const Subject& subject, const Resolutions& resolutions, bool one_sided) {
  Check check = subject.check(
      one_sided ? "(3.5), with |W_k|" : "(3.5)", "second moment at most max(h, delta)", {{"of", "second moment"}},
      one_sided ? "max sum z^2 |W_k| / (N_j max(h, delta))" : "max |sum z^2 W_k| / (N_j max(h, delta))");
  if (one_sided) check.remark = "what Lemma 3.4 rests on: the printed sum is smaller, since its two sides cancel";
  return over_horizons(check, subject, resolutions, [one_sided](const View& particle) {
    const double sum = particle.sum([&](double z, double W) { return z * z * (one_sided ? std::abs(W) : W); });
    return Measured{std::abs(sum) / particle.N / std::max(particle.h, particle.delta), 1.0 + particle.round_off()};
  });
}

Measurement renormalization_is_near_one(const Subject& subject, const Resolutions& resolutions) {
  const double mass = total_mass(subject.scheme.kernel);
  Check check =
      subject.check("Lemma 3.1", "|N_j - 1| <= C h/delta", {{"delta", "whatever delta"}}, "max |N_j - 1| delta / h");
  check.remark =
      fmt::format("C = int_0^1 eta = {:.6g}: no particle is farther than h from any point of its cell", mass);
  return over_horizons(check, subject, resolutions, [mass](const View& particle) {
    const double ratio = particle.delta / particle.h;
    return Measured{std::abs(particle.N - 1.0) * ratio,
                    mass * (1.0 + particle.round_off()) + particle.round_off() * ratio};
  });
}

Measurement order_of_renormalization(const Subject& subject, const std::vector<std::int64_t>& N, double delta) {
  Check check = subject.check("Lemma 3.1", "N_j - 1 = O(h/delta)", {{"delta", delta, fmt::format("delta = {}", delta)}},
                              "max |N_j - 1|", Test::rate);
  check.variable = "h/delta";
  check.theory_order = 1.0;
  return {check, [=](Finding& finding) {
            finding.points = worst_points(subject, {N, {}, {delta}}, [](const View& particle) {
              return Measured{std::abs(particle.N - 1.0), 0.0};
            });
            for (Point& point : finding.points) {
              point.variable = point.h / delta;
              point.upper = HUGE_VAL;
            }
          }};
}

namespace {

void search_least_renormalization(Finding& finding, const Subject& subject, std::int64_t N) {
  const double period = subject.scene->period();
  Point least{.N = N, .value = HUGE_VAL, .lower = 1.0};
  constexpr int lengths[] = {1, 4, 20};
  for (int pattern = 0; pattern < 81; ++pattern) {
    const int gap[] = {lengths[pattern % 3], lengths[pattern / 3 % 3], lengths[pattern / 9 % 3], lengths[pattern / 27]};
    const double unit = period / static_cast<double>(N / 4 * (gap[0] + gap[1] + gap[2] + gap[3]));
    std::vector<double> x;
    int position = 0;
    for (std::int64_t j = 0; j < N; position += gap[j++ % 4]) x.push_back(unit * position);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 2; k < 6; ++k) {
        const double delta = (1.0 - 1e-6) * (x[i + k] - x[i]);
        const PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
        for (std::ptrdiff_t j = 0; j < 4; ++j) {
          const double value = placed.scheme().stencil(j).renormalization;
          if (!worse(-value, -least.value)) continue;
          least.value = value;
          least.h = gaps(x, period).largest;
          least.delta = delta;
          least.variable = delta / least.h;
          finding.remark = fmt::format(
              "gaps like {}, {}, {}, {}: the outermost cell ends at the horizon, and where the next particle is just "
              "beyond it, the cell's own particle is far inside",
              gap[0], gap[1], gap[2], gap[3]);
        }
      }
    }
  }
  finding.points.push_back(least);
}

void compare_moments(Finding& finding, const KernelChoice& kernel) {
  with_kernel(kernel, [&]<class K>(const K& k) {
    const auto add = [&](int power, double z, double closed, SourceRule rule) {
      const double moment = kernel_moment_adaptively(profile(k), power, z, rule);
      finding.points.push_back({.variable = z, .value = moment / closed, .lower = 1.0 - 1e-12, .upper = 1.0 + 1e-12});
    };
    for (const SourceRule rule : {SourceRule::gsl, SourceRule::boost}) {
      add(1, 1.0, 1.0, rule);
      for (const double z : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}) {
        add(1, z, k.first_moment(z), rule);
        if constexpr (IntegrableKernel<K>) add(0, z, k.mass(z), rule);
      }
    }
  });
}

}  // namespace

Measurement renormalization_is_at_least_one(const Subject& subject, std::int64_t N) {
  Check check = subject.check("Lemma 3.1, as printed", "N_j >= 1",
                              {{"delta", "just below a particle", "horizons just below a particle"}}, "min N_j");
  check.coordinates.front() = {"arrangement", "gaps in every pattern of 1, 4 and 20"};
  check.variable = "delta/h";
  check.expected = Verdict::violated;
  return {check, [=](Finding& finding) { search_least_renormalization(finding, subject, N); }};
}

Measurement kernel_moments(const KernelChoice& kernel) {
  Check check{.statement = "(2.3)",
              .claim = "int s eta^delta(s) ds = 1 and the closed forms of cell moments are the integrals",
              .subject = "kernel " + kernel.label(),
              .coordinates = {{"by", "adaptive quadrature"}},
              .quantity = "moments over (0, z) / closed forms",
              .variable = "z"};
  if (integrable(kernel)) {
    check.remark = "also int z w^delta(z) dz = 1 of Model II, whose kernel is the odd extension, halved";
  }
  return {check, [=](Finding& finding) { compare_moments(finding, kernel); }};
}

}  // namespace acstudy
