#include "studies/claims/digits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

/// The positive numbers of a list, each at most `most`.
std::vector<double> read_positive(const Table& table, const std::string& key, const std::string& example, double most) {
  std::vector<double> values;
  for (const toml::node& item : table.list(key, example)) {
    const double value = values.emplace_back(table.number(key, item));
    if (!(value > 0.0 && value <= most)) {
      table.place(item).fail(fmt::format("{} contains {}; every entry must be positive and at most {:g}: write {}", key,
                                         value, most, example));
    }
  }
  return values;
}

void read_digits(const Table& root, Study& study) {
  const Table digits = root.sub_table("digits");
  // The particles of larger ratios would fill the memory.
  const std::vector<double> ratios = read_positive(digits, "ratios", "ratios = [1e-12, 0.5, 2.5, 100, 1e4]", 1e5);

  std::set<std::string> known;
  for (const Table& table : root.array_of_tables("weights")) {
    const ModelCard* const model = &read_model(table);
    if (model->beyond_paper) {
      table.place(*table.find("model"))
          .fail(fmt::format("only the weights of Models I and II are examined, not those of {}", model->name));
    }
    const WeightsChoice choice{model, read_kernel(table, *model)};
    if (!known.insert(fmt::format("{} {}", model->number, choice.kernel.label())).second) {
      table.place().fail("the same weights a second time; leave one of them out");
    }
    for (const CellForm form : {CellForm::factored, CellForm::difference}) {
      study.measurements.push_back(round_off_of_weights(choice, ratios, form));
    }
    if (model->renormalized) study.measurements.push_back(round_off_of_renormalization(choice, ratios));
  }

  const toml::node* const scene = root.find("scene");
  if (root.find("gaps") == nullptr) {
    if (scene != nullptr) root.place(*scene).fail("only [gaps] needs a scene; leave one out or add the other");
    return;
  }
  study.scene = read_scene(root.sub_table("scene"));
  const SceneText& text = study.scene->text();
  if (text.b != "sin(x)" || std::abs(study.scene->period() - 2.0 * std::numbers::pi) > 1e-15) {
    root.place(*scene).fail("the exact gaps are those of b = sin(x) on the period 2*pi; use the scene \"lee-du-2019\"");
  }
  const Table table = root.sub_table("gaps");
  const std::vector<double> times = read_positive(table, "times", "times = [1, 5, 8]", 30.0);
  const std::int64_t N = table.whole("N", table.need("N", "N = 1000"), 3, 1'000'000);
  study.measurements.push_back(round_off_of_gaps(study.scene, N, times));
}

constexpr Key weights_keys[] = {
    {"model", "whole number", "as in a [[scheme]]"},
    {"kernel", "a kernel", "as in a [[scheme]]"},
};
constexpr Key digits_keys[] = {
    {"ratios", "list of numbers", "delta/h, at most 1e5"},
};
constexpr Key gaps_keys[] = {
    {"N", "whole number", "particles"},
    {"times", "list of numbers", "when gaps are compared, at most 30"},
};
constexpr TableKeys digits_tables[] = {{"[[weights]]", weights_keys},
                                       {"[digits]", digits_keys},
                                       {"[scene]", scene_keys, true},
                                       {"[gaps]", gaps_keys, true}};

}  // namespace

const Kind digits_kind{"digits", "round-off of weights and renormalizations, against 50 digits", digits_tables,
                       read_digits};

}  // namespace acstudy
