#include "studies/reading/path_part.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/cases/study.hpp"
#include "studies/reading/shared_tables.hpp"

namespace acstudy {

namespace {

constexpr std::int64_t most_particles = 100'000'000;

}  // namespace

std::vector<std::int64_t> read_levels(const Table& table) {
  const toml::node& node = table.need("N", "N = [160, 320, 640, 1280]");
  const toml::array* const array = node.as_array();
  if (array == nullptr || array->empty()) {
    table.place(node).fail(fmt::format("N must be a list of particle numbers, not {}; write N = [160, 320, 640, 1280]",
                                       array == nullptr ? Table::described(node) : "an empty list"));
  }
  std::vector<std::int64_t> N;
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::int64_t>();
    if (!value)
      table.place(item).fail(fmt::format("N contains {}; every entry must be a whole number", Table::described(item)));
    if (*value < 3)
      table.place(item).fail(fmt::format("N = {}; a periodic interval needs at least 3 particles", *value));
    if (*value > most_particles) table.place(item).fail(fmt::format("N = {}; the most is {}", *value, most_particles));
    if (!N.empty() && *value <= N.back()) {
      table.place(item).fail(fmt::format("N = {} after {}; levels must go from coarse to fine", *value, N.back()));
    }
    N.push_back(*value);
  }
  return N;
}

Verdict read_expected(const Table& table, const toml::node& node) {
  std::vector<std::pair<std::string, Verdict>> words;
  for (int v = 0; v <= static_cast<int>(Verdict::inconclusive); ++v) {
    words.emplace_back(name_of(static_cast<Verdict>(v)), static_cast<Verdict>(v));
  }
  words.emplace_back(name_of(Verdict::stable), Verdict::stable);
  return table.choice<Verdict>("expect", node, words);
}

