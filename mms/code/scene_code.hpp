#pragma once

/// @file
/// A manufactured problem as source code: for solvers that are written in another language.

#include <optional>
#include <string>
#include <vector>

#include "mms/code/language.hpp"
#include "mms/scene.hpp"
#include "mms/source.hpp"

namespace acstudy::code {

/// How a source is computed from the functions of a scene, which its statements call by `call`; what they add up is
/// `sum`.
struct SourceFormula {
  std::vector<Statement> first;
  std::vector<Sum> sums;
  std::vector<std::pair<std::string, double>> constants;
};

/// Writes a function of the scene at some arguments: "c_hat(x - 0.5*z)". The names are
///
///     c, c_x, b, b_x, c_hat, c_hat_x, side   of x; side is 1 where c_hat > 0, and -1 elsewhere
///     u, u_x, u_t                            of x and t
///
/// Numbers in a statement that are neither 0.5 nor whole belong into
/// the constants.
std::string call(const Language& language, const std::string& name, const std::string& arguments);

/// c, b, the flow in closed form, the solution, or its initial values, and the source as functions of one file, and
/// what these call. The same numbers as those of the runs, but for round-off.
/// @param model  null: the source of the PDE, or the given one; else that of the nonlocal model, as its Gauss rule
/// @throws std::domain_error as `nonlocal_source`
/// @pre  scene.dimension() == 1; scene.solved() if there is a model
std::string scene_code(const Scene& scene, const NonlocalModel* model, const Language& language,
                       const std::vector<std::string>& about);

}  // namespace acstudy::code
