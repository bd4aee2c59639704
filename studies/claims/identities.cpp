#include "studies/claims/identities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "mms/adaptive.hpp"

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

/// A point per N and horizon: what is worst of all particles and arrangements.
void measure(Finding& finding, const Subject& subject, const Sweep& sweep,
             const std::function<Measured(const View&)>& of) {
  for (const std::int64_t N : sweep.N) {
    for (const double delta : sweep.deltas(N, subject.scene->period())) {
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
      finding.points.push_back(point);
    }
  }
  finding.variable = "delta/h";
  judge(finding);
}

}  // namespace

Finding nearest_neighbor_rows(const Subject& subject, const std::vector<std::int64_t>& N, double ratio) {
  const Scene& scene = *subject.scene;
  const NearestNeighbors& nearest = subject.scheme.model->nearest;
  Finding finding = subject.finding(std::string(nearest.statement), std::string(nearest.claim),
                                    fmt::format("delta = {:g} h_min", ratio),
                                    "max |row - that of the difference| h_min / max|c_hat|", Test::bounds);
  if (ratio > 1.0) {
    finding.promised = finding.expected = Verdict::violated;
    finding.remark = "negative control: farther neighbors count";
  }
  for (const std::int64_t count : N) {
    for (const std::vector<double>& x : subject.positions(count)) {
      const Gaps gap = gaps(x, scene.period());
      PlacedScheme placed(subject.scheme, scene, subject.mu, x, ratio * gap.smallest);
      const PlacedScheme::Rows rows = placed.rows();
      const auto n = static_cast<std::ptrdiff_t>(x.size());
      double largest = 0.0;
      for (std::ptrdiff_t j = 0; j < n; ++j) {
        const double* const y = placed.particles().x.at(j);
        // Entries at j - 1, j, j + 1.
        const auto near = nearest.row(subject.scheme, scene, subject.mu, placed.particles().delta, y);
        for (std::size_t k = 0; k < rows.width; ++k) {
          const std::ptrdiff_t offset = (rows.first + static_cast<std::ptrdiff_t>(k) + 1 + n) % n;
          const double expected = offset < 3 ? near[static_cast<std::size_t>(offset)] : 0.0;
          const double off = std::abs(rows(static_cast<std::size_t>(j), k) - expected) * gap.smallest;
          if (worse(off, largest)) largest = off;
        }
      }
      finding.points.push_back({.N = count,
                                .h = gap.largest,
                                .delta = ratio * gap.smallest,
                                .variable = gap.largest,
                                .value = largest / scene.max_relative_velocity(),
                                .upper = 32.0 * epsilon + 2.0 * epsilon * scene.period() / gap.smallest});
    }
  }
  judge(finding);
  return finding;
}

Finding weights_are_not_negative(const Subject& subject, const Sweep& sweep) {
  const bool one_sided = subject.scheme.model->upwind;
  const WeightClaims& claims = subject.scheme.model->weights;
  Finding finding = subject.finding(std::string(claims.not_negative), std::string(claims.not_negative_claim), "weights",
                                    "max -W_k h", Test::bounds);
  measure(finding, subject, sweep, [&](const View& particle) {
    double largest = -HUGE_VAL;
    for (std::size_t k = 0; k < particle.z.size(); ++k) {
      const double negative = one_sided || particle.z[k] > 0.0 ? -particle.W[k] : particle.W[k];
      if (worse(negative, largest)) largest = negative;
    }
    return Measured{largest * particle.h, 0.0};
  });
  return finding;
}

Finding first_moment_is_one(const Subject& subject, const Sweep& sweep) {
  const WeightClaims& claims = subject.scheme.model->weights;
  Finding finding = subject.finding(std::string(claims.first_moment), std::string(claims.first_moment_claim),
                                    "first moment", "max |sum - 1|", Test::bounds);
  finding.remark = "bound: an ulp per neighbor and four more, and an ulp of a position relative to a gap";
  measure(finding, subject, sweep, [](const View& particle) {
    const double moment = particle.sum([](double z, double W) { return std::abs(z * W); }) / particle.N;
    return Measured{std::abs(moment - 1.0), particle.round_off() + particle.ulp_of_gap};
  });
  return finding;
}