namespace {

/// start = "uniform", or { name = "jittered", smallest_gap = 0.01, seed = 1 }, { name = "clustered", ... }.
Start read_start(const Table& path, const toml::node& node) {
  static const toml::table no_table;
  const toml::table* const table = node.as_table();
  const Table inner(table != nullptr ? *table : no_table, "start", path.file());
  const char* const example = "{ name = \"jittered\", smallest_gap = 0.01, seed = 1 }";
  const toml::node& name = table != nullptr ? inner.need("name", example) : node;
  Start start{.kind = path.choice<Start::Kind>("start", name,
                                               {{"uniform", Start::Kind::uniform},
                                                {"jittered", Start::Kind::jittered},
                                                {"clustered", Start::Kind::clustered}})};
  switch (start.kind) {
    case Start::Kind::uniform:
      if (table != nullptr) inner.allow({"name"});
      return start;
    case Start::Kind::jittered:
      inner.allow(path_keys, "start");
      break;
    case Start::Kind::clustered:
      inner.allow({"name", "smallest_gap"});
      break;
  }
  if (table == nullptr) path.place(node).fail(fmt::format("this start needs its smallest gap; write {}", example));
  const toml::node& gap = inner.need("smallest_gap", example);
  start.smallest_gap = inner.number("smallest_gap", gap);
  if (!(start.smallest_gap > 0.0 && start.smallest_gap < 1.0)) {
    inner.place(gap).fail(
        fmt::format("smallest_gap = {}; in units of h it lies between 0 and 1: write {}", start.smallest_gap, example));
  }
  if (const toml::node* const seed = inner.find("seed")) {
    start.seed = static_cast<unsigned>(inner.whole("seed", *seed, 0, 1'000'000'000));
  }
  return start;
}

}  // namespace

namespace {

/// The source of a path and, where no solution is known, its reference.
void read_source(const Table& table, PathChoice& path, bool solved) {
  const toml::node* const reference = table.find("reference");
  if (solved) {
    if (reference != nullptr) {
      table.place(*reference)
          .fail("a reference goes with reference = \"finest\" under [scene]; u is known, so leave it out");
    }
    path.nonlocal_source = table.choice<bool>("source", table.need("source", "source = \"local\""),
                                              {{"local", false}, {"nonlocal", true}});
    return;
  }
  path.nonlocal_source = false;
  if (const toml::node* const source = table.find("source")) {
    if (table.choice<bool>("source", *source, {{"local", false}, {"nonlocal", true}})) {
      table.place(*source).fail(
          "source = \"nonlocal\" makes a known u solve the nonlocal model; here the source is the scene's f, so write "
          "\"local\" or leave it out");
    }
  }
  path.against_reference = true;
  if (reference != nullptr) {
    path.N.push_back(table.whole("reference", *reference, path.N.back() + 1, most_particles));
  } else if (path.N.size() == 1) {
    table.place(*table.find("N"))
        .fail(fmt::format("N = [{}]; the finest level is the reference, so nothing is left to judge: write more levels",
                          path.N.back()));
  }
}

}  // namespace

/// N = { from = 40, until = "decided", most = 10240 }: the levels that there may be.
std::vector<std::int64_t> read_doubled(const Table& path, const toml::table& levels) {
  const Table table(levels, "N", path.file());
  table.allow(path_keys, "N");
  const auto particles = [&](std::string_view key, std::string_view example) {
    return table.whole(key, table.need(key, example), 3, most_particles);
  };
  const std::int64_t from = particles("from", "from = 40");
  table.choice<bool>("until", table.need("until", "until = \"decided\""), {{"decided", true}});
  const std::int64_t most = particles("most", "most = 10240");
  std::vector<std::int64_t> N;
  for (std::int64_t level = from; level <= most; level *= 2) N.push_back(level);
  if (N.size() < fewest_levels) {
    table.place(*table.find("most"))
        .fail(fmt::format("most = {}, which {} levels from {} on do not pass; an order takes {}: write most = {}", most,
                          N.size(), from, fewest_levels, from << (fewest_levels - 1)));
  }
  return N;
}

PathChoice read_path(const Table& table, const PathRules& rules) {
  const toml::node* const levels = table.find("N");
  const bool until_decided = rules.adds_levels && levels != nullptr && levels->is_table();
  if (until_decided && !rules.solved) {
    table.place(*levels).fail(
        "levels are added where u is known, as a reference has to be finer than all of them; write N = [160, 320, 640, "
        "1280]");
  }
  const toml::node& name = table.need("name", "name = \"delta = 4h\"");
  PathChoice path{.name = table.text("name", name, "name = \"delta = 4h\""),
                  .delta = rules.needs_delta || table.find("delta") != nullptr
                               ? table.expression("delta", "delta = \"4*h\"", {"h", "N"})
                               : Expression("h", {"h", "N"}),
                  .N = until_decided ? read_doubled(table, *levels->as_table()) : read_levels(table),
                  .until_decided = until_decided,
                  .nonlocal_source = false,
                  .expect = std::nullopt,
                  .order = std::nullopt};
  read_source(table, path, rules.solved);
  if (path.name.empty()) table.place(name).fail("a path needs a name, for example \"delta = 4h\"");
  constexpr std::size_t most_letters = 200;  // it stands in tables, figures and names of checks
  if (path.name.size() > most_letters) {
    table.place(name).fail(fmt::format("name = {}; a path may have at most {} letters: write a shorter one",
                                       in_quotes(path.name), most_letters));
  }
  if (const toml::node* const expect = table.find("expect")) {
    path.expect = read_expected(table, *expect);
  }
  if (const toml::node* const start = table.find("start")) {
    path.start = read_start(table, *start);
    path.at_start = table.place(*start);
  }
  if (const toml::node* const order = table.find("order")) {
    path.order = table.number("order", *order);
    if (*path.order < 0.0) {
      table.place(*order).fail(fmt::format("order = {}; an order must be finite and not negative", *path.order));
    }
  }
  return path;
}

}  // namespace acstudy
