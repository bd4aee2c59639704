#include "studies/storing/case_h5.hpp"

#include "studies/storing/h5_columns.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

namespace {

/// Visits the scalar results of a case with the names of their columns.
template <class Result, class Visit>
void for_each_column(Result& result, Visit&& visit) {
  visit("error_linf", result.error_linf);
  visit("solution_linf", result.solution_linf);
  visit("error_l1", result.error_l1);
  visit("error_l2", result.error_l2);
  visit("seconds", result.seconds);
  visit("seconds_low", result.seconds_low);
  visit("seconds_high", result.seconds_high);
  visit("positions_seconds", result.positions_seconds);
  visit("weights_seconds", result.weights_seconds);
  visit("pairs_seconds", result.pairs_seconds);
  visit("source_seconds", result.source_seconds);
  visit("repeats", result.repeats);
  visit("work_pairs", result.work.pairs);
  visit("work_weight_builds", result.work.weight_builds);
  visit("work_quadrature_points", result.quadrature_points);
  visit("work_velocity_evaluations", result.work.velocity_evaluations);
  visit("work_flow_evaluations", result.flow_evaluations);
  visit("steps", result.steps);
  visit("dt", result.dt);
  visit("dt_smallest", result.dt_smallest);
  visit("bound_largest", result.against_bound.largest);
  visit("bound_first_step", result.against_bound.first_step);
  visit("bound_first_time", result.against_bound.first_time);
  visit("bound_first_place", result.against_bound.first_place);
  visit("last_step", result.last.step);
  visit("last_time", result.last.time);
  visit("last_particle", result.last.particle);
  visit("last_place", result.last.place);
  visit("last_error_linf", result.last.error_linf);
  visit("last_error_l1", result.last.error_l1);
  visit("last_error_l2", result.last.error_l2);
}

void write_texts_and_fields(hid_t group, const std::string& key, const CaseResult& r, bool against_reference = false) {
  h5::write_text(group, "key", key);
  h5::write_text(group, "blow_up", r.blow_up);
  h5::write_text(group, "failure", r.failure);
  h5::write_column<double>(group, "x", r.x);
  h5::write_column<double>(group, "u", r.u);
  if (!against_reference) {
    h5::write_column<double>(group, "u_exact", r.u_exact);
  } else if (!r.u_exact.empty()) {
    h5::write_column<double>(group, "u_reference", r.u_exact);
  }
}

void read_texts_and_fields(hid_t group, CaseResult& r) {
  r.completed = true;
  r.blow_up = h5::read_text(group, "blow_up");
  r.failure = h5::read_text(group, "failure");
  r.x = h5::read_column<double>(group, "x");
  r.u = h5::read_column<double>(group, "u");
  // What a reference gives is found anew.
  if (H5Lexists(group, "u_exact", H5P_DEFAULT) > 0) r.u_exact = h5::read_column<double>(group, "u_exact");
}

}  // namespace

void write_case(hid_t parent, const std::string& group_name, const std::string& key, const CaseResult& result) {
  const h5::Handle group = h5::create_group(parent, group_name);
  write_texts_and_fields(group, key, result);
  for_each_column(result, [&](const char* name, auto value) { h5::write_number(group, name, value); });
}

CaseResult read_case(hid_t group) {
  CaseResult result;
  read_texts_and_fields(group, result);
  for_each_column(result, [&]<class T>(const char* name, T& value) { value = h5::read_number<T>(group, name); });
  return result;
}

void write_cases(hid_t group, const SeriesResult& result, const std::vector<std::size_t>& indices) {
  const Series& series = *result.series;
  struct Entry {
    const Case* c;
    const CaseResult* result;
  };
  std::vector<Entry> entries;
  for (const std::size_t i : indices) entries.push_back({&series.cases[i], &result.results[i]});
  const CaseResult nothing;
  h5::write_columns(group, entries, {&series.cases.front(), &nothing}, [&](const Entry& entry, auto&& visit) {
    visit("N", entry.c->N);
    visit("h", entry.c->h);
    visit("delta", entry.c->delta);
    visit("variable", series.variable(entry.c->h, entry.c->delta));
    for_each_column(*entry.result, visit);
  });
  const h5::Handle cases = h5::create_group(group, "cases");
  for (const std::size_t i : indices) {
    const h5::Handle one = h5::create_group(cases, std::to_string(series.cases[i].N));
    write_texts_and_fields(one, storage_key(series.cases[i]), result.results[i], series.against_reference);
  }
}

void read_cases(hid_t group, StoredCases& stored) {
  const h5::Handle cases = h5::open_group(group, "cases");
  const auto N = h5::read_column<std::int64_t>(group, "N");
  std::vector<CaseResult> results(N.size());
  h5::read_columns(group, results, [](CaseResult& r, auto&& visit) { for_each_column(r, visit); });
  for (std::size_t i = 0; i < results.size(); ++i) {
    const h5::Handle one = h5::open_group(cases, std::to_string(N[i]));
    read_texts_and_fields(one, results[i]);
    stored.cases[h5::read_text(one, "key")] = std::move(results[i]);
  }
}

}  // namespace acstudy
