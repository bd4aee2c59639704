#include "mms/points.hpp"

#include <fmt/format.h>

namespace acstudy {

std::string place_of(const Points& points, std::size_t i) {
  std::string place;
  for (std::size_t k = 0; k < points.dimension(); ++k) {
    place += fmt::format("{}{} = {:.6g}", k == 0 ? "" : ", ", coordinate_names[k], points[k][i]);
  }
  return place;
}

}  // namespace acstudy
