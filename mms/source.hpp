#pragma once

/// @file
/// Manufactured sources: the f that makes the exact u of a scene solve the PDE or a nonlocal model.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "mms/quadrature.hpp"
#include "mms/scene.hpp"

namespace acstudy {

class Source;
struct NonlocalModel;
namespace code {
class Language;
struct SourceFormula;
}  // namespace code

/// Where Model I looks: by the sign of c_hat, or to one side everywhere, which makes its source a smooth field.
enum class Look { upwind, left, right };

/// A kind of continuum nonlocal model, by its terms beyond du/dt and a local b' u: flux, nonlocal divergence,
/// viscosity.
struct ContinuumModel {
  /// The source by a Gauss rule of so many points.
  std::unique_ptr<Source> (*source)(const Scene&, const NonlocalModel&, std::size_t points, Look);
  /// The smooth G(r), 0 <= r <= delta, with which the terms at (x, t) are int_0^delta G(r) r eta^delta(r) dr; for the
  /// adaptive rules. It refers to the scene.
  std::function<double(double r)> (*integrand)(const Scene&, const NonlocalModel&, double x, double t);
  bool sided;  ///< the source depends on where `Look` says
  /// The source by a Gauss rule of so many points, as statements in another language.
  code::SourceFormula (*formula)(const Scene&, const NonlocalModel&, std::size_t points, const code::Language&);
};
extern const ContinuumModel upwind_continuum;   ///< (2.8), (2.10): upwind kernel
extern const ContinuumModel viscous_continuum;  ///< (3.7), (3.9): vanishing nonlocal viscosity

/// A continuum nonlocal model: of which kind, how its divergence is written, at which horizon.
struct NonlocalModel {
  const ContinuumModel* continuum;
  bool nonlocal_divergence;  ///< (2.10), (3.9) instead of (2.8), (3.7); of no matter where particles stand still
  KernelProfile kernel;
  double delta;
  double mu;  ///< of the viscous term, if there is one
};

/// How nonlocal sources are integrated: a fixed Gauss rule, or adaptively by a library (slow; the reference).
enum class SourceRule { gauss, gsl, boost };

/// The manufactured source in the moving frame, f = du/dt + b' u + (c_hat u)_x or its nonlocal counterpart.
class Source {
 public:
  virtual ~Source() = default;
  /// Takes note of where the particles are and of the velocities there; once where they stand still.
  virtual void place(const Points& x) = 0;
  /// f_j = f(x_j, t).  @pre place() was called
  virtual void evaluate(double t, std::span<double> f) = 0;
  /// Integrand evaluations so far.
  virtual std::int64_t quadrature_points() const { return 0; }
};

/// u solves the PDE (1.1): f = u_t + (c u)_x, the same in every frame; or the given f, where the scene's solution is
/// not known. No quadrature.
std::unique_ptr<Source> local_source(const Scene& scene);

/// u solves the nonlocal model at this horizon. The scene must outlive the source.
///
/// Each nonlocal derivative is the average of a local one over the horizon, by the Gauss rule of the kernel's own
/// weight (see `derivative_rule`), with the fewest points that agree with a much finer rule to round-off on this scene.
/// @param refinement  how many times these points the Gauss rule gets, to see what its error is
/// @throws std::domain_error if no rule of up to 40 points does: the fields are too rough at this horizon
std::unique_ptr<Source> nonlocal_source(const Scene& scene, const NonlocalModel& model,
                                        SourceRule rule = SourceRule::gauss, std::size_t refinement = 1);

/// The fewest Gauss points that integrate the source to round-off.  @throws std::domain_error as above
std::size_t sufficient_points(const Scene& scene, const NonlocalModel& model);

/// The source with a given number of Gauss points.
std::unique_ptr<Source> nonlocal_source(const Scene& scene, const NonlocalModel& model, std::size_t points,
                                        Look look = Look::upwind);

}  // namespace acstudy
