#pragma once

/// @file
/// Kernels that are a polynomial on each of a few pieces, but for a power of the distance at the origin.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "solver/kernels.hpp"

namespace acstudy {

/// The pieces of such a kernel. On piece i the integral of f from 0 to z is a polynomial in t = direction (z - origin).
///
/// On the first piece t = z and on the last one t = 1 - z, so that what vanishes at the particle or at the horizon
/// keeps its digits there. Coefficients are [piece][terms], lowest first. On the first piece alone, polynomials are
/// multiplied with a power of z: z^-exponent is that of eta, z^moment_power and z^mass_power are those of the
/// integrals.
struct KernelPieces {
  double exponent = 0.0;                        ///< < 2
  double moment_power = 0.0, mass_power = 0.0;  ///< 0 where the integrals are polynomials
  std::vector<double> corners;                  ///< those of the bounds where the kernel is not smooth
  std::vector<double> bounds;                   ///< 0 = bounds[0] < bounds[1] < ... = 1; two pieces at least
  std::vector<double> origin, direction;        ///< of each piece
  std::size_t terms = 0;                        ///< coefficients of each polynomial
  std::vector<double> eta, moment, mass;        ///< of eta, int r eta(r) dr and int eta(r) dr; the last may be empty

  std::size_t count() const { return origin.size(); }
};

/// A kernel by its pieces, for Model I.
class PiecewiseKernel {
 public:
  /// @throws std::invalid_argument unless there are two pieces at least and the exponent is below 2
  explicit PiecewiseKernel(std::shared_ptr<const KernelPieces> pieces) : pieces_(std::move(pieces)) {
    if (pieces_->count() < 2 || !(pieces_->exponent < 2.0)) {
      throw std::invalid_argument("a piecewise kernel needs two pieces and an exponent < 2");
    }
  }

  double eta(double z) const {
    const std::size_t i = piece_of(z);
    const double value = polynomial(pieces_->eta, i, z);
    return i == 0 && pieces_->exponent != 0.0 ? value * std::pow(z, -pieces_->exponent) : value;
  }
  double first_moment(double z) const { return within(pieces_->moment, pieces_->moment_power, z); }
  double first_moment(const Cell& cell) const { return over(pieces_->moment, pieces_->moment_power, cell); }
  double origin_exponent() const { return pieces_->exponent; }
  double regular_part(double z) const {
    const std::size_t i = piece_of(z);
    const double value = polynomial(pieces_->eta, i, z);
    return i == 0 || pieces_->exponent == 0.0 ? value : value * std::pow(z, pieces_->exponent);
  }
  std::span<const double> breaks() const { return std::span(pieces_->bounds).subspan(1, pieces_->count() - 1); }
  /// Those of them where the kernel is not smooth; at the others one polynomial does not do.
  std::span<const double> corners() const { return pieces_->corners; }
  const KernelPieces& pieces() const { return *pieces_; }

 protected:
  /// The integral from 0 to z.
  double within(const std::vector<double>& coefficients, double power, double z) const {
    const std::size_t i = piece_of(z);
    const double value = polynomial(coefficients, i, z);
    return i == 0 && power != 0.0 ? value * std::pow(z, power) : value;
  }

  /// The integral over a cell, piece by piece.
  double over(const std::vector<double>& coefficients, double power, const Cell& cell) const {
    double sum = 0.0, inner = cell.inner, rest_inner = cell.rest_inner, width = cell.width;
    std::size_t i = piece_of(cell.inner);
    // Round-off in where a cell is cut is harmless: the widths add up to that of the cell.
    for (; i + 1 < pieces_->count() && cell.outer > pieces_->bounds[i + 1]; ++i) {
      const double bound = pieces_->bounds[i + 1], part = std::clamp(bound - inner, 0.0, width);
      sum += inside(coefficients, power, i, {inner, bound, part, rest_inner, 1.0 - bound});
      inner = bound;
      rest_inner = 1.0 - bound;
      width -= part;
    }
    return sum + inside(coefficients, power, i, {inner, cell.outer, width, rest_inner, cell.rest_outer});
  }

 private:
  std::size_t piece_of(double z) const {
    const auto& bounds = pieces_->bounds;
    return static_cast<std::size_t>(std::upper_bound(bounds.begin() + 1, bounds.end() - 1, z) - bounds.begin() - 1);
  }
  double polynomial(const std::vector<double>& coefficients, std::size_t piece, double z) const {
    const double* const c = coefficients.data() + piece * pieces_->terms;
    const double t = pieces_->direction[piece] * (z - pieces_->origin[piece]);
    double value = 0.0;
    for (std::size_t k = pieces_->terms; k-- > 0;) value = value * t + c[k];
    return value;
  }
  /// sum_k c_k (t_outer^k - t_inner^k), in which every difference of powers has the width as a factor.
  double inside(const std::vector<double>& coefficients, double power, std::size_t piece, const Cell& cell) const {
    const double* const c = coefficients.data() + piece * pieces_->terms;
    const double origin = pieces_->origin[piece];
    const bool last = pieces_->direction[piece] < 0.0;
    const double lower = last ? cell.rest_outer : cell.inner - origin,
                 upper = last ? cell.rest_inner : cell.outer - origin;
    const bool powered = piece == 0 && power != 0.0;
    double difference = powered ? power_difference(cell, power) : 0.0,
           of_lower = powered ? std::pow(lower, power) : 1.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < pieces_->terms; ++k) {
      sum += c[k] * difference;
      difference = upper * difference + of_lower * cell.width;
      of_lower *= lower;
    }
    return pieces_->direction[piece] * sum;
  }

  std::shared_ptr<const KernelPieces> pieces_;
};

/// The same where it is integrable, for Model II.
class IntegrablePiecewiseKernel : public PiecewiseKernel {
 public:
  /// @throws std::invalid_argument if the pieces have no mass
  explicit IntegrablePiecewiseKernel(std::shared_ptr<const KernelPieces> its_pieces)
      : PiecewiseKernel(std::move(its_pieces)) {
    if (pieces().mass.empty()) throw std::invalid_argument("an integrable kernel needs its mass");
  }
  double mass(double z) const { return within(pieces().mass, pieces().mass_power, z); }
  double mass(const Cell& cell) const { return over(pieces().mass, pieces().mass_power, cell); }
};

}  // namespace acstudy
