#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

#include "studies/cases/study_result.hpp"
#include "studies/claims/consistency.hpp"
#include "studies/claims/identities.hpp"
#include "studies/claims/stability.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/models/operator.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

using Expectations = std::map<std::string, Verdict>;

/// A row of the detection matrix: a scheme or a control, and what is expected of it where that is not what is promised.
struct Row {
  SchemeEntry entry;
  Expectations expect;
};

/// A column: what a row is put before. A path has no measurement yet, as each row runs a series of its own along it.
struct Column {
  std::string name;
  std::function<Measurement(const SchemeEntry&)> measurement;
  bool of_theory = false;      ///< what it measures is said of the models of the paper alone
  bool of_steps = false;       ///< or of those whose steps theory bounds
  bool of_truncation = false;  ///< or of those whose order is that of what they leave of the equation
};

/// Errors of runs along a path, of the series of this number.
Measurement along_path(const Series& series, std::size_t number) {
  return {{.statement = series.theory.statement,
           .claim = fmt::format("order {:g} in {}", series.theory.order, series.theory.variable),
           .quantity = "max-norm error at T",
           .test = Test::order,
           .variable = series.theory.variable,
           .theory_order = series.theory.order,
           .promised = series.theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed},
          [number](Finding& finding, const std::vector<SeriesResult>& all) {
            const auto& [planned, results] = std::tie(*all[number].series, all[number].results);
            for (std::size_t i = 0; i < planned.cases.size(); ++i) {
              const Case& c = planned.cases[i];
              finding.points.push_back({c.N, c.h, c.delta, planned.variable(c.h, c.delta), results[i].error_linf});
              if (finding.failure.empty()) finding.failure = results[i].failure;
            }
          }};
}

/// The flow of the runs before the checks of a scene.
Measurement trajectories(const SchemeEntry& entry, const std::shared_ptr<const Scene>& scene) {
  return {{.statement = "(2.7)",
           .claim = "x' = b(x) and x(0) = x_0 along trajectories, which do not cross",
           .quantity = "refusals of the flow by the checks of the scene"},
          [=](Finding& finding) {
            SceneText text = scene->text();
            const Control* const control = entry.scheme.control;
            if (control != nullptr && control->flow != nullptr) text.flow = control->flow;
            Point point{.value = 0.0, .lower = 0.0, .upper = 0.0};
            try {
              const Scene checked(text);
            } catch (const SceneError& error) {
              point.value = 1.0;
              finding.remark = error.what();
            }
            finding.points.push_back(point);
          }};
}

/// A cell of the matrix, whose finding the count of alarms rests on, too: it is measured once, by whichever asks first.
class Cell {
 public:
  explicit Cell(Measurement measurement) : state_(std::make_shared<State>(std::move(measurement))) {}

  const Finding& finding(const std::vector<SeriesResult>& results) const {
    std::call_once(state_->flag, [&] { state_->finding = state_->measurement.take(results); });
    return state_->finding;
  }
  Measurement measurement() const {
    return {state_->measurement.check, [cell = *this](Finding& finding, const std::vector<SeriesResult>& results) {
              // Its name may have been told apart from others since.
              std::vector<Coordinate> coordinates = std::move(finding.coordinates);
              finding = cell.finding(results);
              finding.coordinates = std::move(coordinates);
            }};
  }

 private:
  struct State {
    explicit State(Measurement its_measurement) : measurement(std::move(its_measurement)) {}
    Measurement measurement;
    std::once_flag flag;
    Finding finding;
  };
  std::shared_ptr<State> state_;
};

/// A mistake is noticed by some check, and nothing is noticed where there is none.
Measurement alarms(const Control* control, const std::vector<Cell>& cells) {
  Check check{.statement = "detection", .claim = "no check raises an alarm", .quantity = "checks that raise an alarm"};
  Point bounds{.lower = 0.0, .upper = 0.0};
  if (control != nullptr) {
    check.claim = "some check raises an alarm";
    check.remark = control->mistake;
    bounds.lower = 1.0;
    bounds.upper = HUGE_VAL;
  }
  return {check, [=](Finding& finding, const std::vector<SeriesResult>& results) {
            const auto raised = [&](const Cell& cell) { return cell.finding(results).alarm(); };
            finding.points.push_back(bounds);
            finding.points.back().value = static_cast<double>(std::count_if(cells.begin(), cells.end(), raised));
          }};
}

/// A path that all rows are put before.
PathChoice read_column(const Table& table) {
  for (const char* const key : {"expect", "order"}) {
    const toml::node* const node = table.find(key);
    if (node == nullptr) continue;
    table.place(*node).fail(
        fmt::format("a path of this kind of study has no {}; expectations stand in a table expect of "
                    "their [[control]]",
                    key));
  }
  return read_path(table);
}

Expectations read_expectations(const Table& table, const std::vector<Column>& columns) {
  Expectations expect;
  if (table.find("expect") == nullptr) return expect;
  const Table words = table.sub_table("expect");
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  words.allow(names);
  std::vector<std::pair<std::string, Verdict>> verdicts;
  for (int v = 0; v <= static_cast<int>(Verdict::violated); ++v) {
    verdicts.emplace_back(name_of(static_cast<Verdict>(v)), static_cast<Verdict>(v));
  }
  for (const Column& column : columns) {
    const toml::node* const node = words.find(column.name);
    if (node == nullptr) continue;
    expect[column.name] = words.choice<Verdict>(column.name, *node, verdicts);
  }
  return expect;
}

