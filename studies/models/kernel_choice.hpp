#pragma once

/// @file
/// The kernels that a study can name, a row each, and those that it writes: the one place where a choice becomes a
/// type.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "solver/kernels.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "solver/piecewise_kernel.hpp"
#include "studies/models/kernel_formula.hpp"
#include "studies/models/key.hpp"

namespace acstudy {

/// A kernel of the solver. A family has a type for each part of its range that can do something else.
using AnyKernel = std::variant<InverseKernel, CubicSplineKernel, PowerKernel, IntegrablePowerKernel, PiecewiseKernel,
                               IntegrablePiecewiseKernel>;

/// @throws KernelError  if it is none
AnyKernel make_kernel(const KernelFormula& formula);

/// What tells the members of a family apart.
struct KernelParameter {
  Key key;                      ///< "kernel.alpha", in studies
  std::string_view role;        ///< "exponent"
  double example;               ///< 0.5
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
  std::string_view profile = {}, breaks = {};         ///< its density and breaks, as in a KernelFormula; or
  AnyKernel (*make)(double parameter) = nullptr;      ///< a type of its own, and
  SweepKernel::Form form = SweepKernel::Form::table;  ///< of its moments in sweeps; one of its own if that is worth it
  std::optional<KernelParameter> parameter = {};

  /// As an example: "\"inverse\"", "{ name = \"power\", alpha = 0.5 }".
  std::string example() const {
    std::string text = '"' + std::string(name) + '"';
    if (!parameter) return text;
    return fmt::format("{{ name = {}, {} = {} }}", text, parameter->name(), parameter->example);
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
                         .example = 0.5,
                         .range = "has a first moment only for a finite alpha < 2",
                         .integrable = "alpha < 1",
                         .in_range = [](double alpha) { return alpha < 2.0; },
                         .singular_at_two = true}},
    {.name = "cubic-spline",
     .written = "\"cubic-spline\"",
     .meaning = "Model II; Model I: its upwind half, doubled",
     .make = [](double) -> AnyKernel { return CubicSplineKernel{}; },
     .form = SweepKernel::Form::cubic_spline},
    {.name = "quartic-spline",
     .written = "\"quartic-spline\"",
     .meaning = "B-spline of degree 4, as a density",
     .profile = "(1-s)^4 - 5*max(3/5-s, 0)^4 + 10*max(1/5-s, 0)^4",
     .breaks = "1/5 3/5"},
    {.name = "quintic-spline",
     .written = "\"quintic-spline\"",
     .meaning = "B-spline of degree 5, as a density",
     .profile = "(1-s)^5 - 6*max(2/3-s, 0)^5 + 15*max(1/3-s, 0)^5",
     .breaks = "1/3 2/3"},
    {.name = "wendland-c2",
     .written = "\"wendland-c2\"",
     .meaning = "Wendland's C2 function on a line, as a density",
     .profile = "(1-s)^3*(1+3*s)"},
    {.name = "wendland-c4",
     .written = "\"wendland-c4\"",
     .meaning = "Wendland's C4 function on a line, as a density",
     .profile = "(1-s)^5*(1+5*s+8*s^2)"},
    {.name = "wendland-c6",
     .written = "\"wendland-c6\"",
     .meaning = "Wendland's C6 function on a line, as a density",
     .profile = "(1-s)^7*(1+7*s+19*s^2+21*s^3)"},
    {.name = "gaussian",
     .written = "\"gaussian\"",
     .meaning = "exp(-9 s^2) as a density, cut off at three of its lengths",
     .profile = "exp(-9*s^2)"},
    {.name = "constant", .written = "\"constant\"", .meaning = "eta(s) ~ 1; as a density 1 - s", .profile = "1-s"},
    {.name = "hat", .written = "\"hat\"", .meaning = "eta(s) ~ 1 - s; as a density (1 - s)^2", .profile = "(1-s)^2"},
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
  std::string name;                                        ///< of one that is written: the label of its formula
  double parameter = 0.0;                                  ///< of a family
  std::shared_ptr<const KernelFormula> formula = nullptr;  ///< of one that is written

  /// A kernel that is written.
  static KernelChoice written(const KernelFormula& formula) {
    return {formula.label(), 0.0, std::make_shared<const KernelFormula>(formula)};
  }

  /// @throws std::invalid_argument for a name that is none
  AnyKernel kernel() const;
  /// How sweeps take its moments.  @throws std::invalid_argument for a name that is none
  SweepKernel::Form form() const;
  /// What it was written as, in the study or in its row; null if it has a type of its own.
  std::shared_ptr<const KernelFormula> its_formula() const;
  /// What tells it from others of its family, if it is of one.
  const KernelParameter* family() const {
    const NamedKernel* const row = find_kernel(name);
    return row != nullptr && row->parameter ? &*row->parameter : nullptr;
  }
  /// "inverse", "power(0.5)"; the name alone if it is none.
  std::string label() const;
};

/// Calls `visit` with the kernel itself and returns what it returns.
template <class Visit>
auto with_kernel(const KernelChoice& choice, Visit&& visit) {
  return std::visit(visit, choice.kernel());
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
