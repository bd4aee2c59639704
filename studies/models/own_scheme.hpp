#pragma once

/// @file
/// A scheme of your own: the rate of one particle, what theory says of it, and a line that registers it. From then on
/// studies can name it, as model = "its name".
///
///     struct Upwind {
///       template <class Add>
///       static void rate(const acstudy::OneParticle& p, Add add) { ... add(k, coefficient); ... }
///     };
///     const acstudy::OwnScheme<Upwind> registered{{.name = "my-upwind", .order = 1.0}};

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"
#include "studies/models/model_card.hpp"
#include "studies/models/scheme_on.hpp"

namespace acstudy {

/// A particle j and its neighbors i = j + k, k = -left() .. right(): all within the horizon, and on each side at least
/// one.
class OneParticle {
 public:
  int left() const { return left_; }
  int right() const { return right_; }
  /// x_i - x_j
  double z(int k) const { return x_[k] - x_[0]; }
  double c(int k = 0) const { return c_[k]; }
  /// Velocity of the particle; 0 where they stand still.
  double b(int k = 0) const { return b_[k]; }
  double c_hat(int k = 0) const { return c_[k] - b_[k]; }
  /// b' at the particle.
  double b_prime() const { return b_prime_; }
  double delta() const { return delta_; }
  /// True if the study asks for a nonlocal divergence, in place of b' u.
  bool nonlocal_divergence() const { return scheme_.nonlocal_divergence; }
  /// The integral of r eta^delta(r) over 0 <= r <= distance, 1 at the horizon: of the kernel that the study names.
  double first_moment(double distance) const { return acstudy::first_moment(scheme_.kernel, inside(distance)); }
  /// delta times the integral of eta^delta.  @throws std::domain_error if the kernel is not integrable
  double mass(double distance) const {
    if (!integrable(scheme_.kernel)) throw std::domain_error("kernel " + scheme_.kernel.label() + " is not integrable");
    return acstudy::mass(scheme_.kernel, inside(distance));
  }

 private:
  template <class>
  friend class OwnSums;
  OneParticle(const SchemeChoice& scheme, double delta) : scheme_(scheme), delta_(delta) {}
  double inside(double distance) const { return std::min(distance / delta_, 1.0); }

  const SchemeChoice& scheme_;
  double delta_;
  int left_ = 0, right_ = 0;
  const double *x_ = nullptr, *c_ = nullptr, *b_ = nullptr;
  double b_prime_ = 0.0;
};

/// A scheme linear in u: rate(p, add) calls add(k, a) for each term a u_{j+k} of du_j/dt, the source not among them.
/// Terms of one k add up.
template <class S>
concept RateOfOneParticle = requires(const OneParticle& p, void (*add)(int k, double coefficient)) {
  S::rate(p, add);
};

/// What its author says of a scheme, and acstudy examines.
struct OwnFacts {
  std::string_view name;    ///< as studies write it
  double order;             ///< in max(h, delta), with the source of the PDE
  bool in_h_alone = false;  ///< the order is in h, whatever the horizon is
  /// Forward Euler is monotone up to dt = h_min / (speed max|c - b|), and rows as far as their diagonal allows; 0:
  /// nothing is said of it.
  double speed = 0.0;
  std::string_view statement = "its author";  ///< of a theorem, if there is one
};

template <class S>
inline OwnFacts own_facts{};

/// The sums of a scheme of one's own, row by row: a model of Scheme.
template <class S>
class OwnSums {
 public:
  OwnSums(const SchemeChoice& scheme, bool standing) : scheme_(scheme), standing_(standing) {}

  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity) {
    const auto x = particles.x.values();
    const std::ptrdiff_t N = std::ssize(x);
    widest_ = particles.windows.widest;
    PeriodicArray c(x.size()), b(x.size());
    std::vector<double> b_prime(x.size(), 0.0);
    velocity.c(x, c.values());
    if (!standing_) {
      velocity.b(x, b.values());
      velocity.b_prime(x, b_prime);
    }
    for (PeriodicArray* const field : {&c, &b}) field->wrap(widest_);
    work_.velocity_evaluations += (standing_ ? 1 : 3) * N;

    begin_.assign(1, 0);
    own_.assign(x.size(), 0.0);
    neighbors_.clear();
    left_ = particles.windows.left;
    OneParticle p(scheme_, particles.delta);
    for (std::ptrdiff_t j = 0; j < N; ++j) {
      p.left_ = particles.windows.left[j];
      p.right_ = particles.windows.right[j];
      p.x_ = particles.x.at(j);
      p.c_ = c.at(j);
      p.b_ = b.at(j);
      p.b_prime_ = b_prime[j];
      begin_.push_back(begin_.back() + p.left_ + p.right_);
      neighbors_.resize(begin_.back(), 0.0);
      S::rate(p, [&](int k, double coefficient) {
        if (k < -p.left_ || k > p.right_) {
          throw std::domain_error(std::string(own_facts<S>.name) + " adds neighbor " + std::to_string(k) +
                                  " of a particle that sees -" + std::to_string(p.left_) + " to " +
                                  std::to_string(p.right_));
        }
        (k == 0 ? own_[j] : neighbors_[place_of(j, k)]) += coefficient;
      });
    }
    ++work_.weight_builds;
  }

