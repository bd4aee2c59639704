#pragma once

/// @file
/// A scene: what is solved, free of any discretization.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mms/expression.hpp"
#include "mms/points.hpp"

namespace acstudy {

/// A scene as text; also how named scenes are written down.
///
/// Beyond a line, of `dimension` 1, fields are of x and y, or x, y and z; and period, c, b and flow, which have a
/// component for each coordinate, are written with commas between them: "sin(y), -sin(x)".
struct SceneText {
  std::string name;                    ///< empty for a scene given inline
  std::string period, T;               ///< constants, "2*pi"
  std::string c;                       ///< advection velocity c(x)
  std::optional<std::string> b;        ///< particle velocity b(x); absent: particles stand still
  std::string u;                       ///< exact solution u(x, t); empty where none is known, and u0 is given
  std::optional<std::string> flow;     ///< position at time t of the particle that starts at x; absent: integrated
  std::optional<std::string> u0 = {};  ///< initial values u0(x), where no solution is known
  std::optional<std::string> f = {};   ///< source f(x, t), where no solution is known; absent: none
  std::size_t dimension = 1;

  /// What is known of the solution as text, equal exactly where that is equal: u, or u0 and f.
  std::string solution() const;
};

/// A scene that is not sound; `field` is the member of SceneText at fault, `position` an offset within its text.
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string member, std::size_t at, const std::string& message)
      : std::runtime_error(message), field(std::move(member)), position(at) {}
  std::string field;
  std::size_t position;
};

/// Fields, their derivatives and the flow on a periodic line, or a periodic box. Immutable; shared between threads.
///
/// What is called c' and b' on a line is div c and div b in a box, u_x the gradient of u. Models ParticleVelocity: `c`,
/// `b`, `b_prime` fill whole arrays.
class Scene {
 public:
  /// Compiles the texts and checks what they promise: finite values, period positive, T not negative, fields periodic,
  /// the flow a solution of x' = b(x) that starts at x, from 0 to T.
  /// @pre  either u is given or u0 is; 1 <= dimension <= most_dimensions
  /// @throws SceneError
  explicit Scene(SceneText text);

  const SceneText& text() const { return text_; }
  std::size_t dimension() const { return text_.dimension; }
  /// Of each coordinate.
  const std::vector<double>& periods() const { return periods_; }
  /// That of a line.  @pre dimension() == 1
  double period() const { return periods_.front(); }
  /// The product of the periods.
  double volume() const;
  double T() const { return T_; }
  /// True if b is absent or the constant zero: no particle ever moves.
  bool standing() const { return !b_; }

  void c(const Points& x, const Vectors& out, std::span<double> c_prime = {}) const {
    c_.evaluate(x, {}, {.value = out, .divergence = c_prime});
  }
  /// @pre !standing()
  void b(const Points& x, const Vectors& out, std::span<double> b_prime = {}) const {
    b_->evaluate(x, {}, {.value = out, .divergence = b_prime});
  }
  void b_prime(const Points& x, std::span<double> out) const { b_->evaluate(x, {}, {.divergence = out}); }

  /// True if the exact solution is known. If not, initial values are, and the source, if there is one.
  bool solved() const { return u_.has_value(); }
  /// Exact solution and, where the span is not empty, u_x and u_t.  @pre solved()
  void u(const Points& x, double t, std::span<double> u, const Vectors& u_x = {}, std::span<double> u_t = {}) const {
    u_->evaluate(x, {t}, {.value = u, .gradient = u_x, .by_parameter = u_t});
  }
  /// u at t = 0.
  void initial(const Points& x, std::span<double> out) const {
    solved() ? u(x, 0.0, out) : u0_->evaluate(x, {0.0}, {.value = out});
  }
  /// True if there is nothing on the right-hand side: no solution is known, and no source is given.
  bool sourceless() const { return !solved() && !f_; }
  /// The given source.  @pre !solved() && !sourceless()
  void f(const Points& x, double t, std::span<double> out) const { f_->evaluate(x, {t}, {.value = out}); }

  /// Largest |u| at x. Where u is not known: the most that initial values, source and compression leave of it,
  /// (max|u0| + t max|f|) exp(t max|c'|), from samples.
  double solution_size(const Points& x, double t) const;

  /// max |c - b| over the period, to round-off: the default of Model II's viscosity bound mu.  @pre dimension() == 1
  double max_relative_velocity() const;

  /// The flow in closed form, if the scene has one.
  const std::optional<Expression>& flow() const { return flow_; }

 private:
  void check_periodic(const char* field, const Expression& expression) const;
  void check_flow() const;

  SceneText text_;
  std::vector<double> periods_;
  double T_;
  Expression c_;
  std::optional<Expression> b_;
  std::optional<Expression> u_, u0_, f_;
  std::optional<Expression> flow_;
};

/// The particles' positions over time, x' = b(x): in closed form, or integrated to round-off.
class Trajectories {
 public:
  /// @param start  positions at t = 0; beyond a line one coordinate of all particles after the other, shape [d, N]
  /// @pre !scene.standing(); `scene` outlives the trajectories
  Trajectories(const Scene& scene, std::vector<double> start);

  /// Positions at time t, 0 <= t, as `start` has them. Times may go back and forth; unwrapped, so that on a line order
  /// is kept across the period.
  std::span<const double> at(double t);

  /// True if positions are known in closed form, each on its own.
  bool closed_form() const { return at_start_.has_value(); }
  /// Positions of the particles from number `begin` on, at time t.  @pre closed_form()
  void at(double t, std::size_t begin, const Vectors& x) const { scene_.flow()->evaluate(*at_start_, begin, {t}, x); }

 protected:
  const Scene& scene_;
  std::optional<Expression::FixedPoints> at_start_;  ///< of the flow in closed form

 private:
  std::vector<double> x_;  ///< at time t_, shape [d, N]
  double t_ = 0.0;
};

/// The scenes that a study can name.
const std::vector<SceneText>& named_scenes();

}  // namespace acstudy
