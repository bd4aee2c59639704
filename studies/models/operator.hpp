#pragma once

/// @file
/// A scheme at one instant, without time stepping: its rates, its truncation error, its matrix.

#include <memory>
#include <vector>

#include "studies/models/arrangement.hpp"
#include "studies/models/scheme.hpp"

namespace acstudy {

/// A scheme placed on particles that do not move.
class PlacedScheme {
 public:
  /// @param x  increasing positions within one period  @pre the scene outlives this
  PlacedScheme(const SchemeChoice& choice, const Scene& scene, double mu, const std::vector<double>& x, double delta);
  /// Any scheme, also one that no study can name.
  PlacedScheme(std::unique_ptr<LineScheme> scheme, const Scene& scene, const std::vector<double>& x, double delta);

  std::size_t size() const { return particles_.size(); }
  const Particles& particles() const { return particles_; }
  const LineScheme& scheme() const { return *scheme_; }

  /// rate_j(u), u of shape [N].
  std::vector<double> rate(const std::vector<double>& u);

  /// rate_j(u) + f_j - (u_t + b u_x)_j for the exact u of the scene at time t: what the scheme leaves of the equation
  /// whose manufactured source is f.
  std::vector<double> truncation_error(Source& source, double t);

  /// Row j of the matrix R of the rates, rate(u) = R u: entries at j - reach .. j + reach (modulo N), row after row,
  /// shape [N * (2 reach + 1)]. Exact, by probing with unit vectors that do not overlap; with few particles, whose
  /// windows wrap around, [N * N] from offset 0.
  struct Rows {
    std::ptrdiff_t first;  ///< offset of the first entry of a row
    std::size_t width;
    std::vector<double> entry;
    double operator()(std::size_t j, std::size_t k) const { return entry[j * width + k]; }
  };
  Rows rows();

 private:
  const Scene& scene_;
  Particles particles_;
  std::unique_ptr<LineScheme> scheme_;
};

/// Max norm of a forward Euler step I + dt R: the largest row sum of absolute values, exact to round-off.
double step_norm(PlacedScheme& placed, double dt);

/// Largest absolute value; NaN if one is.
double max_norm(const std::vector<double>& values);

}  // namespace acstudy