/// [time] of runs that mistaken schemes can take as well.
Stepping read_stepping(const Table& root, Study& study) {
  const Stepping time = read_problem(root, study);
  if (time.rule.bound == StepRule::Bound::rows) {
    time.at_step.fail("bound = \"rows\"; a control does not say what its rows need: leave bound out");
  }
  if (time.integrator->implicit()) {
    root.place(*root.find("time"))
        .fail(fmt::format("integrator = \"{}\"; a control has no matrix to solve with: write an explicit one",
                          time.integrator->name));
  }
  return time;
}

/// The columns that need no runs.
std::vector<Column> columns_without_runs(const Table& root, const std::shared_ptr<const Scene>& scene) {
  const auto constant = std::make_shared<const Scene>(SceneText{.name = "",
                                                                .period = "1",
                                                                .T = "1",
                                                                .c = "1",
                                                                .b = std::nullopt,
                                                                .u = "sin(2*pi*(x - t))",
                                                                .flow = std::nullopt});
  const auto on_scene = [scene](const SchemeEntry& entry) {
    return Subject{entry.scheme, entry.mu, scene, scene->standing() ? Arrangement::jittered : Arrangement::moved};
  };
  const Resolutions resolutions{{100, 200}, {0.1, 1.0, 2.5, 10.0}, {}};

  std::vector<Column> columns;
  for (const Table& table : root.array_of_tables("consistency")) {
    const PathChoice path = read_column(table);
    for (const std::int64_t N : path.N) {
      const double count = static_cast<double>(N), delta = path.delta({scene->period() / count, count});
      check_horizon(*scene, N, delta, table.place(*table.find("delta")));
    }
    columns.push_back({.name = "consistency, " + path.name,
                       .measurement = [=](const SchemeEntry& entry) { return truncation_along(on_scene(entry), path); },
                       .of_truncation = true});
  }
  columns.push_back(
      {"nearest neighbors",
       [=](const SchemeEntry& entry) { return nearest_neighbor_rows(on_scene(entry), resolutions.N, 0.5); }, true});
  columns.push_back({"first moment",
                     [=](const SchemeEntry& entry) { return first_moment_is_one(on_scene(entry), resolutions); },
                     true});
  columns.push_back({.name = "step norm",
                     .measurement =
                         [=](const SchemeEntry& entry) {
                           return step_is_bounded(on_scene(entry), resolutions, StepCondition::corrected);
                         },
                     .of_steps = true});
  columns.push_back({.name = "maximum principle",
                     .measurement =
                         [=](const SchemeEntry& entry) {
                           const Subject subject{entry.scheme, 1.0, constant, Arrangement::jittered};
                           return step_is_bounded(subject, resolutions, StepCondition::corrected);
                         },
                     .of_steps = true});
  columns.push_back({"trajectories", [=](const SchemeEntry& entry) { return trajectories(entry, scene); }});
  return columns;
}

void read_controls(const Table& root, Study& study) {
  const Stepping time = read_stepping(root, study);
  const auto scene = study.scene;
  const std::vector<Table> path_tables = root.array_of_tables("path");
  std::vector<PathChoice> paths;
  for (const Table& table : path_tables) paths.push_back(read_column(table));
  std::vector<Column> columns;
  for (const PathChoice& path : paths) columns.push_back({path.name, {}});
  for (Column& column : columns_without_runs(root, scene)) columns.push_back(std::move(column));
  std::set<std::string> names;
  for (const Column& column : columns) {
    if (!names.insert(column.name).second) {
      root.place().fail(fmt::format("a second check named \"{}\"; the names of paths must differ", column.name));
    }
  }

  std::vector<Row> rows;
  for (const SchemeEntry& entry : read_schemes(root, *scene)) rows.push_back({entry, {}});
  for (const Table& table : root.array_of_tables("control")) {
    rows.push_back({read_control(table, *scene), read_expectations(table, columns)});
  }

  for (const Row& row : rows) {
    const auto put = [&](Measurement measurement, const std::string& column) {
      Check& check = measurement.check;
      check.subject = scheme_label(row.entry.scheme, scene->standing());
      check.coordinates = scheme_coordinates(row.entry.scheme, row.entry.mu, scene->standing());
      check.coordinates.insert(check.coordinates.begin(), {"column", column});
      const auto expected = row.expect.find(column);
      check.expected = expected == row.expect.end() ? check.promised : expected->second;
      return measurement;
    };
    std::vector<Cell> cells;
    const ModelCard& model = *row.entry.scheme.model;
    for (std::size_t p = 0; p < columns.size(); ++p) {
      if (model.beyond_paper && columns[p].of_theory) continue;
      if (!model.step_lemma.promised && columns[p].of_steps) continue;
      if (!model.no_truncation.empty() && columns[p].of_truncation) continue;
      if (p < paths.size()) {
        const Place at_delta = path_tables[p].place(*path_tables[p].find("delta"));
        study.series.push_back(make_series(study, time, row.entry, paths[p], at_delta));
        cells.emplace_back(put(along_path(study.series.back(), study.series.size() - 1), columns[p].name));
      } else {
        cells.emplace_back(put(columns[p].measurement(row.entry), columns[p].name));
      }
      study.measurements.push_back(cells.back().measurement());
    }
    study.measurements.push_back(put(alarms(row.entry.scheme.control, cells), "alarms"));
  }
}

constexpr Key control_keys[] = {
    {"name", "a control", "a mistake, as studies/controls.toml names them"},
    {"scheme", "table", "the keys of a [[scheme]]: what it is a mistake in"},
    {"expect", "table", "a verdict by the name of a check", "what a right scheme does"},
};
constexpr TableKeys controls_tables[] = {scene_table,
                                         time_table,
                                         source_table,
                                         path_table,
                                         {"[[consistency]]", path_keys},
                                         scheme_table,
                                         {"[[control]]", control_keys}};

}  // namespace

const Kind controls_kind{"controls", "which check notices which deliberate mistake", controls_tables, read_controls,
                         true};

}  // namespace acstudy
