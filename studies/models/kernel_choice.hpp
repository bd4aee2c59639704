#pragma once

/// @file
/// The kernels that a study can name, a row each: the one place where a name becomes a type.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "solver/kernels.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "studies/models/key.hpp"

namespace acstudy {

/// A kernel of the solver. A family has a type for each part of its range that can do something else.
using AnyKernel = std::variant<InverseKernel, CubicSplineKernel, PowerKernel, IntegrablePowerKernel>;

/// What tells the members of a family apart.
struct KernelParameter {
  Key key;                      ///< "kernel.alpha", in studies
  std::string_view role;        ///< "exponent"
  std::string_view example;     ///< "0.5"
  std::string_view range;       ///< where there is a kernel: "has a first moment only for a finite alpha < 2"
  std::string_view integrable;  ///< where it is integrable as well: "alpha < 1"
  bool (*in_range)(double);
  /// As it goes to 2, all of the first moment goes to the nearest neighbor like its distance to the power 2 - alpha.
  bool singular_at_two = false;

  constexpr std::string_view name() const { return key.name.substr(key.name.find('.') + 1); }  ///< "alpha"
};

struct NamedKernel {
  std::string_view name;
  std::string_view written;  ///< as a study writes it
  std::string_view meaning;
  AnyKernel (*make)(double parameter);
  SweepKernel::Form form = SweepKernel::Form::scalar;  ///< of its moments in sweeps: its own, if worth it
  std::optional<KernelParameter> parameter = {};

  /// As an example: "\"inverse\"", "{ name = \"power\", alpha = 0.5 }".
  std::string example() const {
    std::string text = '"' + std::string(name) + '"';
    if (!parameter) return text;
    return "{ name = " + text + ", " + std::string(parameter->name()) + " = " + std::string(parameter->example) + " }";
  }
};

inline constexpr NamedKernel named_kernels[] = {
    {.name = "inverse",
     .written = "\"inverse\"",
     .meaning = "Model I: eta(s) = 1/(delta s)",
     .make = [](double) -> AnyKernel { return InverseKernel{}; },
     .form = SweepKernel::Form::inverse},
    {.name = "power",
     .written = "{ name = \"power\", alpha = A }",
     .meaning = "eta(s) ~ s^-A; Model I: A < 2, Model II: A < 1",
     .make = [](double alpha) -> AnyKernel {
       if (alpha < 1.0) return IntegrablePowerKernel(alpha);
       return PowerKernel(alpha);
     },
     .parameter =
         KernelParameter{.key = {"kernel.alpha", "number", "exponent of the power kernel: below 2, in Model II below 1",
                                 "needed by \"power\""},
                         .role = "exponent",
                         .example = "0.5",
                         .range = "has a first moment only for a finite alpha < 2",
                         .integrable = "alpha < 1",
                         .in_range = [](double alpha) { return alpha < 2.0; },
                         .singular_at_two = true}},
    {.name = "cubic-spline",
     .written = "\"cubic-spline\"",
     .meaning = "Model II; Model I: its upwind half, doubled",
     .make = [](double) -> AnyKernel { return CubicSplineKernel{}; },
     .form = SweepKernel::Form::cubic_spline},
};

/// The keys of the families' parameters, each once.
inline constexpr auto kernel_keys = [] {
  constexpr auto is_first_with_key = [](const NamedKernel& row) {
    const auto same = [&](const NamedKernel& known) {
      return known.parameter && known.parameter->key.name == row.parameter->key.name;
    };
    return row.parameter && std::find_if(std::begin(named_kernels), std::end(named_kernels), same) == &row;
  };
  std::array<Key, std::count_if(std::begin(named_kernels), std::end(named_kernels), is_first_with_key)> keys{};
  std::size_t next = 0;
  for (const NamedKernel& row : named_kernels) {
    if (is_first_with_key(row)) keys[next++] = row.parameter->key;
  }
  return keys;
}();

/// Null if there is none.
inline const NamedKernel* find_kernel(std::string_view name) {
  for (const NamedKernel& known : named_kernels) {
    if (known.name == name) return &known;
  }
  return nullptr;
}

struct KernelChoice {
  std::string name;
  double parameter = 0.0;  ///< of a family

  /// @throws std::invalid_argument for a name that is none
  const NamedKernel& row() const {
    if (const NamedKernel* const found = find_kernel(name)) return *found;
    throw std::invalid_argument("no kernel is named " + name);
  }
  /// "inverse", "power(0.5)"; the name alone if it is none.
  std::string label() const;
};

/// Calls `visit` with the kernel itself and returns what it returns.
template <class Visit>
auto with_kernel(const KernelChoice& choice, Visit&& visit) {
  return std::visit(visit, choice.row().make(choice.parameter));
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

/// True if the kernel itself is integrable, and not its first moment alone.
inline bool integrable(const KernelChoice& choice) {
  return with_kernel(choice, []<class K>(const K&) { return IntegrableKernel<K>; });
}

/// Some integrable kernel, where it is of no matter which.
inline KernelChoice integrable_kernel() {
  for (const NamedKernel& known : named_kernels) {
    const KernelChoice choice{std::string(known.name)};
    if (!known.parameter && integrable(choice)) return choice;
  }
  throw std::logic_error("no kernel without a parameter is integrable");
}

/// True if eta is smooth up to 0 and 0 there: near neighbors count little.
inline bool vanishes_at_origin(const KernelChoice& choice) {
  return with_kernel(choice, [](const auto& k) { return k.origin_exponent() == 0.0 && k.regular_part(0.0) == 0.0; });
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