Finding weights_cancel(const Subject& subject, const Sweep& sweep) {
  Finding finding = subject.finding("(3.4), sum of weights", "sum W_k = 0", "sum of weights",
                                    "max |sum W_k| / sum |W_k|", Test::bounds);
  finding.remark = "bound: an ulp per neighbor and four more";
  measure(finding, subject, sweep, [](const View& particle) {
    const double sum = particle.sum([](double, double W) { return W; });
    return Measured{std::abs(sum) / particle.sum([](double, double W) { return std::abs(W); }), particle.round_off()};
  });
  return finding;
}

Finding second_moment_is_bounded(const Subject& subject, const Sweep& sweep, bool one_sided) {
  Finding finding = subject.finding(
      one_sided ? "(3.5), with |W_k|" : "(3.5)", "second moment at most max(h, delta)", "second moment",
      one_sided ? "max sum z^2 |W_k| / (N_j max(h, delta))" : "max |sum z^2 W_k| / (N_j max(h, delta))", Test::bounds);
  if (one_sided) finding.remark = "what Lemma 3.4 rests on: the printed sum is smaller, since its two sides cancel";
  measure(finding, subject, sweep, [one_sided](const View& particle) {
    const double sum = particle.sum([&](double z, double W) { return z * z * (one_sided ? std::abs(W) : W); });
    return Measured{std::abs(sum) / particle.N / std::max(particle.h, particle.delta), 1.0 + particle.round_off()};
  });
  return finding;
}

Finding renormalization_is_near_one(const Subject& subject, const Sweep& sweep) {
  const double mass = total_mass(subject.scheme.kernel);
  Finding finding =
      subject.finding("Lemma 3.1", "|N_j - 1| <= C h/delta", "whatever delta", "max |N_j - 1| delta / h", Test::bounds);
  finding.remark =
      fmt::format("C = int_0^1 eta = {:.6g}: no particle is farther than h from any point of its cell", mass);
  measure(finding, subject, sweep, [mass](const View& particle) {
    const double ratio = particle.delta / particle.h;
    return Measured{std::abs(particle.N - 1.0) * ratio,
                    mass * (1.0 + particle.round_off()) + particle.round_off() * ratio};
  });
  return finding;
}

Finding order_of_renormalization(const Subject& subject, const std::vector<std::int64_t>& N, double delta) {
  Finding finding = subject.finding("Lemma 3.1", "N_j - 1 = O(h/delta)", fmt::format("delta = {:.4g}", delta),
                                    "max |N_j - 1|", Test::rate);
  for (const std::int64_t count : N) {
    Finding one = subject.finding({}, {}, {}, {}, Test::bounds);
    measure(one, subject, {{count}, {}, {delta}}, [](const View& particle) {
      return Measured{std::abs(particle.N - 1.0), 0.0};
    });
    Point& point = finding.points.emplace_back(one.points.front());
    point.variable = point.h / delta;
    point.upper = HUGE_VAL;
  }
  finding.variable = "h/delta";
  finding.theory_order = 1.0;
  judge(finding);
  return finding;
}

Finding renormalization_is_at_least_one(const Subject& subject, std::int64_t N) {
  Finding finding = subject.finding("Lemma 3.1, as printed", "N_j >= 1", {}, "min N_j", Test::bounds);
  finding.check = "gaps in every pattern of 1, 4 and 20, horizons just below a particle";
  finding.expected = Verdict::violated;
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
  finding.variable = "delta/h";
  judge(finding);
  return finding;
}

Finding kernel_moments(const KernelChoice& kernel) {
  Finding finding{.statement = "(2.3)",
                  .claim = "int s eta^delta(s) ds = 1 and the closed forms of cell moments are the integrals",
                  .subject = "kernel " + kernel.label(),
                  .check = "adaptive quadrature",
                  .quantity = "moments over (0, z) / closed forms",
                  .test = Test::bounds,
                  .variable = "z",
                  .promised = Verdict::holds,
                  .expected = Verdict::holds};
  if (integrable(kernel)) {
    finding.remark = "also int z w^delta(z) dz = 1 of Model II, whose kernel is the odd extension, halved";
  }
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
  judge(finding);
  return finding;
}

}  // namespace acstudy
