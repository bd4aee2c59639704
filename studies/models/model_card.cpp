#include "studies/models/model_card.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "studies/models/scheme.hpp"

namespace acstudy {

namespace {

/// Also where models are added before main begins, it is there.
std::vector<const ModelCard*>& cards() {
  static std::vector<const ModelCard*> all = {&model_one, &model_two, &model_slopes, &model_clipped_slopes,
                                              &model_symmetric};
  return all;
}

template <class Predicate>
const ModelCard* find(Predicate&& predicate) {
  const auto found = std::find_if(cards().begin(), cards().end(), predicate);
  return found == cards().end() ? nullptr : *found;
}

}  // namespace

std::span<const ModelCard* const> model_cards() { return cards(); }

const ModelCard* find_model(std::int64_t number) {
  return find([&](const ModelCard* card) { return card->number == number; });
}

const ModelCard* find_named_model(std::string_view name, std::string_view limiter) {
  return find(
      [&](const ModelCard* card) { return card->beyond_paper && card->name == name && card->limiter == limiter; });
}

const ModelCard* find_labeled_model(std::string_view label) {
  return find([&](const ModelCard* card) { return card->beyond_paper && card->label() == label; });
}

void add_model(ModelCard& card) {
  constexpr int first_number = 100;
  if (card.name.empty()) throw std::logic_error("a scheme has no name; write .name = \"my-scheme\"");
  if (find_named_model(card.name) != nullptr) {
    throw std::logic_error("two schemes have the name " + std::string(card.name) + "; give one of them another");
  }
  card.number = first_number + static_cast<int>(cards().size());
  cards().push_back(&card);
}

}  // namespace acstudy
