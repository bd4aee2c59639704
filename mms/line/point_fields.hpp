#pragma once

/// @file
/// The fields of a scene at single points of a line, and their divided differences.

#include <functional>

#include "mms/scene.hpp"

namespace acstudy {

/// A field and its derivative at a point.
struct PointValue {
  double value = 0.0, slope = 0.0;
};

/// The fields of a scene at single points, at the time t.
class PointFields {
 public:
  PointFields(const Scene& scene, double t) : scene_(scene), t_(t) {}
  PointValue u(double y) const {
    PointValue p;
    scene_.u({&y, 1}, t_, {&p.value, 1}, {&p.slope, 1});
    return p;
  }
  PointValue b(double y) const {
    PointValue p;
    if (!scene_.standing()) scene_.b({&y, 1}, {&p.value, 1}, {&p.slope, 1});
    return p;
  }
  PointValue c_hat(double y) const {
    PointValue p;
    scene_.c({&y, 1}, {&p.value, 1}, {&p.slope, 1});
    const PointValue particle = b(y);
    return {p.value - particle.value, p.slope - particle.slope};
  }
  /// A gap below which a divided difference is taken as the average of the slope.
  double small() const { return 1e-3 * scene_.period(); }

 private:
  const Scene& scene_;
  double t_;
};

using PointFunction = std::function<PointValue(double)>;

/// (g(right) - g(left)) / (right - left) without cancellation: below `small` the average of g' by a Gauss rule, which
/// is exact to round-off for waves down to the length `small`.
double divided_difference(const PointFunction& g, double left, double right, double small);

}  // namespace acstudy
