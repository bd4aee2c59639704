#pragma once

/// @file
/// Any scheme on a line behind one interface: the place where the choices of a study become types.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "mms/quadrature.hpp"
#include "mms/scene.hpp"
#include "mms/source.hpp"
#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"
#include "studies/models/scheme_choice.hpp"

namespace acstudy {

/// The weights with which a particle sees its neighbors.
struct Stencil {
  std::vector<std::ptrdiff_t> offset;  ///< neighbor j + offset
  std::vector<double> weight;          ///< W, as the model defines it
  double renormalization = 1.0;        ///< N_j of Model II
};

/// What a scheme knows of the rows of its rates, at the particles where it was placed; see KnowsItsRows.
class SchemeRows {
 public:
  virtual void matrix(RateMatrix& R) const = 0;
  virtual double strongest_decay() const = 0;

 protected:
  ~SchemeRows() = default;
};

/// A semidiscrete scheme of any type, du_j/dt = rate_j(u) + f_j. One virtual call a sweep over all particles, none a
/// pair.
class LineScheme {
 public:
  virtual ~LineScheme() = default;
  /// Computes velocities and weights for the particles where they are now.
  virtual void place(const Particles& particles) = 0;
  /// du_j = rate_j(u).  @pre place() was called; wraps the ghosts of `u`
  virtual void rate(PeriodicArray& u, std::span<double> du) = 0;
  virtual Stencil stencil(std::ptrdiff_t j) const = 0;
  /// V_j where the unknown, and what rate() takes and gives, is V_j u_j; empty where it is u_j.  @pre place() was
  /// called
  virtual std::span<const double> volumes() const { return {}; }
  /// How far from a particle, in particles, those are that its rate depends on.  @pre place() was called
  virtual std::ptrdiff_t reach() const = 0;
  /// Null for a control that has sums of its own, and for a scheme that is not linear.
  virtual const SchemeRows* rows() const = 0;
  virtual WorkCounts work() const = 0;
};

/// The scheme of a choice on a scene.
/// @param mu     viscosity bound, of a viscous model
/// @param scene  outlives the scheme
std::unique_ptr<LineScheme> make_scheme(const SchemeChoice& choice, const Scene& scene, double mu);

/// The continuum model that a scheme discretizes at horizon `delta`.
NonlocalModel nonlocal_model(const SchemeChoice& choice, double mu, double delta);

/// The manufactured source that belongs to a scheme: of the PDE, or of the nonlocal model at horizon `delta`.
std::unique_ptr<Source> make_source(const SchemeChoice& choice, const Scene& scene, double mu, bool nonlocal,
                                    double delta, SourceRule rule = SourceRule::gauss, std::size_t refinement = 1);

}  // namespace acstudy
