#pragma once

/// @file
/// Any kernel as one type.

#include <span>
#include <stdexcept>
#include <utility>
#include <variant>

#include "studies/models/kernel_choice.hpp"

namespace acstudy {

/// Any kernel, found out at each call: one type, where run times matter less than how long it takes to build.
class SomeKernel {
 public:
  explicit SomeKernel(AnyKernel kernel) : kernel_(std::move(kernel)) {}
  double eta(double z) const {
    return std::visit([z](const auto& k) { return k.eta(z); }, kernel_);
  }
  double first_moment(const auto& where) const {
    return std::visit([&](const auto& k) { return k.first_moment(where); }, kernel_);
  }
  /// @throws std::logic_error if it is not integrable
  double mass(const auto& where) const {
    return std::visit(
        [&]<class K>(const K& k) -> double {
          if constexpr (IntegrableKernel<K>) return k.mass(where);
          throw std::logic_error("the mass of a kernel that is not integrable");
        },
        kernel_);
  }
  double origin_exponent() const {
    return std::visit([](const auto& k) { return k.origin_exponent(); }, kernel_);
  }
  double regular_part(double z) const {
    return std::visit([z](const auto& k) { return k.regular_part(z); }, kernel_);
  }
  std::span<const double> breaks() const {
    return std::visit([](const auto& k) { return k.breaks(); }, kernel_);
  }

 private:
  AnyKernel kernel_;
};

/// @throws std::invalid_argument if it is not integrable
inline SomeKernel integrable_one(const KernelChoice& choice) {
  if (!integrable(choice)) throw std::invalid_argument("kernel " + choice.label() + " is not integrable");
  return SomeKernel(choice.kernel());
}

}  // namespace acstudy
