#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "studies/cases/study_result.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/kinds/study_file.hpp"

namespace acstudy {

namespace {

using Field = std::vector<double>;
using Results = std::vector<SeriesResult>;

/// A round-off is measured by the same problem in other units: u and f times this are, by linearity, the same solution
/// times this, but every sum is rounded elsewhere, as this is no power of two. Positions and weights are the same.
constexpr int other_unit = 3;

/// A case and its reruns, as numbers of series of one case each.
struct Reruns {
  std::size_t base, halved_step, other_unit;
  std::optional<std::size_t> third_order, other_source;
  int time_order;
};

/// max |a - scale b|; NaN if a value is, or if one of the two is not there.
double distance(const Field& a, const Field& b, double scale = 1.0) {
  double largest = a.empty() || a.size() != b.size() ? NAN : 0.0;
  for (std::size_t i = 0; i < a.size() && !std::isnan(largest); ++i) {
    const double gap = std::abs(a[i] - scale * b[i]);
    if (!(gap <= largest)) largest = gap;
  }
  return largest;
}

/// The parts of the error, relative to all of it.
void measure_parts(Finding& finding, const Case& c, const Reruns& reruns, const Results& results) {
  const auto result = [&](std::size_t series) -> const CaseResult& { return results[series].results[0]; };
  const CaseResult& base = result(reruns.base);
  const double error = base.error_linf;
  if (error == 0.0) {
    finding.failure = "the error is zero, so it has no parts";
    return;
  }
  const auto add = [&](const std::string& label, double part, double most = HUGE_VAL) {
    finding.points.push_back(
        {.N = c.N, .h = c.h, .delta = c.delta, .value = part / error, .upper = most, .label = label});
  };
  constexpr double negligible = 0.01;

  // The solution without time steps, as halved ones show it: they leave 1/2^k of an error of order k in dt.
  const Field& halved = result(reruns.halved_step).u;
  const double whole = 1.0 / (1.0 - std::pow(2.0, -reruns.time_order));
  Field steady = base.u;
  if (halved.size() != steady.size()) steady.clear();
  for (std::size_t i = 0; i < steady.size(); ++i) steady[i] -= whole * (base.u[i] - halved[i]);
  const double time = distance(base.u, steady);
  add("time", time);
  if (reruns.third_order) add("time, against ssprk3", distance(steady, result(*reruns.third_order).u), negligible);
  if (reruns.other_source) add("source", distance(base.u, result(*reruns.other_source).u), negligible);
  add("round-off", distance(result(reruns.other_unit).u, base.u, other_unit) / other_unit, negligible);
  add("space", distance(steady, base.u_exact));
  if (time > 0.5 * error) {
    finding.remark = fmt::format("the time step makes {:.0f} % of the error: the observed order is not that of space",
                                 100.0 * time / error);
  } else if (!c.nonlocal_source) {
    finding.remark = "the source is exact";
  }
}

constexpr Key pollution_keys[] = {
    {"studies", "list of files", "convergence studies, relative to this file"},
    {"coarser", "whole number", "levels by which a series' case is coarser than its finest", "0"},
};
constexpr TableKeys pollution_tables[] = {{"[pollution]", pollution_keys}};

/// A study named by another one.  @param at  where it is named
Study read_named(const std::string& name, const std::string& by, const Place& at) {
  const std::filesystem::path file = std::filesystem::path(by).parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    at.fail(fmt::format("studies contains {}, but there is no such file; names are relative to the study file",
                        in_quotes(name)));
  }
  // Before it is read as a study, or a study that names itself would be read for ever.
  std::string kind;
  try {
    kind = toml::parse_file(file.string())["study"]["kind"].value_or("convergence");
  } catch (const toml::parse_error&) {
    kind = "convergence";  // reading the study says what is wrong with it
  }
  if (kind != "convergence") {
    at.fail(fmt::format("studies contains \"{}\", which is of kind \"{}\"; name studies of kind \"convergence\"", name,
                        kind));
  }
  return read_study(file.string());
}

/// Adds a case of a series and its reruns to the study.  @param scaled  its scene in other units
Reruns add_reruns(Study& study, const std::string& study_of_series, const Series& series, const Case& c,
                  const std::shared_ptr<const Scene>& scaled) {
  const auto rerun = [&](const std::string& how, auto change) {
    study.series.push_back(series);
    study.series.back().path = fmt::format("{}, {}, {}", study_of_series, series.path, how);
    study.series.back().cases = {c};
    change(study.series.back().cases[0]);
    return study.series.size() - 1;
  };
  Reruns reruns{};
  reruns.time_order = c.integrator->order;
  reruns.base = rerun("as it is", [](Case&) {});
  reruns.halved_step = rerun("step halved", [](Case& changed) { changed.halve_steps(); });
  // Explicit steps as long as implicit ones would be unstable.
  if (c.integrator->name != "ssprk3" && !c.integrator->implicit()) {
    reruns.third_order = rerun("ssprk3", [](Case& changed) {
      changed.integrator = std::find_if(std::begin(integrators), std::end(integrators),
                                        [](const Integrator& known) { return known.name == "ssprk3"; });
    });
  }
  if (c.nonlocal_source) {
    reruns.other_source = rerun("other source rule", [](Case& changed) {
      if (changed.source_rule == SourceRule::gauss) changed.source_refinement = 2;
      changed.source_rule = SourceRule::gauss;
    });
  }
  reruns.other_unit = rerun("u in other units", [&](Case& changed) { changed.scene = scaled; });
  return reruns;
}

void read_pollution(const Table& root, Study& study) {
  const Table table = root.sub_table("pollution");
  const toml::node* const coarser = table.find("coarser");
  const std::int64_t levels_below = coarser ? table.whole("coarser", *coarser, 0, 100) : 0;
  for (const toml::node& item : table.list("studies", "studies = [\"fig1.toml\"]")) {
    const auto name = item.value_exact<std::string>();
    if (!name) {
      table.place(item).fail(
          fmt::format("studies contains {}; every entry must be the name of a study file", Table::described(item)));
    }
    const Study named = read_named(*name, study.file, table.place(item));
    if (!named.scene->solved()) {
      table.place(item).fail(fmt::format(
          "studies contains \"{}\", whose scene has a reference in place of u; an error has parts only if it is known",
          *name));
    }
    if (std::any_of(named.series.begin(), named.series.end(),
                    [](const Series& series) { return series.scheme.program != nullptr; })) {
      table.place(item).fail(fmt::format(
          "studies contains \"{}\", which has a command for a scheme; its steps and source cannot be taken apart",
          *name));
    }
    if (std::any_of(named.series.begin(), named.series.end(),
                    [](const Series& series) { return series.until_decided; })) {
      table.place(item).fail(fmt::format(
          "studies contains \"{}\", where a path adds levels until they decide, so that its finest is not known; name "
          "one with N = [160, 320, 640, 1280]",
          *name));
    }
    if (std::any_of(named.series.begin(), named.series.end(),
                    [](const Series& series) { return series.cases.front().step.adaptive(); })) {
      table.place(item).fail(fmt::format(
          "studies contains \"{}\", whose steps are adaptive; the part of time is seen by halving them, so name one "
          "with an expression such as step = \"h/2\"",
          *name));
    }
    SceneText text = named.scene->text();
    text.name.clear();
    text.u = fmt::format("{}*({})", other_unit, text.u);
    const auto scaled = std::make_shared<const Scene>(text);

    for (const Series& series : named.series) {
      if (series.expected == Verdict::unstable) continue;
      const auto levels = std::ssize(series.cases);
      if (levels_below >= levels) {
        table.place(*coarser).fail(fmt::format("coarser = {}, but {} of {} has {} levels; it must be less",
                                               levels_below, series.label(), named.name, levels));
      }
      const Case& c = series.cases[static_cast<std::size_t>(levels - 1 - levels_below)];
      const Reruns reruns = add_reruns(study, named.name, series, c, scaled);
      study.measurements.push_back(
          {{.statement = "error budget",
            .claim = "error = space + time; source, round-off and what is unknown of time are less than 1 % of it",
            .subject = series.label(),
            .coordinates = {{"study", named.name},
                            {"N", static_cast<double>(c.N), fmt::format("N = {}", c.N)},
                            unspoken({"source", series.nonlocal_source ? "nonlocal" : "local"})},
            .quantity = "max difference of the fields over the max error"},
           [c, reruns](Finding& finding, const Results& results) { measure_parts(finding, c, reruns, results); }});
    }
  }
}

}  // namespace

const Kind pollution_kind{"pollution", "parts of the finest errors that are not of the scheme in space",
                          pollution_tables, read_pollution};

}  // namespace acstudy
