#pragma once

/// @file
/// The tables that studies of several kinds share: scene, schemes, paths, time stepping and the cases made of them.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studies/cases/study.hpp"
#include "studies/cases/subject.hpp"
#include "studies/reading/path_part.hpp"
#include "studies/reading/time_part.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// Whether a study can do without an exact solution.
enum class Solution { needed, may_be_unknown };

/// [scene]: a named scene, or the fields themselves.
std::shared_ptr<const Scene> read_scene(const Table& table, Solution solution = Solution::needed);
/// The same for studies of an operator, which is nothing where c - b is zero everywhere.
std::shared_ptr<const Scene> read_scene_with_advection(const Table& table);

/// Model and kernel of a [[scheme]], or of another table that has the two.
const ModelCard& read_model(const Table& table);
KernelChoice read_kernel(const Table& table, const ModelCard& model);

/// Whether a study can do with an outside program in place of a model.
enum class Programs { refused, taken };

/// A [[scheme]]; `standing` decides whether it needs a divergence form.
SchemeChoice read_scheme(const Table& table, const Scene& scene, Programs programs = Programs::refused);
/// All of [[scheme]], each once, with the viscosity bound of each (0 unless its model is viscous).
struct SchemeEntry {
  SchemeChoice scheme;
  double mu;
};
std::vector<SchemeEntry> read_schemes(const Table& root, const Scene& scene, Programs programs = Programs::refused);

/// All of [[scheme]] on each arrangement of particles: uniform, jittered and, if particles move, moved.
std::vector<Subject> read_subjects(const Table& root, const std::shared_ptr<const Scene>& scene);

/// A list of positive numbers.
std::vector<double> read_positive(const Table& table, std::string_view key, std::string_view example);

/// A [[control]]: its name, and scheme = { model = 1, ... } of which it is a mistake.
SchemeEntry read_control(const Table& table, const Scene& scene);

/// [sweep]: N, ratios and, optionally, horizons, each below half the period.
/// @param fewest  particles that a study of this kind takes
Resolutions read_resolutions(const Table& table, const Scene& scene, std::int64_t fewest);

/// Fails unless 0 < delta < period / 2.  @param at  the place to blame
void check_horizon(const Scene& scene, std::int64_t N, double delta, const Place& at);

/// [scene], [time] and [source] of a study that runs cases; what is read is set in `study`.
Stepping read_problem(const Table& root, Study& study);
/// The same where [[time]] may stand several times.
std::vector<Stepping> read_problem_with_steppings(const Table& root, Study& study,
                                                  Solution solution = Solution::needed);

/// The case of one scheme at N particles and the horizon `delta`.  @param at  the place to blame for a bad horizon
Case make_case(const Study& study, const Stepping& time, const SchemeEntry& entry, std::int64_t N, double delta,
               bool nonlocal_source, const Place& at, const Start& start = {});

/// The series of one scheme along a path, with what theory says of it; a study may expect or promise something else.
Series make_series(const Study& study, const Stepping& time, const SchemeEntry& entry, const PathChoice& path,
                   const Place& at_delta);

}  // namespace acstudy
