#pragma once

/// @file
/// The error as a function of spacing and horizon at once, and the verdict on its two orders.

#include <optional>
#include <span>

#include "reports/judging/orders.hpp"

namespace acstudy {

struct SurfacePoint {
  double h, delta, error;
};

/// An order with its 95 % interval (Student t; linearized at the fit).
struct FittedOrder {
  double value, low, high;
};

/// Two powers that were fitted to a surface, each with its constant.
struct TwoPowers {
  double A, B;
  FittedOrder p, q;
  double rms;  ///< of the residual of log(error)
  double bic;  ///< Bayesian information criterion
};

/// Least squares of log(error) by
///
///     error = (a^m + b^m)^(1/m),   a = A h^p exp(D h/h_max),   b = B delta^q exp(F delta/delta_max).
///
/// D and F are the first corrections to the leading powers. The sharpness m says how the two terms join: m = 1 adds
/// them, m -> infinity takes the larger one. The plain sum cannot follow errors that take the larger one, as those of a
/// scheme whose horizon has no effect below the spacing; it is there to compare with.
struct SurfaceFit : TwoPowers {
  std::optional<TwoPowers> sum;           ///< error = A h^p + B delta^q, if it can be fitted
  double h_correction, delta_correction;  ///< D, F
  double sharpness;                       ///< m
  double bic_h, bic_delta;                ///< of a alone and of b alone
};

/// @return nothing where the law cannot be fitted: fewer than four spacings or horizons, an error that is not positive
///         and finite, no convergence
std::optional<SurfaceFit> fit_surface(std::span<const SurfacePoint> points);

/// The law describes a surface if log(error) scatters about it by no more than this.
inline constexpr double surface_scatter = 0.05;

/// Judges whether error = O(max(h, delta)^theory_order) on a surface: confirmed if the law describes the surface, needs
/// both of its terms (by at least 10 in the criterion, either way of leaving one out), and p and q both lie within
/// `extrapolation_tolerance` of theory's order, with intervals no wider than half an order. `order` is that of p and q
/// that lies farther from theory's.
Judgement judge_surface(std::span<const SurfacePoint> points, double theory_order);

}  // namespace acstudy
