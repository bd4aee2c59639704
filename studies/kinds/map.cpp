#include <fmt/format.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <array>
#include <set>

#include "studies/cases/study_result.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/theory.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

/// Errors of one scheme against one target over the plane: series `first + d` has the horizon delta[d] and the case i
/// has the spacing h[i].
struct Plane {
  std::size_t first;
  std::vector<double> delta;  ///< small to large
  std::vector<std::int64_t> N;
  std::vector<double> h;  ///< coarse to fine

  Point at(const std::vector<SeriesResult>& results, std::size_t d, std::size_t i) const {
    return {.N = N[i], .h = h[i], .delta = delta[d], .value = results[first + d].results[i].error_linf};
  }
  /// The coarse levels are far from any limit in h: orders in h are those of the finer half, of four levels at least.
  std::size_t finer_half() const { return h.size() - std::min(h.size(), std::max<std::size_t>(4, h.size() / 2 + 1)); }
};

/// As many of the finest spacings as the limit h -> 0 at a horizon is extrapolated from.
constexpr std::size_t extrapolated_levels = 3;
/// Horizon over spacing from which on the scheme sees its kernel, so that this line is one.
constexpr double resolved = 4.0;

using Points = std::vector<Point>;
using Results = std::vector<SeriesResult>;

/// How the first run that blew up did so, if one did.
std::string first_blow_up(const Plane& plane, const Results& results) {
  for (std::size_t d = 0; d < plane.delta.size(); ++d) {
    for (std::size_t i = 0; i < plane.N.size(); ++i) {
      const std::string& how = results[plane.first + d].results[i].blow_up;
      if (!how.empty()) return fmt::format("N = {}, delta = {:g}: {}", plane.N[i], plane.delta[d], how);
    }
  }
  return {};
}

/// h -> 0 at a horizon.
Points along_h(const Plane& plane, const Results& results, std::size_t d) {
  Points points;
  for (std::size_t i = plane.finer_half(); i < plane.h.size(); ++i) {
    points.push_back(plane.at(results, d, i));
    points.back().variable = plane.h[i];
  }
  return points;
}

/// The largest error over all horizons, h -> 0.
Points over_horizons(const Plane& plane, const Results& results) {
  Points points;
  for (std::size_t i = plane.finer_half(); i < plane.h.size(); ++i) {
    Point worst = plane.at(results, 0, i);
    for (std::size_t d = 1; d < plane.delta.size(); ++d) {
      // Written so that a NaN is the largest.
      if (const Point point = plane.at(results, d, i); !(point.value <= worst.value)) worst = point;
    }
    worst.variable = plane.h[i];
    points.push_back(worst);
  }
  return points;
}

/// The distance between nonlocal and local solution, delta -> 0: at each horizon the limit h -> 0 of the error against
/// the local one, the intercept of a line through the errors at the finest spacings.
Points limits(const Plane& plane, const Results& results) {
  Points points;
  const std::size_t first = plane.h.size() - extrapolated_levels;
  for (std::size_t d = plane.delta.size(); d-- > 0;) {
    if (plane.delta[d] < resolved * plane.h[first]) break;
    std::array<double, extrapolated_levels> errors{};
    for (std::size_t i = 0; i < extrapolated_levels; ++i) errors[i] = plane.at(results, d, first + i).value;
    double intercept = 0.0, slope, cov00, cov01, cov11, squares;
    gsl_fit_linear(plane.h.data() + first, 1, errors.data(), 1, extrapolated_levels, &intercept, &slope, &cov00, &cov01,
                   &cov11, &squares);
    points.push_back({.h = 0.0, .delta = plane.delta[d], .variable = plane.delta[d], .value = intercept});
  }
  return points;
}

/// All errors.
Points everywhere(const Plane& plane, const Results& results) {
  Points points;
  for (std::size_t d = 0; d < plane.delta.size(); ++d) {
    for (std::size_t i = 0; i < plane.h.size(); ++i) {
      points.push_back(plane.at(results, d, i));
      points.back().variable = std::max(plane.h[i], plane.delta[d]);
    }
  }
  return points;
}

std::vector<double> read_horizons(const Table& map) {
  std::vector<double> horizons;
  for (const toml::node& item : map.list("delta", "delta = [0.01, 0.1, 1.0]")) {
    const double delta = map.number("delta", item);
    if (!horizons.empty() && !(delta > horizons.back())) {
      map.place(item).fail(
          fmt::format("delta = {:g} after {:g}; horizons must go from small to large", delta, horizons.back()));
    }
    horizons.push_back(delta);
  }
  return horizons;
}

std::vector<bool> read_sources(const Table& map) {
  std::vector<bool> sources;
  for (const toml::node& item : map.list("sources", "sources = [\"local\", \"nonlocal\"]")) {
    sources.push_back(map.choice<bool>("sources", item, {{"local", false}, {"nonlocal", true}}));
    if (sources.size() == 2 && sources[0] == sources[1]) map.place(item).fail("the same source a second time");
    if (sources.size() > 2) map.place(item).fail("a third source; there are two, \"local\" and \"nonlocal\"");
  }
  return sources;
}

void require_four(const Table& map, const char* key, std::size_t count) {
  if (count < 4) {
    map.place(*map.find(key))
        .fail(fmt::format("{} has {} entries; a surface of errors needs at least 4, 8 or more are better", key, count));
  }
}

