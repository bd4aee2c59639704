#include "solver/rate_matrix.hpp"

#include <algorithm>

namespace acstudy {

BandedMatrix::BandedMatrix(const RateMatrix& R, int lanes_) : lanes(lanes_) {
  const auto n = static_cast<std::ptrdiff_t>(R.size());
  // A column to the left of its row by less than half a turn, or to the right.
  const auto offset_of = [&](std::ptrdiff_t row, std::ptrdiff_t entry) {
    const std::ptrdiff_t offset = R.column[entry] - row;
    return 2 * offset > n ? offset - n : 2 * offset < -n ? offset + n : offset;
  };
  for (std::ptrdiff_t row = 0; row < n; row += lanes) {
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(row + lanes, n);
    std::ptrdiff_t first = 0, last = 0;
    for (std::ptrdiff_t j = row; j < end; ++j) {
      for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) {
        first = std::min(first, offset_of(j, e));
        last = std::max(last, offset_of(j, e));
      }
    }
    const Block block{std::ssize(value), first, last - first + 1};
    value.resize(value.size() + block.width * lanes);
    for (std::ptrdiff_t j = row; j < end; ++j) {
      for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) {
        value[block.begin + (offset_of(j, e) - first) * lanes + (j - row)] += R.value[e];
      }
    }
    blocks.push_back(block);
    reach = std::max({reach, -first, last + lanes});
  }
}

}  // namespace acstudy
