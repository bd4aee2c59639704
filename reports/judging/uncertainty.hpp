#pragma once

/// @file
/// Uncertainty of the finest level of a refinement whose exact solution is not known.

#include <optional>
#include <span>
#include <string>

#include "reports/judging/value_fits.hpp"

namespace acstudy {

/// Grid convergence index of Roache (J. Fluids Eng. 116, 1994): safety_factor |difference|/(r^order - 1) of the two
/// finest levels. NaN where there is none.
struct Gci {
  double uncertainty = not_estimated;  ///< in units of the value
  double safety_factor = not_estimated, order = not_estimated;
  std::string why;  ///< why this safety factor
};

/// The safety factor is 1.25 where three levels or more show an order that can be relied upon: it agrees with theory
/// or, without a theory, hardly changes between the last pairs of levels. Otherwise it is 3, and the order is not taken
/// from the levels beyond 1/2 and theory's (2 without one).
///
/// @param last      the difference of the two finest levels
/// @param observed  the order that the levels show; NaN if they show none
/// @param pairwise  of each three successive levels; NaN where there is none
/// @param theory    NaN if there is none
/// @param monotone  false where values swing about their limit
Gci grid_convergence_index(const Difference& last, double observed, std::span<const double> pairwise, double theory,
                           bool monotone);

/// Least-squares estimate of Eca and Hoekstra (J. Comput. Phys. 262, 2014, 104-130), from four levels on.
struct LeastSquaresUncertainty {
  double uncertainty = not_estimated;  ///< of the finest level, in units of the value
  double error = not_estimated;        ///< its estimated discretization error, not negative
  double order = not_estimated;        ///< of the power law, also where another expansion was chosen
  double value = not_estimated;        ///< phi_0 of the chosen expansion
  double deviation = not_estimated;    ///< standard deviation of the chosen fit
  double range = not_estimated;        ///< the data range parameter: (largest - smallest)/(levels - 1)
  double safety_factor = not_estimated;
  bool weighted = false;  ///< by 1/h
  std::string expansion;  ///< "h^p", "h", "h^2" or "h and h^2"
};

LeastSquaresUncertainty least_squares_uncertainty(std::span<const Value> values);

}  // namespace acstudy
