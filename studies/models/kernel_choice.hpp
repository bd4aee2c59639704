#pragma once

/// @file
/// The kernels that a study can name: the one place where a name becomes a type.

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "solver/kernels.hpp"

namespace acstudy {

struct KernelChoice {
  std::string name;
  double alpha = 0.0;  ///< of the power family
  /// "inverse", "power(0.5)".
  std::string label() const;
};

struct NamedKernel {
  std::string_view name;
  std::string_view written;  ///< as a study writes it
  std::string_view meaning;
};

inline constexpr NamedKernel named_kernels[] = {
    {"inverse", "\"inverse\"", "Model I: eta(s) = 1/(delta s)"},
    {"power", "{ name = \"power\", alpha = A }", "eta(s) ~ s^-A; Model I: A < 2, Model II: A < 1"},
    {"cubic-spline", "\"cubic-spline\"", "Model II; Model I: its upwind half, doubled"},
};

/// Calls `visit` with the kernel itself and returns what it returns.
/// @throws std::logic_error for a name that is none
template <class Visit>
auto with_kernel(const KernelChoice& choice, Visit&& visit) {
  if (choice.name == "inverse") return visit(InverseKernel{});
  if (choice.name == "cubic-spline") return visit(CubicSplineKernel{});
  if (choice.name == "power" && choice.alpha < 1.0) return visit(IntegrablePowerKernel(choice.alpha));
  if (choice.name == "power") return visit(PowerKernel(choice.alpha));
  throw std::logic_error("no kernel is named " + choice.name);
}

/// The same where the kernel itself has to be integrable.
/// @throws std::invalid_argument if it is not
template <class Visit>
auto with_integrable_kernel(const KernelChoice& choice, Visit&& visit) {
  return with_kernel(choice, [&]<class K>(const K& kernel) -> decltype(visit(CubicSplineKernel{})) {
    if constexpr (IntegrableKernel<K>) return visit(kernel);
    throw std::invalid_argument("kernel " + choice.label() + " is not integrable");
  });
}

/// True if Model II can use the kernel.
inline bool integrable(const KernelChoice& choice) {
  return with_kernel(choice, []<class K>(const K&) { return IntegrableKernel<K>; });
}

/// int_0^z r eta(r) dr on the unit horizon.
inline double first_moment(const KernelChoice& choice, double z) {
  return with_kernel(choice, [z](const auto& kernel) { return kernel.first_moment(z); });
}

/// int_0^z eta(r) dr on the unit horizon; infinite if the kernel is not integrable.
inline double mass(const KernelChoice& choice, double z) {
  return with_kernel(choice, [z]<class K>(const K& kernel) {
    if constexpr (IntegrableKernel<K>) return kernel.mass(z);
    return std::numeric_limits<double>::infinity();
  });
}

/// mass(choice, 1), which is delta times the L1 norm of Model II's kernel.
inline double total_mass(const KernelChoice& choice) { return mass(choice, 1.0); }

}  // namespace acstudy
