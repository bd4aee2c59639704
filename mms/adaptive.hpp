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

}  // namespace acstudy
