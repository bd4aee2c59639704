#pragma once

/// @file
/// The exponential function of several numbers at a time.

#include "solver/line/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// ln(2)^k / k!
struct ExponentialSeries {
  static constexpr int degree = 12;
  double coefficient[degree + 1];

  constexpr ExponentialSeries() : coefficient{} {
    long double term = 1.0L;
    for (int k = 0; k <= degree; ++k) {
      coefficient[k] = static_cast<double>(term);
      term *= 0.693147180559945309417232121458176568L / (k + 1);
    }
  }
};

/// exp(t), to 2e-16 (1 + |t|) relative; 1e-271 in place of what is smaller.
/// @pre t <= 600
ACSTUDY_ALWAYS_INLINE inline Lanes exponential(Lanes t) {
  constexpr ExponentialSeries series;
  constexpr double per_ln2 = 1.44269504088896340736, to_integer = 6755399441055744.0;  // 3 2^51, whose ulp is 1
  const Lanes y = max(t * per_ln2, spread(-900.0));
  const Lanes shifted = y + to_integer;
  const Lanes rest = y - (shifted - to_integer);
  Lanes power = spread(series.coefficient[ExponentialSeries::degree]);
#pragma GCC unroll 16
  for (int k = ExponentialSeries::degree - 1; k >= 0; --k) power = power * rest + series.coefficient[k];
  // The integer stands in the last bits of `shifted`, and 52 further up it is added to the exponent.
  return (Lanes)((Mask)power + ((Mask)shifted << 52));
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
