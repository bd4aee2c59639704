#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/control_choice.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/operator.hpp"
#include "studies/store.hpp"
#include "studies/study_parts.hpp"
#include "studies/theory.hpp"

namespace acstudy {

namespace {

using Expectations = std::map<std::string, Verdict>;

/// A row of the detection matrix: a scheme or a control, and what is expected of it where that is not what is promised.
struct Row {
  SchemeEntry entry;
  Expectations expect;
};

/// A column: what a true scheme must show, and how it is measured. Finding::subject and `expected` come from the row.
struct Column {
  std::string name;
  Test test;
  std::function<Finding(const Row&, const std::vector<SeriesResult>&)> take;
};

constexpr double horizons[] = {0.1, 1.0, 2.5, 10.0};  // over the spacing of the uniform start
constexpr std::size_t operator_particles = 200;

/// Calls `visit(arrangement, placed scheme, delta)` for irregular particles and horizons from below to above the gaps.
template <class Visit>
void for_each_placement(const SchemeEntry& entry, const Scene& scene, Visit&& visit) {
  for (const Arrangement arrangement : {Arrangement::moved, Arrangement::jittered}) {
    if (arrangement == Arrangement::moved && scene.standing()) continue;
    const std::vector<double> x = arrange(arrangement, scene, operator_particles);
    for (const double horizon : horizons) {
      const double delta = horizon * scene.period() / static_cast<double>(operator_particles);
      visit(x, delta, PlacedScheme(entry.scheme, scene, entry.mu, x, delta));
    }
  }
}

Point point_at(const Scene& scene, const std::vector<double>& x, double delta) {
  return {.N = static_cast<std::int64_t>(x.size()),
          .h = gaps(x, scene.period()).largest,
          .delta = delta,
          .variable = delta};
}

/// Errors of runs along a path, of the series that run it.
Finding along_path(const Series& series, const SeriesResult& result) {
  Finding finding{.statement = series.theory.statement,
                  .claim = fmt::format("order {:g} in {}", series.theory.order, series.theory.variable),
                  .quantity = "max-norm error at T",
                  .test = Test::order,
                  .variable = series.theory.variable,
                  .theory_order = series.theory.order,
                  .promised = Verdict::confirmed};
  for (std::size_t i = 0; i < series.cases.size(); ++i) {
    const Case& c = series.cases[i];
    finding.points.push_back({c.N, c.h, c.delta, series.variable(c.h, c.delta), result.results[i].error_linf});
    if (finding.remark.empty()) finding.remark = result.results[i].failure;
  }
  return finding;
}

Finding consistency(const PathChoice& path, const SchemeEntry& entry, const Scene& scene) {
  const bool nonlocal = path.nonlocal_source;
  Finding finding{.statement = entry.scheme.model == 1 ? (nonlocal ? "Lemma 2.3" : "Lemma 2.5")
                                                       : (nonlocal ? "Lemma 3.2" : "Lemma 3.4"),
                  .claim = nonlocal ? "truncation error O(h)" : "truncation error O(max(h, delta))",
                  .quantity = "max |rate + f - du/dt|",
                  .test = Test::order,
                  .variable = nonlocal ? "h" : "max(h,delta)",
                  .theory_order = path.order.value_or(1.0),
                  .promised = Verdict::confirmed};
  for (const std::int64_t N : path.N) {
    const double count = static_cast<double>(N), delta = path.delta({scene.period() / count, count});
    const Arrangement arrangement = scene.standing() ? Arrangement::uniform : Arrangement::moved;
    const std::vector<double> x = arrange(arrangement, scene, static_cast<std::size_t>(N));
    PlacedScheme placed(entry.scheme, scene, entry.mu, x, delta);
    const auto source = make_source(entry.scheme, scene, entry.mu, nonlocal, delta);
    Point point = point_at(scene, x, delta);
    point.variable = nonlocal ? point.h : std::max(point.h, delta);
    point.value = max_norm(placed.truncation_error(*source, scene.standing() ? 0.0 : scene.T()));
    finding.points.push_back(point);
  }
  return finding;
}

/// The first moment of the weights is one; those of Model I are not negative, those of Model II sum up to zero.
Finding identities(const SchemeEntry& entry, const Scene& scene) {
  const bool first = entry.scheme.model == 1;
  Finding finding{.statement = first ? "Remark 2.2" : "(3.4)",
                  .claim = first ? "sum_k d_k W_k = 1, W_k >= 0" : "sum_k (x_i - x_j) W_k / N_j = 1, sum_k W_k = 0",
                  .quantity = first ? "largest of |sum_k d_k W_k - 1| and -d_k W_k"
                                    : "largest of |sum_k (x_i - x_j) W_k / N_j - 1| and delta |sum_k W_k|",
                  .test = Test::bounds,
                  .variable = "delta",
                  .promised = Verdict::holds};
  for_each_placement(entry, scene, [&](const std::vector<double>& x, double delta, const PlacedScheme& placed) {
    Point point = point_at(scene, x, delta);
    point.value = 0.0;
    // A few rounded sums of at most 50 terms, each of size one at most.
    point.upper = 1e-13;
    for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) {
      const Stencil stencil = placed.scheme().stencil(j);
      double moment = 0.0, sum = 0.0, least = 0.0;
      for (std::size_t k = 0; k < stencil.offset.size(); ++k) {
        const double offset = placed.particles().x[j + stencil.offset[k]] - placed.particles().x[j];
        const double part = (first ? std::abs(offset) : offset) * stencil.weight[k];
        moment += part / stencil.renormalization;
        sum += delta * stencil.weight[k];
        least = std::min(least, part);
      }
      for (const double deviation : {std::abs(moment - 1.0), first ? -least : std::abs(sum)}) {
        if (std::isnan(deviation) || deviation > point.value) point.value = deviation;
      }
    }
    finding.points.push_back(point);
  });
  return finding;
}

/// The largest step of forward Euler for which the proofs of Lemmas 2.4 and 3.3 hold, of the scheme without a mistake.
double stable_step(const SchemeEntry& entry, const Scene& scene, const std::vector<double>& x, double delta) {
  if (entry.scheme.model == 1) return gaps(x, scene.period()).smallest / scene.max_relative_velocity();
  SchemeChoice itself = entry.scheme;
  itself.control.clear();
  const PlacedScheme placed(itself, scene, entry.mu, x, delta);
  double rate = 0.0;
  for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) {
    const Stencil stencil = placed.scheme().stencil(j);
    double reach = delta, slopes = 0.0;
    for (std::size_t k = 0; k < stencil.offset.size(); ++k) {
      const double offset = placed.particles().x[j + stencil.offset[k]] - placed.particles().x[j];
      reach = std::max(reach, std::abs(offset));
      slopes += stencil.weight[k] / offset;
    }
    rate = std::max(rate, entry.mu * reach / stencil.renormalization * slopes);
  }
  return 1.0 / rate;
}

