#pragma once

/// @file
/// How cases are run: in which form, and which of them together.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/cases/case.hpp"

namespace acstudy {

struct VelocitySeries;

/// A case with all that is found out about its run before it begins.
struct Plan;

/// A way to run cases: the sums of particles one by one (readable) or several at a time (vector), those over far
/// neighbors by boxes where that pays (far sums), steps that are solved for (implicit), a program of its own (command).
struct Form {
  std::string_view name;
  bool (*takes)(const Plan&);  ///< false leaves the case to the next form of the table
  bool together;               ///< cases on the same particles are run together, by run_ensemble()
  bool far = false;            ///< with sums over far neighbors by boxes
};

/// All forms, after that of programs the fastest first. The last one, the reference, takes every case.
std::span<const Form> forms();

struct Plan {
  const Case* c = nullptr;
  const Form* form = nullptr;
  std::shared_ptr<const VelocitySeries> velocity = nullptr;  ///< of the scene, for a form that runs cases together
  /// Cases with equal `particles` can be run together: the same particles at the same times. Of these, cases with equal
  /// `pairs` have one model, kernel and horizon; two of them that differ by their divergence share their sums over
  /// pairs. A case that is run alone has these for itself.
  std::string particles, pairs;
};

/// A plan for each of the cases, which outlive it. Velocities of a scene are looked at once. Two cases that share their
/// sums have one form: that which is the faster for both.
std::vector<Plan> plan(std::span<const Case* const> cases);
Plan plan(const Case& c);

}  // namespace acstudy
