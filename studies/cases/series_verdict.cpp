#include "studies/cases/series_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/cases/study_result.hpp"
#include "studies/cases/subject.hpp"

namespace acstudy {

Check series_check(const Series& series, double mu, bool standing, std::size_t number) {
  const Theory& theory = series.theory;
  const std::size_t colon = theory.statement.find(": ");
  Check check{
      .statement = theory.statement.substr(0, colon),
      .claim = theory.order > 0.0           ? fmt::format("order {:g} in {}", theory.order, theory.variable)
               : colon == std::string::npos ? "the error does not vanish"
                                            : "the error does not vanish: " + theory.statement.substr(colon + 2),
      .subject = scheme_label(series.scheme, standing),
      .coordinates = {{"path", series.path}},
      .quantity = series.against_reference ? "max-norm difference to the reference at T" : "max-norm error at T",
      .test = Test::order,
      .variable = theory.variable,
      .theory_order = theory.order,
      .promised = theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed,
      .expected = series.expected,
      .also_expected = {},
      .known = {},
      .series = number};
  if (meets(check.expected, check.promised)) check.promised = check.expected;
  if (series.expected == Verdict::stable || series.expected == Verdict::unstable) {
    // No order is asked for: nothing of the theorems is tested.
    check.statement = "Stiff scenes";
    check.claim = "the solution stays bounded";
    check.promised = Verdict::stable;
  }
  if (!series.stepping.empty()) check.coordinates.emplace_back("stepping", series.stepping);
  check.coordinates.push_back(unspoken({"delta", series.delta_text}));
  check.coordinates.push_back(unspoken({"source", series.nonlocal_source ? "nonlocal" : "local"}));
  for (Coordinate& one : scheme_coordinates(series.scheme, mu, standing)) check.coordinates.push_back(std::move(one));
  return check;
}

Measurement series_verdict(const Series& series, std::size_t number) {
  const Case& first = series.cases.front();
  return {series_check(series, first.mu, first.scene->standing(), number),
          [number](Finding& finding, const std::vector<SeriesResult>& all) {
            const Series& planned = *all[number].series;
            const std::vector<CaseResult>& results = all[number].results;
            finding.cases = {.planned = results.size(),
                             .run = all[number].completed().size(),
                             .against_reference = planned.against_reference};
            if (all[number].reference() != nullptr) finding.cases->reference = planned.reference_level();
            for (std::size_t i = 0; i < results.size(); ++i) {
              if (finding.failure.empty()) finding.failure = results[i].failure;
              if (finding.cases->blow_up.empty()) finding.cases->blow_up = results[i].blow_up;
              if (i == planned.levels() || !results[i].completed) continue;
              const Case& c = planned.cases[i];
              add_level(finding, {c.N, c.h, c.delta, planned.variable(c.h, c.delta), results[i].error_linf},
                        results[i].solution_linf);
            }
          }};
}

void add_level(Finding& finding, Point point, double solution) {
  if (finding.expected == Verdict::stable) point.upper = largest_stable_error * solution;
  finding.points.push_back(point);
  if (std::isfinite(solution) && solution > finding.known.scale.value_or(0.0)) finding.known.scale = solution;
}

bool is_decided(const Finding& finding) {
  const Verdict verdict = finding.judgement.verdict;
  return !finding.failure.empty() || (verdict != Verdict::inconclusive && verdict != Verdict::pre_asymptotic);
}

void judge_series(Finding& finding) {
  std::vector<Level> levels;
  for (const Point& point : finding.points) levels.push_back({point.variable, point.value});
  const SeriesCases& cases = *finding.cases;
  Judgement& judgement = finding.judgement;
  judgement = judge_errors(levels, cases.reference, finding.theory_order, finding.known);
  if (!finding.failure.empty()) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = "a case could not be computed: " + finding.failure;
  } else if (cases.against_reference && !cases.reference) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = "the reference has not been run";
  } else if (!cases.blow_up.empty()) {
    judgement.reason += ": " + cases.blow_up;
  }
  for (const Point& point : finding.points) {
    if (judgement.verdict == Verdict::unstable || !(point.value > point.upper)) continue;
    judgement.verdict = Verdict::unstable;
    judgement.reason = fmt::format("an error is {:.3g}, that of a solution of {:.3g} at most", point.value,
                                   point.upper / largest_stable_error);
  }
}

namespace {

/// The errors that belong to these differences to a reference, if errors are of this order.
std::vector<Level> errors_for(double order, std::vector<Level> differences, double reference) {
  for (Level& level : differences) {
    if (order > 0.0 && reference < level.variable) level.error /= 1.0 - std::pow(reference / level.variable, order);
  }
  return differences;
}

constexpr const char* higher_orders =
    "; theorems are upper bounds: if that is right, write order = ... or expect = \"above\" on the path";

}  // namespace

Judgement judge_errors(const std::vector<Level>& levels, const std::optional<ReferenceLevel>& reference,
                       double theory_order, const JudgeOptions& options) {
  if (!reference) {
    Judgement judgement = judge(levels, theory_order, options);
    if (judgement.verdict == Verdict::above) judgement.reason += higher_orders;
    return judgement;
  }
  const auto judged_for = [&](double order) {
    return judge(errors_for(order, levels, reference->variable), theory_order, options);
  };
  double order = theory_order;
  Judgement judgement = judged_for(order);
  if (!meets(judgement.verdict, Verdict::confirmed) && std::isfinite(judgement.order)) {
    // Each round assumes the order that the last one has found. Their distance at least halves from round to round.
    constexpr int most = 60;
    constexpr double close = 1e-4;
    double assumed = order;
    Judgement found = judgement;
    for (int round = 0; round < most && found.order > 0.0 && std::abs(found.order - assumed) > close; ++round) {
      assumed = found.order;
      found = judged_for(assumed);
    }
    if (std::abs(found.order - assumed) <= close) {
      order = assumed;
      judgement = found;
      // The order found depends on the one assumed, which is as uncertain: this widens the interval.
      constexpr double shift = 0.01;
      const double follows = (judged_for(assumed + shift).order - found.order) / shift;
      const double wider = follows > 0.0 && follows < 1.0 ? 1.0 / (1.0 - follows) : 1.0;
      judgement.low = found.order - wider * (found.order - found.low);
      judgement.high = found.order + wider * (found.high - found.order);
    }
  }
  judgement.reason +=
      fmt::format("; differences to the run at N = {}, judged as those of errors of order {:.2f}", reference->N, order);
  return judgement;
}

}  // namespace acstudy