/// The series of a scheme over the plane, a horizon each.  @return the plane, with the number of the first
Plane add_series(const Table& map, const Stepping& time, const SchemeEntry& entry, bool nonlocal, Plane plane,
                 Study& study) {
  const toml::array& delta_nodes = map.list("delta", "");
  plane.first = study.series.size();
  for (std::size_t d = 0; d < plane.delta.size(); ++d) {
    const double delta = plane.delta[d];
    Series series{.scheme = entry.scheme,
                  .path = fmt::format("delta = {:g}", delta),
                  .delta_text = fmt::format("{:g}", delta),
                  .nonlocal_source = nonlocal,
                  .theory = theory_for(entry.scheme, study.scene->standing(), nonlocal, true, delta < plane.h.back()),
                  .expected = Verdict::confirmed,
                  .cases = {}};
    for (const std::int64_t N : plane.N) {
      series.cases.push_back(make_case(study, time, entry, N, delta, nonlocal, map.place(delta_nodes[d])));
    }
    study.series.push_back(std::move(series));
  }
  return plane;
}

/// What is said of a scheme's errors over the plane against one of the two solutions.
class Limits {
 public:
  Limits(const SchemeEntry& entry, bool standing, bool nonlocal, Plane plane, std::vector<Measurement>& all)
      : entry_(entry), standing_(standing), nonlocal_(nonlocal), plane_(std::move(plane)), all_(all) {}

  void add() const { nonlocal_ ? add_against_nonlocal() : add_against_local(); }

 private:
  /// A limit at one horizon.
  Coordinate at(std::size_t d) const { return at_horizon(plane_.delta[d]); }
  std::string theorem_and(const char* part) const { return theorem(entry_.scheme, standing_) + part; }
  Theory theory_at(std::size_t d) const {
    return theory_for(entry_.scheme, standing_, nonlocal_, true, plane_.delta[d] < plane_.h.back());
  }

  template <class Take>
  void add(Check check, const Coordinate& condition, Take points) const {
    const std::string solution = nonlocal_ ? "nonlocal" : "local";
    check.subject = scheme_label(entry_.scheme, standing_);
    check.coordinates = scheme_coordinates(entry_.scheme, entry_.mu, standing_);
    check.coordinates.insert(check.coordinates.begin(), {{"source", solution, solution + " source"}, condition});
    check.quantity = "max error against the " + solution + " solution";
    check.expected = check.promised;
    all_.emplace_back(check, [points, plane = plane_](Finding& finding, const Results& results) {
      finding.points = points(plane, results);
      finding.remark = first_blow_up(plane, results);
    });
  }
  static Check order(const std::string& statement, const char* claim, const char* variable = "h", double order = 1.0) {
    return {.statement = statement,
            .claim = claim,
            .test = Test::order,
            .variable = variable,
            .theory_order = order,
            .promised = order == 0.0 ? Verdict::stagnates : Verdict::confirmed};
  }

  void add_against_nonlocal() const {
    const std::size_t last = plane_.delta.size() - 1;
    add(order(theorem_and(" (1)"), "h -> 0 at a fixed horizon: the nonlocal solution, O(h)"), at(last),
        [last](const Plane& p, const Results& r) { return along_h(p, r, last); });
    add(order(theory_at(0).statement, "h -> 0 above the horizon: the nonlocal solution, O(h)"), at(0),
        [](const Plane& p, const Results& r) { return along_h(p, r, 0); });
    add(order(theorem_and(" (1), (2)"), "h -> 0: O(h) uniformly in the horizon"), {"delta", "worst horizon"},
        over_horizons);
  }
  void add_against_local() const {
    const std::size_t last = plane_.delta.size() - 1;
    add(order(theorem_and(" (1)"), "h -> 0 at a fixed horizon: not the local solution, the error settles", "h",
              theory_at(last).order),
        at(last), [last](const Plane& p, const Results& r) { return along_h(p, r, last); });
    add(order(theorem_and(" (1), (2)"), "h -> 0, then delta -> 0: nonlocal solution to local one, O(delta)", "delta"),
        {"delta", "limits h -> 0"}, limits);
    add(order(theorem_and(" (2)"), "h -> 0 above the horizon: the local solution, O(h)"), at(0),
        [](const Plane& p, const Results& r) { return along_h(p, r, 0); });
    Check surface = order(theorem_and(" (2)"), "h and delta -> 0 in any relation: the local solution, O(max(h, delta))",
                          "max(h,delta)");
    surface.test = Test::surface;
    add(surface, {"delta", "all horizons and spacings"}, everywhere);
  }

  const SchemeEntry& entry_;
  bool standing_, nonlocal_;
  Plane plane_;
  std::vector<Measurement>& all_;
};

void read_map(const Table& root, Study& study) {
  const Stepping time = read_problem(root, study);
  const Table map = root.sub_table("map");
  Plane plane{.first = 0, .delta = read_horizons(map), .N = read_levels(map), .h = {}};
  const std::vector<bool> sources = read_sources(map);
  require_four(map, "delta", plane.delta.size());
  require_four(map, "N", plane.N.size());
  for (const std::int64_t N : plane.N) plane.h.push_back(study.scene->period() / static_cast<double>(N));
  for (const SchemeEntry& entry : read_schemes(root, *study.scene)) {
    for (const bool nonlocal : sources) {
      const Plane errors = add_series(map, time, entry, nonlocal, plane, study);
      Limits(entry, study.scene->standing(), nonlocal, errors, study.measurements).add();
    }
  }
}

constexpr Key map_keys[] = {
    {"delta", "list of numbers", "horizons, 4 or more, small to large"},
    {"N", "list of numbers", "levels, 4 or more, coarse to fine"},
    {"sources", "list of \"local\", \"nonlocal\"", "the solutions that errors are against"},
};
constexpr TableKeys map_tables[] = {scene_table, scheme_table, time_table, source_table, {"[map]", map_keys}};

}  // namespace

const Kind map_kind{"map", "errors over the plane of horizon and spacing", map_tables, read_map};

}  // namespace acstudy
