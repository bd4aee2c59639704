#include "studies/models/model_card.hpp"

#include <algorithm>

namespace acstudy {

std::span<const ModelCard* const> model_cards() {
  static constexpr const ModelCard* cards[] = {&model_one, &model_two};
  return cards;
}

const ModelCard* find_model(std::int64_t number) {
  const auto cards = model_cards();
  const auto found = std::find_if(cards.begin(), cards.end(), [&](auto* card) { return card->number == number; });
  return found == cards.end() ? nullptr : *found;
}

}  // namespace acstudy
