#include "studies/cases/subject.hpp"

#include <algorithm>
#include <cmath>

namespace acstudy {

std::vector<std::vector<double>> Subject::positions(std::int64_t N) const {
  std::vector<std::vector<double>> all;
  for (unsigned seed = 1; seed <= (arrangement == Arrangement::jittered ? seeds : 1); ++seed) {
    all.push_back(arrange(arrangement, *scene, static_cast<std::size_t>(N), seed));
  }
  return all;
}

Finding Subject::finding(std::string statement, std::string claim, std::string check, std::string quantity,
                         Test test) const {
  const Verdict good = test == Test::order ? Verdict::confirmed : Verdict::holds;
  return {.statement = std::move(statement),
          .claim = std::move(claim),
          .subject = scheme_label(scheme, scene->standing()),
          .check = std::string(name_of(arrangement)) + ", " + check,
          .quantity = std::move(quantity),
          .test = test,
          .variable = "h",
          .promised = good,
          .expected = good};
}

std::vector<double> Sweep::deltas(std::int64_t count, double period) const {
  std::vector<double> all;
  const double h = period / static_cast<double>(count);
  for (const double ratio : ratios) all.push_back(ratio * h);
  all.insert(all.end(), horizons.begin(), horizons.end());
  std::erase_if(all, [&](double delta) { return delta >= 0.5 * period; });
  return all;
}

}  // namespace acstudy