  void rate(PeriodicArray& u, std::span<double> du) {
    u.wrap(widest_);
    for (std::ptrdiff_t j = 0; j < std::ssize(u); ++j) {
      double sum = own_[j] * u[j];
      each(j, [&](std::ptrdiff_t k, double coefficient) { sum += coefficient * u[j + k]; });
      du[j] = sum;
    }
    work_.pairs += std::ssize(neighbors_);
  }

  void matrix(RateMatrix& R) const {
    const std::ptrdiff_t N = std::ssize(own_);
    R.clear();
    for (std::ptrdiff_t j = 0; j < N; ++j) {
      each(j, [&](std::ptrdiff_t k, double coefficient) { R.add(j + k, N, coefficient); });
      R.add(j, N, own_[j]);
      R.end_row();
    }
  }

  /// The largest -R_jj: within its inverse no diagonal entry of a step of forward Euler is negative.
  double strongest_decay() const {
    double strongest = 0.0;
    for (const double own : own_) strongest = std::max(strongest, -own);
    return strongest;
  }

  /// The coefficients of the neighbors.
  std::span<const double> weights(std::ptrdiff_t j) const {
    return {neighbors_.data() + begin_[j], neighbors_.data() + begin_[j + 1]};
  }
  double renormalization(std::ptrdiff_t) const { return 1.0; }
  const WorkCounts& work() const { return work_; }

 private:
  std::ptrdiff_t place_of(std::ptrdiff_t j, std::ptrdiff_t k) const {
    return begin_[j] + left_[j] + k - (k > 0 ? 1 : 0);
  }
  template <class Visit>
  void each(std::ptrdiff_t j, Visit&& visit) const {
    std::ptrdiff_t k = -left_[j];
    for (const double coefficient : weights(j)) {
      visit(k, coefficient);
      k += k == -1 ? 2 : 1;
    }
  }

  const SchemeChoice scheme_;
  bool standing_;
  std::vector<std::ptrdiff_t> begin_;
  std::vector<double> own_, neighbors_;
  std::vector<int> left_;
  int widest_ = 0;
  WorkCounts work_;
};

/// A checksum of a scheme's coefficients on particles and velocities drawn at random: stored cases of a scheme whose
/// code has changed since are not taken for its own.
template <class S>
std::uint64_t drawn_checksum() {
  struct Drawn {
    void c(std::span<const double> x, std::span<double> out) const { draw(x, out, 3); }
    void b(std::span<const double> x, std::span<double> out) const { draw(x, out, 5); }
    void b_prime(std::span<const double> x, std::span<double> out) const { draw(x, out, 7); }
    static void draw(std::span<const double> x, std::span<double> out, unsigned seed) {
      std::mt19937 generator(seed);
      for (std::size_t i = 0; i < x.size(); ++i) out[i] = static_cast<double>(generator()) / 0x1p31 - 1.0;
    }
  };
  constexpr std::size_t N = 24;
  const std::vector<double> x = start_positions({Start::Kind::jittered, 0.3}, N, 1.0);
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto mix = [&](double value) { hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3U; };
  for (const bool nonlocal : {false, true}) {
    for (const double spacings : {0.4, 1.7, 4.3}) {
      const SchemeChoice scheme{.model = nullptr, .nonlocal_divergence = nonlocal, .kernel = integrable_kernel()};
      OwnSums<S> sums(scheme, false);
      Particles particles(N, 1.0, spacings / N);
      particles.place(x);
      sums.place(particles, Drawn{});
      RateMatrix R;
      sums.matrix(R);
      for (const double value : R.value) mix(value);
    }
  }
  return hash;
}
template <class S>
std::uint64_t fingerprint() {
  static const std::uint64_t value = drawn_checksum<S>();
  return value;
}

/// Registers a scheme, as long as the program runs; to be defined once, outside of functions.
template <RateOfOneParticle S>
class OwnScheme {
 public:
  explicit OwnScheme(const OwnFacts& facts) {
    own_facts<S> = facts;
    card_.name = facts.name;
    card_.equations = card_.theorems = {facts.statement, facts.statement, facts.statement};
    card_.order = facts.order;
    card_.order_in_h = facts.in_h_alone;
    card_.fingerprint = fingerprint<S>;
    card_.make = [](const SchemeChoice& choice, const Scene& scene, double) {
      return on(OwnSums<S>(choice, scene.standing()), choice, scene);
    };
    card_.step_lemma.promised = facts.speed > 0.0;
    card_.step_lemma.speed = [](const Scene& scene, double) {
      const double speed = own_facts<S>.speed;
      return (speed > 0.0 ? speed : 1.0) * scene.max_relative_velocity();
    };
    add_model(card_);
  }

 private:
  ModelCard card_ = card_beyond_paper();
};

}  // namespace acstudy