/// ||b'|| + ||c_hat'|| over the period.
double growth_rate(const Scene& scene) {
  constexpr std::size_t count = 4096;
  const std::vector<double> x = uniform_positions(count, scene.period());
  std::vector<double> field(count), c_prime(count), b_prime(count, 0.0), c_hat_prime(count);
  scene.c(x, field, c_prime);
  if (!scene.standing()) scene.b_prime(x, b_prime);
  for (std::size_t j = 0; j < count; ++j) c_hat_prime[j] = c_prime[j] - b_prime[j];
  return max_norm(b_prime) + max_norm(c_hat_prime);
}

/// The largest row sum of |I + dt R|.
double step_norm(PlacedScheme& placed, double dt) {
  const PlacedScheme::Rows rows = placed.rows();
  std::vector<double> sums(placed.size());
  const auto n = static_cast<std::ptrdiff_t>(placed.size());
  for (std::size_t j = 0; j < placed.size(); ++j) {
    for (std::size_t k = 0; k < rows.width; ++k) {
      const auto column = static_cast<std::ptrdiff_t>(j + k) + rows.first;
      const bool diagonal = (column % n + n) % n == static_cast<std::ptrdiff_t>(j);
      sums[j] += std::abs((diagonal ? 1.0 : 0.0) + dt * rows(j, k));
    }
  }
  return max_norm(sums);
}

