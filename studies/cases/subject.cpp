#include "studies/cases/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/models/control_choice.hpp"
#include "studies/models/outside_program.hpp"

namespace acstudy {

std::vector<std::vector<double>> Subject::positions(std::int64_t N) const {
  std::vector<std::vector<double>> all;
  for (unsigned seed = 1; seed <= (arrangement == Arrangement::jittered ? seeds : 1); ++seed) {
    all.push_back(arrange(arrangement, *scene, static_cast<std::size_t>(N), seed));
  }
  return all;
}

std::vector<Coordinate> scheme_coordinates(const SchemeChoice& scheme, double mu, bool standing) {
  if (scheme.program != nullptr) {
    return {unspoken({"scheme", scheme.program->label}), unspoken({"command", scheme.program->command_line()})};
  }
  std::vector<Coordinate> all;
  if (scheme.model->beyond_paper) {
    all.emplace_back("scheme", scheme.model->label());
  } else {
    all.emplace_back("model", static_cast<double>(scheme.model->number), fmt::format("model {}", scheme.model->number));
  }
  all.emplace_back("kernel", scheme.kernel.label());
  if (!standing) all.emplace_back("divergence", scheme.nonlocal_divergence ? "nonlocal" : "local");
  if (scheme.model->viscous) all.emplace_back("mu", mu, fmt::format("mu = {}", mu));
  if (scheme.control != nullptr) all.emplace_back("control", std::string(scheme.control->name));
  for (Coordinate& one : all) one.spoken = false;
  return all;
}

Check Subject::check(std::string statement, std::string claim, const std::vector<Coordinate>& conditions,
                     std::string quantity, Test test) const {
  std::vector<Coordinate> coordinates = {{"arrangement", std::string(name_of(arrangement))}};
  coordinates.insert(coordinates.end(), conditions.begin(), conditions.end());
  const std::vector<Coordinate> of_scheme = scheme_coordinates(scheme, mu, scene->standing());
  coordinates.insert(coordinates.end(), of_scheme.begin(), of_scheme.end());
  const Verdict good = test == Test::order ? Verdict::confirmed : Verdict::holds;
  return {.statement = std::move(statement),
          .claim = std::move(claim),
          .subject = scheme_label(scheme, scene->standing()),
          .coordinates = std::move(coordinates),
          .quantity = std::move(quantity),
          .test = test,
          .variable = "h",
          .promised = good,
          .expected = good};
}

std::vector<double> Resolutions::deltas(std::int64_t count, double period) const {
  std::vector<double> all;
  const double h = period / static_cast<double>(count);
  for (const double ratio : ratios) all.push_back(ratio * h);
  all.insert(all.end(), horizons.begin(), horizons.end());
  std::erase_if(all, [&](double delta) { return delta >= 0.5 * period; });
  return all;
}

}  // namespace acstudy
