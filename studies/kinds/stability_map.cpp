#include "studies/claims/stability_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "studies/kinds/kinds.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

std::vector<const Integrator*> read_integrators(const Table& table) {
  std::vector<std::pair<std::string, const Integrator*>> words;
  for (const Integrator& integrator : integrators) words.emplace_back(integrator.name, &integrator);
  std::vector<const Integrator*> chosen;
  for (const toml::node& item : table.list("integrators", "integrators = [\"forward-euler\", \"backward-euler\"]")) {
    const Integrator* const integrator = table.choice<const Integrator*>("integrators", item, words);
    if (std::find(chosen.begin(), chosen.end(), integrator) != chosen.end()) {
      table.place(item).fail(fmt::format("\"{}\" a second time; leave it out", integrator->name));
    }
    chosen.push_back(integrator);
  }
  return chosen;
}

/// [stability-map] N, ratios and cfl.
StabilityGrid read_grid(const Table& table, const Scene& scene) {
  StabilityGrid grid{.N = table.whole("N", table.need("N", "N = 64"), 8, 1000),
                     .ratios = read_positive(table, "ratios", "ratios = [0.5, 1, 4, 16]"),
                     .cfl = read_positive(table, "cfl", "cfl = [0.5, 1, 2, 4]")};
  for (const double ratio : grid.ratios) {
    check_horizon(scene, grid.N, ratio * scene.period() / static_cast<double>(grid.N),
                  table.place(*table.find("ratios")));
  }
  return grid;
}

constexpr std::array unstable_controls = {"SPH sum", "no viscosity", "downwind"};

/// [growth] ratio and cfl: the curves of growth in time.
struct Curves {
  double ratio;
  std::vector<double> cfl;
};
Curves read_curves(const Table& table, const Scene& scene, std::int64_t N) {
  const toml::node& node = table.need("ratio", "ratio = 4");
  const Curves curves{table.number("ratio", node), read_positive(table, "cfl", "cfl = [0.9, 1.5, 2]")};
  check_horizon(scene, N, curves.ratio * scene.period() / static_cast<double>(N), table.place(node));
  return curves;
}

/// @throws InputError for a scheme that has no matrix to take norms and eigenvalues of
void require_matrix(const Subject& subject, const Place& at) {
  if (!subject.scheme.model->linear) {
    at.fail(fmt::format("{} is not linear, so that its steps have no matrix to study; leave limiter out",
                        subject.scheme.model->label()));
  }
  if (subject.scheme.model->carries_volumes && subject.scheme.nonlocal_divergence && !subject.scene->standing()) {
    at.fail(fmt::format(
        "with the nonlocal divergence the unknown of {} is V u, whose steps are not those of u; write divergence = "
        "\"local\"",
        subject.scheme.model->label()));
  }
}

void require_viscosity(const Subject& subject, const Place& at) {
  if (subject.scheme.model->viscous && subject.mu == 0.0) {
    at.fail("a scheme with mu = 0 has no CFL number; give it a viscosity bound");
  }
}

std::vector<Subject> read_unstable_controls(const Table& root, const std::shared_ptr<const Scene>& scene) {
  std::vector<Subject> controls;
  if (root.find("control") == nullptr) return controls;
  for (const Table& control : root.array_of_tables("control")) {
    const SchemeEntry entry = read_control(control, *scene);
    const std::string_view name = entry.scheme.control->name;
    if (std::find(unstable_controls.begin(), unstable_controls.end(), name) == unstable_controls.end()) {
      control.place(*control.find("name"))
          .fail(fmt::format("name = \"{}\"; only controls that no step of forward Euler keeps stable belong here: {}",
                            name, fmt::join(unstable_controls, ", ")));
    }
    controls.push_back({entry.scheme, entry.mu, scene, Arrangement::uniform});
    require_viscosity(controls.back(), control.place());
  }
  return controls;
}

void read_stability_map(const Table& root, Study& study) {
  study.scene = read_scene_with_advection(root.sub_table("scene"));
  const Scene& scene = *study.scene;
  const Table table = root.sub_table("stability-map");
  const StabilityGrid grid = read_grid(table, scene);
  const std::vector<const Integrator*> chosen = read_integrators(table);
  const std::vector<Subject> subjects = read_subjects(root, study.scene);
  if (scene.T() == 0.0) {
    root.place(*root.find("scene")).fail("T = 0; growth over T needs time: write T = 1");
  }
  for (const Subject& subject : subjects) {
    require_viscosity(subject, root.place(*root.find("scheme")));
    require_matrix(subject, root.place(*root.find("scheme")));
  }
  const std::vector<Subject> controls = read_unstable_controls(root, study.scene);

  std::vector<Measurement>& all = study.measurements;
  const auto examine = [&](const Subject& subject, const Integrator& integrator) {
    for (const Measure what : {Measure::norm, Measure::spectral, Measure::growth}) {
      all.push_back(stability_map(subject, integrator, grid, what));
    }
    for (const Measure what : {Measure::norm, Measure::spectral}) {
      all.push_back(sharp_limit(subject, integrator, grid, what));
    }
    if (subject.arrangement == Arrangement::uniform && subject.scheme.control == nullptr) {
      all.push_back(smallest_entry(subject, integrator, grid));
    }
  };
  for (const Subject& subject : subjects) {
    for (const Integrator* const integrator : chosen) examine(subject, *integrator);
  }
  // Other integrators make up for some of what forward Euler does to a control.
  for (const Subject& subject : controls) examine(subject, forward_euler);

  if (root.find("growth") == nullptr) return;
  const Curves curves = read_curves(root.sub_table("growth"), scene, grid.N);
  const auto draw = [&](const Subject& subject, const Integrator& integrator) {
    for (const double cfl : curves.cfl) {
      all.push_back(growth_curve(subject, integrator, grid.N, curves.ratio, cfl));
    }
  };
  for (const Subject& subject : subjects) {
    if (subject.arrangement != Arrangement::uniform) continue;
    for (const Integrator* const integrator : chosen) draw(subject, *integrator);
  }
  for (const Subject& subject : controls) draw(subject, forward_euler);
}

constexpr Key map_control_keys[] = {
    {"name", "a control", "a scheme with a mistake, that no step keeps stable"},
    {"scheme", "table", "the keys of a [[scheme]]: what it is a mistake in"},
};
constexpr Key grid_keys[] = {
    {"N", "whole number", "particles, 8 to 1000"},
    {"ratios", "list of numbers", "delta/h"},
    {"cfl", "list of numbers", "steps over the bound of the lemma"},
    {"integrators", "list of integrators", "each gets its own maps"},
};
constexpr Key growth_keys[] = {
    {"ratio", "number", "delta/h of the curves of growth in time"},
    {"cfl", "list of numbers", "a curve each"},
};
constexpr TableKeys stability_map_tables[] = {scene_table,
                                              scheme_table,
                                              {"[[control]]", map_control_keys, true},
                                              {"[stability-map]", grid_keys},
                                              {"[growth]", growth_keys, true}};

}  // namespace

const Kind stability_map_kind{"stability-map", "where steps are stable, over CFL number and horizon",
                              stability_map_tables, read_stability_map, true};

}  // namespace acstudy