Finding stability(const SchemeEntry& entry, const Scene& scene) {
  const double growth = growth_rate(scene);
  Finding finding{.statement = entry.scheme.model == 1 ? "Lemma 2.4" : "Lemma 3.3",
                  .claim = scene.standing() ? "maximum principle where c is constant"
                                            : "a step grows by 1 + dt (||b'|| + ||c_hat'||) at most",
                  .quantity = "largest row sum of |I + dt R|, less 1",
                  .test = Test::bounds,
                  .variable = "delta",
                  .promised = Verdict::holds};
  for_each_placement(entry, scene, [&](const std::vector<double>& x, double delta, PlacedScheme placed) {
    const double dt = stable_step(entry, scene, x, delta);
    Point point = point_at(scene, x, delta);
    point.value = step_norm(placed, dt) - 1.0;
    // The maxima of the fields are sampled: 1e-6 is what may be missing between the samples. 1e-13 is round-off.
    point.upper = dt * growth * (1.0 + 1e-6) + 1e-13;
    finding.points.push_back(point);
  });
  return finding;
}

Finding trajectories(const SchemeEntry& entry, const Scene& scene) {
  Finding finding{.statement = "(2.7)",
                  .claim = "x' = b(x) and x(0) = x_0 along trajectories, which do not cross",
                  .quantity = "refusals of the flow by the checks of the scene",
                  .test = Test::bounds,
                  .variable = "",
                  .promised = Verdict::holds};
  SceneText text = scene.text();
  if (entry.scheme.control == misprinted_trajectories) text.flow = misprinted_flow;
  Point point{.value = 0.0, .lower = 0.0, .upper = 0.0};
  try {
    const Scene checked(text);
  } catch (const SceneError& error) {
    point.value = 1.0;
    finding.remark = error.what();
  }
  finding.points.push_back(point);
  return finding;
}

}  // namespace

namespace {

/// scheme = { model = 1, ... } of a [[control]] that is a mistake of this scheme.
SchemeEntry read_control(const Table& table, const Scene& scene) {
  const std::string name = table.text("name", "name = \"downwind\"");
  const auto control = std::find_if(named_controls.begin(), named_controls.end(),
                                    [&](const NamedControl& known) { return known.name == name; });
  if (control == named_controls.end()) {
    std::vector<std::string> known;
    for (const NamedControl& one : named_controls) known.push_back("\"" + std::string(one.name) + "\"");
    table.place(*table.find("name"))
        .fail(fmt::format("name = \"{}\"; it must be one of {}", name, fmt::join(known, ", ")));
  }
  const Table scheme_table = table.sub_table("scheme");
  SchemeChoice scheme = read_scheme(scheme_table, scene);
  if (scheme.nonlocal_divergence || (control->model != 0 && control->model != scheme.model)) {
    scheme_table.place().fail(fmt::format(
        "{} is a mistake in Model {}, local divergence; write scheme = {{ model = {}, divergence = \"local\", ... }}",
        name, control->model == 0 ? "I or II" : (control->model == 1 ? "I" : "II"), std::max(control->model, 1)));
  }
  if (name == misprinted_trajectories && scene.text().b != "sin(x)") {
    table.place().fail(fmt::format("{} are those of b = sin(x); use the scene \"lee-du-2019\"", name));
  }
  scheme.control = name;
  return {scheme, scheme.model == 1 ? 0.0 : scheme.mu.value_or(scene.max_relative_velocity())};
}

Expectations read_expectations(const Table& table, const std::vector<Column>& columns) {
  Expectations expect;
  if (table.find("expect") == nullptr) return expect;
  const Table words = table.sub_table("expect");
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  words.allow(names);
  for (const Column& column : columns) {
    const toml::node* const node = words.find(column.name);
    if (node == nullptr) continue;
    expect[column.name] =
        column.test == Test::order
            ? read_expected(words, *node)
            : words.choice<Verdict>(column.name, *node, {{"holds", Verdict::holds}, {"violated", Verdict::violated}});
  }
  return expect;
}

}  // namespace

