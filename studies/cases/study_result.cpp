#include "studies/cases/study_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

std::vector<std::size_t> SeriesResult::completed() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].completed) indices.push_back(i);
  }
  return indices;
}

std::vector<std::size_t> SeriesResult::completed_levels() const {
  std::vector<std::size_t> indices = completed();
  if (reference() != nullptr) indices.pop_back();
  return indices;
}

const CaseResult* SeriesResult::reference() const {
  return series->against_reference && results.back().completed ? &results.back() : nullptr;
}

std::string not_computed(const std::string& failure) { return "a case could not be computed: " + failure; }

std::optional<double> solution_scale(std::span<const double> solutions) {
  double scale = 0.0;
  for (const double size : solutions) {
    if (std::isfinite(size)) scale = std::max(scale, size);
  }
  return scale > 0.0 ? std::optional(scale) : std::nullopt;
}

Judgement judge_series(const Series& series, const std::vector<CaseResult>& results) {
  std::vector<Level> levels;
  std::vector<double> solutions;
  for (std::size_t i = 0; i < series.levels(); ++i) {
    const Case& c = series.cases[i];
    if (!results[i].completed) continue;
    levels.push_back({series.variable(c.h, c.delta), results[i].error_linf});
    solutions.push_back(results[i].solution_linf);
  }
  Judgement judgement =
      judge_errors(levels, series.reference_level(), series.theory.order, {.scale = solution_scale(solutions)});
  const auto first_with = [&](std::string CaseResult::*text) {
    return std::find_if(results.begin(), results.end(), [&](const CaseResult& r) { return !(r.*text).empty(); });
  };
  if (const auto failed = first_with(&CaseResult::failure); failed != results.end()) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = not_computed(failed->failure);
  } else if (series.against_reference && !results.back().completed) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = "the reference has not been run";
  } else if (const auto unstable = first_with(&CaseResult::blow_up); unstable != results.end()) {
    judgement.reason += ": " + unstable->blow_up;
  }
  if (series.expected == Verdict::stable) {
    for (std::size_t i = 0; i < series.levels(); ++i) {
      require_bounded(judgement, results[i].error_linf, results[i].solution_linf);
    }
  }
  return judgement;
}

void require_bounded(Judgement& judgement, double error, double solution) {
  if (judgement.verdict == Verdict::unstable || !(error > largest_stable_error * solution)) return;
  judgement.verdict = Verdict::unstable;
  judgement.reason = fmt::format("an error is {:.3g}, that of a solution of {:.3g} at most", error, solution);
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
