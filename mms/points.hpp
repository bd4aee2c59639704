#pragma once

/// @file
/// Points of a line, a plane or space, and vectors at them: one array for each coordinate.

#include <array>
#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace acstudy {

inline constexpr std::size_t most_dimensions = 3;
/// The coordinates as expressions call them.
inline constexpr const char* coordinate_names[most_dimensions] = {"x", "y", "z"};

/// Views of arrays of one length, one for each coordinate. On a line that is one array, which becomes this implicitly.
template <class T>
class ByCoordinate {
 public:
  /// Nothing: what is not wanted.
  ByCoordinate() = default;
  template <class Array>
  requires std::is_convertible_v<Array&&, std::span<T>> ByCoordinate(Array&& line)
      : ByCoordinate({std::span<T>(line)}) {}
  ByCoordinate(T* line, std::size_t count) : ByCoordinate({std::span<T>(line, count)}) {}
  /// @pre at most `most_dimensions`, of one length
  ByCoordinate(std::initializer_list<std::span<T>> arrays) {
    for (const std::span<T> array : arrays) arrays_[dimension_++] = array;
  }
  /// One coordinate of all points after the other in `all`, shape [dimension, N].
  static ByCoordinate blocks(std::span<T> all, std::size_t dimension) {
    ByCoordinate result;
    const std::size_t count = all.size() / dimension;
    for (std::size_t i = 0; i < dimension; ++i) result.arrays_[result.dimension_++] = all.subspan(i * count, count);
    return result;
  }

  std::size_t dimension() const { return dimension_; }
  std::size_t size() const { return arrays_[0].size(); }
  bool empty() const { return arrays_[0].empty(); }
  std::span<T> operator[](std::size_t coordinate) const { return arrays_[coordinate]; }
  /// The array of what needs a line.  @pre dimension() == 1
  std::span<T> line() const {
    assert(dimension_ == 1);
    return arrays_[0];
  }

 private:
  std::array<std::span<T>, most_dimensions> arrays_;
  std::size_t dimension_ = 0;
};

using Points = ByCoordinate<const double>;
using Vectors = ByCoordinate<double>;

/// Where point i is, for messages: "x = 1, y = 2".
std::string place_of(const Points& points, std::size_t i);

/// Points that are kept, or vectors.
struct PointArray {
  std::vector<double> coordinates = {};  ///< one of all points after the other, shape [dimension, N]
  std::size_t dimension = 1;

  std::size_t size() const { return coordinates.size() / dimension; }
  bool empty() const { return coordinates.empty(); }
  double& operator()(std::size_t i, std::size_t coordinate) { return coordinates[coordinate * size() + i]; }
  operator Points() const { return Points::blocks(coordinates, dimension); }
  operator Vectors() { return Vectors::blocks(coordinates, dimension); }

  void resize(std::size_t count, std::size_t new_dimension) {
    dimension = new_dimension;
    coordinates.resize(dimension * count);
  }
  void assign(const Points& points) {
    dimension = points.dimension();
    coordinates.clear();
    for (std::size_t k = 0; k < dimension; ++k) {
      coordinates.insert(coordinates.end(), points[k].begin(), points[k].end());
    }
  }
};

}  // namespace acstudy