void read_controls(const Table& root, Study& study) {
  root.allow({"study", "scene", "time", "source", "path", "consistency", "scheme", "control"});
  study.scene = read_scene(root.sub_table("scene"));
  const Stepping time = read_time(root);
  study.integrator = time.integrator;
  study.step_text = time.step.text();
  study.source_rule = read_source_rule(root);
  const auto scene = study.scene;
  const auto constant = std::make_shared<const Scene>(SceneText{.name = "",
                                                                .period = "1",
                                                                .T = "1",
                                                                .c = "1",
                                                                .b = std::nullopt,
                                                                .u = "sin(2*pi*(x - t))",
                                                                .flow = std::nullopt});

  std::vector<Column> columns;
  const std::vector<Table> path_tables = root.array_of_tables("path");
  std::vector<PathChoice> paths;
  for (const Table& table : path_tables) paths.push_back(read_path(table));
  for (const PathChoice& path : paths) columns.push_back({path.name, Test::order, {}});
  for (const Table& table : root.array_of_tables("consistency")) {
    const PathChoice path = read_path(table);
    columns.push_back({"consistency, " + path.name, Test::order,
                       [scene, path](const Row& row, const auto&) { return consistency(path, row.entry, *scene); }});
  }
  columns.push_back(
      {"identities", Test::bounds, [scene](const Row& row, const auto&) { return identities(row.entry, *scene); }});
  columns.push_back(
      {"step norm", Test::bounds, [scene](const Row& row, const auto&) { return stability(row.entry, *scene); }});
  columns.push_back({"maximum principle", Test::bounds, [constant](const Row& row, const auto&) {
                       SchemeEntry entry = row.entry;
                       entry.mu = entry.scheme.model == 1 ? 0.0 : 1.0;
                       return stability(entry, *constant);
                     }});
  columns.push_back(
      {"trajectories", Test::bounds, [scene](const Row& row, const auto&) { return trajectories(row.entry, *scene); }});

  std::vector<Row> rows;
  for (const SchemeEntry& entry : read_schemes(root, *scene)) rows.push_back({entry, {}});
  for (const Table& table : root.array_of_tables("control")) {
    table.allow({"name", "scheme", "expect"});
    rows.push_back({read_control(table, *scene), read_expectations(table, columns)});
  }

  for (const Row& row : rows) {
    std::vector<Measurement> cells;
    for (std::size_t p = 0; p < columns.size(); ++p) {
      Column column = columns[p];
      if (p < paths.size()) {
        const PathChoice& path = paths[p];
        Series series{.scheme = row.entry.scheme,
                      .path = path.name,
                      .delta_text = path.delta.text(),
                      .nonlocal_source = path.nonlocal_source,
                      .theory = {},
                      .expected = Verdict::confirmed,
                      .cases = {}};
        const Place at_delta = path_tables[p].place(*path_tables[p].find("delta"));
        for (const std::int64_t N : path.N) {
          const double count = static_cast<double>(N), delta = path.delta({scene->period() / count, count});
          series.cases.push_back(make_case(study, time, row.entry, N, delta, path.nonlocal_source, at_delta));
        }
        const Case& finest = series.cases.back();
        series.theory =
            theory_for(row.entry.scheme, scene->standing(), path.nonlocal_source,
                       finest.delta == series.cases.front().delta && series.cases.size() > 1, finest.delta < finest.h);
        column.take = [s = study.series.size()](const Row&, const std::vector<SeriesResult>& results) {
          return along_path(*results[s].series, results[s]);
        };
        study.series.push_back(std::move(series));
      }
      const std::string subject = scheme_label(row.entry.scheme, scene->standing());
      cells.push_back({subject + "; " + column.name, [row, column, subject](const std::vector<SeriesResult>& results) {
                         Finding finding = column.take(row, results);
                         finding.subject = subject;
                         finding.check = column.name;
                         const auto expected = row.expect.find(column.name);
                         finding.expected = expected == row.expect.end() ? finding.promised : expected->second;
                         judge(finding);
                         return finding;
                       }});
    }
    study.measurements.insert(study.measurements.end(), cells.begin(), cells.end());
  }
}

}  // namespace acstudy
