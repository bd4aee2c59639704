#include <set>
#include <string>

#include "studies/models/control_choice.hpp"
#include "studies/models/model_card.hpp"
#include "tests/catch.hpp"

namespace acstudy {

TEST_CASE("every card is complete, and its number and name are its own", "[cards]") {
  std::set<int> numbers;
  std::set<std::string> names;
  for (const ModelCard* card : model_cards()) {
    INFO(card->name);
    CHECK(numbers.insert(card->number).second);
    CHECK(names.insert(card->label()).second);
    CHECK(find_model(card->number) == card);
    CHECK(card->make != nullptr);
    CHECK(card->step_lemma.speed != nullptr);
    if (card->beyond_paper) {
      CHECK(find_named_model(card->name, card->limiter) == card);
      CHECK(find_labeled_model(card->label()) == card);
      continue;
    }
    CHECK(card->continuum != nullptr);
    CHECK(card->printed_rate != nullptr);
    CHECK(card->nearest.row != nullptr);
    CHECK(card->pair_cost > 0.0);
    CHECK(card->row_terms > 0.0);
    CHECK(!card->estimates.empty());
    for (const LemmaEstimate& estimate : card->estimates) CHECK(estimate.constant != nullptr);
    for (const std::string_view text :
         {card->equations.standing, card->equations.local, card->equations.nonlocal, card->theorems.standing,
          card->theorems.local, card->theorems.nonlocal, card->step_lemma.name, card->step_lemma.row_by_row,
          card->step_lemma.limit, card->to_nonlocal, card->to_pde, card->weights.first_moment, card->nearest.claim}) {
      CHECK(!text.empty());
    }
  }
  CHECK(find_model(0) == nullptr);
  CHECK(find_named_model("Model I") == nullptr);
  CHECK(find_named_model("slopes", "none") == nullptr);
}

TEST_CASE("the mistakes that a card names are controls of its model", "[cards]") {
  for (const ModelCard* card : model_cards()) {
    const Mistakes& mistakes = card->mistakes;
    for (const std::string_view name : {mistakes.inconsistent, mistakes.not_monotone, mistakes.classical}) {
      if (name.empty()) continue;
      INFO(card->name << ", " << name);
      const Control* const control = find_control(name);
      REQUIRE(control != nullptr);
      CHECK(control->model == card);
    }
  }
  CHECK(find_control("no mistake") == nullptr);
}

}  // namespace acstudy
