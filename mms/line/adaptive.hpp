#pragma once

/// @file
/// Adaptive quadrature of the nonlocal terms, straight from their definitions: the reference for the fixed rule.

#include <cstdint>

#include "mms/source.hpp"

namespace acstudy {

/// The terms of the nonlocal model at (x, t) beyond du/dt and a local b' u: flux, nonlocal divergence, viscosity.
///
/// @param rule   gsl (QAWS, QAG) or boost (tanh-sinh)
/// @param points incremented by the number of integrand evaluations
/// @throws std::runtime_error if the quadrature, asked for 1e-14, estimates its relative error at more than 1e-11
double nonlocal_terms_adaptively(const Scene& scene, const NonlocalModel& model, SourceRule rule, double x, double t,
                                 std::int64_t& points);

/// int_0^z r^power eta(r) dr on the unit horizon.
///
/// @param rule gsl (QAWS) or boost (tanh-sinh)
/// @throws std::runtime_error as above
/// @pre  power - (the kernel's origin exponent) > -1, 0 < z <= 1
double kernel_moment_adaptively(const KernelProfile& kernel, int power, double z, SourceRule rule);

}  // namespace acstudy
