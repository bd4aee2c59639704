#include "studies/storing/case_h5.hpp"

#include <type_traits>
#include <utility>

#include "studies/storing/case_checksum.hpp"
#include "studies/storing/h5_columns.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

namespace {

/// The numbers of a result, or all else of it: the texts, and the fields at T.
template <bool numbers, class Result, class Visit>
void for_each(Result& result, Visit&& visit) {
  CaseResult::stored(result, [&]<class T>(const Stored& as, T& value) {
    if constexpr (std::is_arithmetic_v<T> == numbers) visit(as.column(), value);
  });
}

}  // namespace

void write_cases(hid_t group, const SeriesResult& result, const std::vector<std::size_t>& indices) {
  const Series& series = *result.series;
  using Entry = std::pair<const Case*, const CaseResult*>;
  std::vector<Entry> entries;
  for (const std::size_t i : indices) entries.emplace_back(&series.cases[i], &result.results[i]);
  const CaseResult nothing;
  h5::write_columns(group, entries, {&series.cases.front(), &nothing}, [&](const Entry& entry, auto&& visit) {
    const auto& [c, r] = entry;
    c->stored([&](const Stored& as, const auto& value) { visit(as.column(), value); });
    visit("variable", series.variable(c->h, c->delta));
    for_each<true>(*r, visit);
  });

  std::vector<std::string> keys;
  std::vector<std::int64_t> numbers, times;
  const h5::Handle cases = h5::create_group(group, "cases");
  for (const auto& [c, r] : entries) {
    const h5::Handle one = h5::create_group(cases, std::to_string(c->N));
    keys.push_back(storage_key(*c));
    const CaseChecksum sum = case_checksum(keys.back(), *r, !series.against_reference);
    numbers.push_back(sum.numbers);
    times.push_back(sum.times);
    for_each<false>(*r, [&](const std::string& name, const auto& value) {
      if (value.empty()) return;
      // What a reference gives is found anew, so that it has a name that is not read back.
      h5::write(one, series.against_reference && name == "u_exact" ? "u_reference" : name, value);
    });
  }
  h5::write_text_column(group, "key", keys);
  h5::write_column<std::int64_t>(group, "checksum", numbers);
  h5::write_column<std::int64_t>(group, "seconds_checksum", times);
}

namespace {

/// The numbers of the cases of a group.
std::vector<CaseResult> read_numbers(hid_t group, std::size_t count) {
  std::vector<CaseResult> results(count);
  h5::read_columns(group, results, [](CaseResult& result, auto&& visit) { for_each<true>(result, visit); });
  return results;
}

}  // namespace

void read_cases(hid_t group, bool trusted, StoredCases& stored, std::vector<std::int64_t>& damaged) {
  const h5::Handle cases = h5::open_group(group, "cases");
  const auto N = h5::read_column<std::int64_t>(group, "N"), numbers = h5::read_column<std::int64_t>(group, "checksum"),
             times = h5::read_column<std::int64_t>(group, "seconds_checksum");
  const auto keys = h5::read_text_column(group, "key");
  std::vector<CaseResult> results = read_numbers(group, N.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    CaseResult& result = results[i];
    try {
      const h5::Handle one = h5::open_group(cases, std::to_string(N[i]));
      result.completed = true;
      for_each<false>(result, [&](const std::string& name, auto& value) { h5::read(one, name, value); });
      const CaseChecksum sum{numbers.at(i), times.at(i)};
      if (!trusted && case_checksum(keys.at(i), result, true) != sum) throw StoreError("it is damaged");
    } catch (const std::exception&) {
      if (trusted) throw;
      damaged.push_back(N[i]);
      continue;
    }
    stored.cases.insert_or_assign(keys.at(i), std::move(result));
  }
}

std::vector<CaseRecord> read_case_records(hid_t group) {
  const h5::Handle cases = h5::open_group(group, "cases");
  const auto N = h5::read_column<std::int64_t>(group, "N");
  const auto h = h5::read_column<double>(group, "h"), delta = h5::read_column<double>(group, "delta");
  std::vector<CaseResult> results = read_numbers(group, N.size());
  std::vector<CaseRecord> records;
  for (std::size_t i = 0; i < N.size(); ++i) {
    const h5::Handle one = h5::open_group(cases, std::to_string(N[i]));
    results[i].completed = true;
    h5::read(one, "blow_up", results[i].blow_up);
    h5::read(one, "failure", results[i].failure);
    records.push_back({.N = N[i], .h = h.at(i), .delta = delta.at(i), .result = std::move(results[i])});
  }
  return records;
}

}  // namespace acstudy
