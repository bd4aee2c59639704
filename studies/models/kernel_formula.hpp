#pragma once

/// @file
/// Kernels written as text: a density, as users of SPH write kernels, or the profile eta itself.

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "solver/piecewise_kernel.hpp"

namespace acstudy {

/// A kernel as a study writes it. It need not be normalized.
struct KernelFormula {
  std::string text;                 ///< an expression in s, the distance in units of the horizon, 0 < s < 1
  bool density = false;             ///< the text is a density rho, and eta(s) = -rho'(s); else it is s^exponent eta(s)
  std::vector<std::string> breaks;  ///< expressions: interior points where it is not smooth, in increasing order
  double exponent = 0.0;            ///< of eta alone, < 2

  /// What the text is: "profile" of a density, else "eta".
  const char* key() const { return density ? "profile" : "eta"; }
  /// "rho = (1-s)^3*(1+3*s)", "eta = s^-0.5 (exp(-s)), breaks 1/3, 2/3"; blanks in texts are left out, so that a kernel
  /// has one label however it is spaced.
  std::string label() const;
};

/// A text that is no kernel; `position` is the offset of the offending character in the value of `key`.
class KernelError : public std::runtime_error {
 public:
  KernelError(std::string its_key, const std::string& message, std::size_t at = 0, std::size_t which = 0)
      : std::runtime_error(message), key(std::move(its_key)), position(at), entry(which) {}
  std::string key;  ///< "profile", "eta", "breaks" or "exponent"
  std::size_t position;
  std::size_t entry;  ///< of `breaks`
};

/// The pieces of a kernel, normalized; made once, and shared by all who ask for the same.
///
/// Smooth parts are cut in halves until a polynomial has eta to round-off, relative to eta itself, and is evaluated
/// without cancellation; integrals over cells then have the digits that closed forms have.
/// @throws KernelError  if text and breaks are no expressions; if the kernel is negative somewhere, has no first
/// moment, or is not smooth between its breaks
std::shared_ptr<const KernelPieces> kernel_pieces(const KernelFormula& formula);

}  // namespace acstudy
