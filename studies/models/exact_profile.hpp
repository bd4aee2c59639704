#pragma once

/// @file
/// Kernels written as text, in arithmetic of 100 digits.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <string>
#include <vector>

#include "mms/expression.hpp"
#include "studies/models/kernel_formula.hpp"

namespace acstudy {

/// Near an end at which it vanishes the formula of a kernel cancels: so many digits that sixteen are left.
using HundredDigits =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// The formula of a kernel, not normalized. Number literals are the doubles next to them; pi and e are exact.
class ExactProfile {
 public:
  /// @throws KernelError  unless the texts are expressions and the breaks increase between 0 and 1
  explicit ExactProfile(KernelFormula formula);

  /// eta(s), and s^exponent eta(s).
  HundredDigits eta(const HundredDigits& s) const;
  HundredDigits regular_part(const HundredDigits& s) const;
  /// int s^power eta(s) ds over a cell, power 0 or 1, by Gauss rules.
  HundredDigits integral(int power, const HundredDigits& from, const HundredDigits& to) const;

  const KernelFormula& formula() const { return formula_; }
  /// 0, the breaks, 1.
  const std::vector<double>& ends() const { return ends_; }

 private:
  KernelFormula formula_;
  Expression expression_;
  std::vector<double> ends_;
};

}  // namespace acstudy
