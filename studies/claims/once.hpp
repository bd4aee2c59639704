#pragma once

/// @file
/// What several findings are made of is computed once, by whichever of them asks first.

#include <memory>
#include <mutex>
#include <optional>

namespace acstudy {

/// A function that returns what `take` does and calls it once, from however many threads and copies it is asked.
template <class Take>
auto once(Take take) {
  using Taken = decltype(take());
  struct State {
    std::once_flag flag;
    std::optional<Taken> value;
  };
  return [take, state = std::make_shared<State>()]() -> const Taken& {
    std::call_once(state->flag, [&] { state->value.emplace(take()); });
    return *state->value;
  };
}

}  // namespace acstudy
