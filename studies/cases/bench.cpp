#include "studies/cases/bench.hpp"

#include <algorithm>
#include <cmath>

namespace acstudy {

namespace {

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  const double middle = median(values);
  const double minimum = values.front();
  for (double& value : values) value = std::abs(value - middle);
  return {middle, minimum, median(values)};
}

double BenchCase::total_seconds() const {
  double total = 0.0;
  for (const Sample& sample : samples) total += sample.seconds;
  return total;
}

}  // namespace acstudy
