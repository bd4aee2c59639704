// What is no scheme is refused where it is used, by the name of what it lacks. Compiled by ctest alone, once for each
// of the macros; with COMPLETE there is nothing to refuse.

#include "solver/line/scheme.hpp"

#include <span>

namespace {

struct Still {
  void place(const acstudy::Particles&, const auto&) {}
#ifndef WITHOUT_RATE
  void rate(acstudy::PeriodicArray&, std::span<double>) {}
#endif
  std::span<const double> weights(std::ptrdiff_t) const { return {}; }
#ifndef WITHOUT_SIDE
  bool looks_left(std::ptrdiff_t) const { return true; }
#endif
  acstudy::WorkCounts work() const { return {}; }
#ifndef WITHOUT_MATRIX
  void matrix(acstudy::RateMatrix&) const {}
#endif
  double strongest_decay() const { return 0.0; }
};

template <acstudy::Scheme S>
void use(S) {}

}  // namespace

int main() { use(Still{}); }
