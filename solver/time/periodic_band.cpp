#include "solver/time/periodic_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace acstudy {

PeriodicBand::Seen PeriodicBand::start(std::ptrdiff_t count, double scale) {
  const auto n = static_cast<std::size_t>(count);
  const bool changed = left_.size() != n;
  for (auto* offsets : {&left_, &right_, &center_}) offsets->resize(n);
  diagonal_.resize(n);
  minus_scale_ = -scale;
  return {.changed = changed};
}

bool PeriodicBand::close(const Seen& seen) {
  if (std::isnan(seen.finite)) throw std::domain_error("the matrix of the implicit step is not finite");
  if (seen.changed) ++shape_;
  row_dominant_ = seen.dominant;
  widest_ = seen.widest;
  return size() >= 3 && 2 * widest_ < size();
}

bool PeriodicBand::assemble(const RateMatrix& R, double scale) {
  const auto n = static_cast<std::ptrdiff_t>(R.size());
  const auto offset_of = [&](std::ptrdiff_t row, std::ptrdiff_t entry) {
    const std::ptrdiff_t offset = R.column[entry] - row;
    return 2 * offset > n ? offset - n : 2 * offset < -n ? offset + n : offset;
  };
  Seen seen = start(n, scale);
  stride_ = 1;
  std::ptrdiff_t begin = 0;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    std::ptrdiff_t first = 0, last = 0;
    for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) {
      first = std::min(first, offset_of(j, e));
      last = std::max(last, offset_of(j, e));
    }
    const std::ptrdiff_t end = begin + last - first + 1;
    if (std::ssize(own_values_) < end) own_values_.resize(static_cast<std::size_t>(2 * end));
    center_[j] = begin - first;
    double* const row = own_values_.data() + center_[j];
    std::fill(row + first, row + last + 1, 0.0);
    for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) row[offset_of(j, e)] += R.value[e];
    double sizes = 0.0;
    for (std::ptrdiff_t k = first; k <= last; ++k) sizes += k == 0 ? 0.0 : std::abs(row[k]);
    set_row(seen, j, -first, last, 1.0 - scale * row[0], sizes);
    begin = end;
  }
  values_ = own_values_.data();
  return close(seen);
}

bool PeriodicBand::assemble(const BandedMatrix& R, std::span<const double> own, double scale) {
  const std::ptrdiff_t n = std::ssize(own), lanes = R.lanes;
  Seen seen = start(n, scale);
  values_ = R.value.data();
  stride_ = lanes;
  std::array<double, 8> sizes;  // no instruction set has more lanes
  for (std::ptrdiff_t j = 0; j < n; j += lanes) {
    const BandedMatrix::Block& block = R.blocks[j / lanes];
    sizes.fill(0.0);
    for (std::ptrdiff_t k = 0; k < block.width; ++k) {
      const double* const diagonal = values_ + block.begin + k * lanes;
      for (std::ptrdiff_t lane = 0; lane < lanes; ++lane) sizes[lane] += std::abs(diagonal[lane]);
    }
    for (std::ptrdiff_t lane = 0; lane < std::min(lanes, n - j); ++lane) {
      // A narrow row in a wide block is narrow.
      std::ptrdiff_t left = -block.first, right = block.first + block.width - 1;
      const double* const center = values_ + block.begin + left * lanes + lane;
      while (left > 0 && center[-left * lanes] == 0.0) --left;
      while (right > 0 && center[right * lanes] == 0.0) --right;
      center_[j + lane] = center - values_;
      set_row(seen, j + lane, left, right, 1.0 - scale * own[j + lane], sizes[lane]);
    }
  }
  return close(seen);
}

bool PeriodicBand::column_dominant() const {
  const std::ptrdiff_t n = size();
  std::vector<double> above = diagonal_;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    for (std::ptrdiff_t k = -left_[j]; k <= right_[j]; ++k) {
      const std::ptrdiff_t i = j + k;
      if (k != 0) above[i < 0 ? i + n : i >= n ? i - n : i] -= std::abs(beside(j, k));
    }
  }
  return std::all_of(above.begin(), above.end(), [](double value) { return value > 0.0; });
}

}  // namespace acstudy
