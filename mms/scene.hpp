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
#include "mms/line/trigonometric.hpp"

namespace acstudy {

/// A scene as text; also how named scenes are written down.
struct SceneText {
  std::string name;                    ///< empty for a scene given inline
  std::string period, T;               ///< constants, "2*pi"
  std::string c;                       ///< advection velocity c(x)
  std::optional<std::string> b;        ///< particle velocity b(x); absent: particles stand still
  std::string u;                       ///< exact solution u(x, t); empty where none is known, and u0 is given
  std::optional<std::string> flow;     ///< position at time t of the particle that starts at x; absent: integrated
  std::optional<std::string> u0 = {};  ///< initial values u0(x), where no solution is known
  std::optional<std::string> f = {};   ///< source f(x, t), where no solution is known; absent: none

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

/// Fields, their derivatives and the flow on a periodic interval. Immutable; shared between threads.
///
/// Models ParticleVelocity: `c`, `b`, `b_prime` fill whole arrays.
class Scene {
 public:
  /// Compiles the texts and checks what they promise: finite values, period positive, T not negative, fields periodic,
  /// the flow a solution of x' = b(x) that starts at x, from 0 to T.
  /// @pre  either u is given or u0 is
  /// @throws SceneError
  explicit Scene(SceneText text);

  const SceneText& text() const { return text_; }
  double period() const { return period_; }
  double T() const { return T_; }
  /// True if b is absent or the constant zero: no particle ever moves.
  bool standing() const { return !b_; }

  void c(std::span<const double> x, std::span<double> out) const { c_.evaluate(x, {}, {out, {}, {}}); }
  void c(std::span<const double> x, std::span<double> out, std::span<double> c_prime) const {
    c_.evaluate(x, {}, {out, c_prime, {}});
  }
  /// @pre !standing()
  void b(std::span<const double> x, std::span<double> out) const { b_->evaluate(x, {}, {out, {}, {}}); }
  void b(std::span<const double> x, std::span<double> out, std::span<double> b_prime) const {
    b_->evaluate(x, {}, {out, b_prime, {}});
  }
  void b_prime(std::span<const double> x, std::span<double> out) const { b_->evaluate(x, {}, {{}, out, {}}); }

  /// True if the exact solution is known. If not, initial values are, and the source, if there is one.
  bool solved() const { return u_.has_value(); }
  /// Exact solution and, where the span is not empty, u_x and u_t.  @pre solved()
  void u(std::span<const double> x, double t, std::span<double> u, std::span<double> u_x = {},
         std::span<double> u_t = {}) const {
    u_->evaluate(x, {t}, {u, u_x, u_t});
  }
  /// u at t = 0.
  void initial(std::span<const double> x, std::span<double> out) const {
    solved() ? u(x, 0.0, out) : u0_->evaluate(x, {0.0}, {out, {}, {}});
  }
  /// True if there is nothing on the right-hand side: no solution is known, and no source is given.
  bool sourceless() const { return !solved() && !f_; }
  /// The given source.  @pre !solved() && !sourceless()
  void f(std::span<const double> x, double t, std::span<double> out) const { f_->evaluate(x, {t}, {out, {}, {}}); }

  /// Largest |u| at x. Where u is not known: the most that initial values, source and compression leave of it,
  /// (max|u0| + t max|f|) exp(t max|c'|), from samples.
  double solution_size(std::span<const double> x, double t) const;

  /// max |c - b| over the period, to round-off: the default of Model II's viscosity bound mu.
  double max_relative_velocity() const;

  /// The flow in closed form, if the scene has one.
  const std::optional<Expression>& flow() const { return flow_; }

 private:
  void check_periodic(const char* field, const Expression& expression) const;
  void check_flow() const;

  SceneText text_;
  double period_, T_;
  Expression c_;
  std::optional<Expression> b_;
  std::optional<Expression> u_, u0_, f_;
  std::optional<Expression> flow_;
};

/// The particles' positions over time, x' = b(x): in closed form, or integrated to round-off.
class Trajectories {
 public:
  /// @pre !scene.standing(); `scene` outlives the trajectories
  Trajectories(const Scene& scene, std::vector<double> start);

  /// Positions at time t, 0 <= t. Times may go back and forth; unwrapped, so that order is kept across the period.
  std::span<const double> at(double t);

  /// True if positions are known in closed form, each on its own.
  bool closed_form() const { return at_start_.has_value(); }
  /// True if positions are computed from their phases, x = period/pi atan2(p, q).
  bool by_phases() const { return angle_.has_value(); }
  /// Positions of the particles from number `begin` on, at time t.  @pre closed_form()
  void at(double t, std::size_t begin, std::span<double> x) const {
    scene_.flow()->evaluate(*at_start_, begin, {t}, x);
  }
  /// The same with their phases.
  void at(double t, std::size_t begin, std::span<double> x, const PhasesOut& phases) const;

 private:
  const Scene& scene_;
  std::vector<double> x_;                            ///< at time t_
  std::optional<Expression::FixedPoints> at_start_;  ///< of the flow in closed form
  std::optional<Expression::Angle> angle_;           ///< of a flow that is period/pi atan2(p, q)
  double t_ = 0.0;
};

/// The scenes that a study can name.
const std::vector<SceneText>& named_scenes();

}  // namespace acstudy
