#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <vector>

#include "solver/time/implicit.hpp"
#include "studies/claims/stability_map.hpp"
#include "studies/claims/step_operator.hpp"
#include "studies/models/control_choice.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/named_scene.hpp"

namespace acstudy {
namespace {

std::shared_ptr<const Scene> with_velocity(const std::string& c) {
  return std::make_shared<const Scene>(SceneText{
      .name = "", .period = "1", .T = "1", .c = c, .b = std::nullopt, .u = "sin(2*pi*x)", .flow = std::nullopt});
}

Subject subject(int model, KernelChoice kernel, Arrangement arrangement, std::shared_ptr<const Scene> scene,
                bool nonlocal = false) {
  const double mu = scene->max_relative_velocity();
  return {{.model = find_model(model),
           .nonlocal_divergence = nonlocal,
           .kernel = std::move(kernel),
           .mu = {},
           .control = {}},
          mu,
          std::move(scene),
          arrangement,
          1};
}

const KernelChoice inverse{"inverse"}, spline{"cubic-spline"}, steep{"power", 0.9}, singular{"power", 1.5};
const Integrator& backward_euler = integrators[3];
const Integrator& sdirk2 = integrators[4];

/// A placed scheme as the system that integrate() steps.
struct System {
  PlacedScheme& placed;
  void rate(double, PeriodicArray& u, std::span<double> du) const {
    const auto values = u.values();
    const std::vector<double> rates = placed.rate({values.begin(), values.end()});
    std::copy(rates.begin(), rates.end(), du.begin());
  }
  void solve(double, double scale, PeriodicArray& u) const {
    RateMatrix R;
    placed.scheme().rows()->matrix(R);
    ImplicitSolver solver;
    solver.factorize(R, scale);
    solver.solve(u.values());
  }
};

}  // namespace

TEST_CASE("the step operator is what integrate does to unit vectors", "[stability-map]") {
  for (const int model : {1, 2}) {
    const Subject one = subject(model, spline, Arrangement::moved, test::named_scene("lee-du-2019"), true);
    const std::vector<double> x = one.positions(20).front();
    PlacedScheme placed(one.scheme, *one.scene, one.mu, x, 0.9);
    const SparseMatrix R = sparse_rates(placed);
    for (const Integrator& integrator : integrators) {
      for (const double dt : {0.01, 0.4}) {
        const Eigen::MatrixXd S = step_operator(integrator, R, dt);
        double worst = 0.0;
        for (int i = 0; i < 20; ++i) {
          PeriodicArray u(20);
          u[i] = 1.0;
          integrate(integrator, u, EqualSteps(dt, 1), System{placed}, [](std::int64_t, TimeStep) { return true; });
          for (int j = 0; j < 20; ++j) worst = std::max(worst, std::abs(S(j, i) - u[j]));
        }
        CAPTURE(model, integrator.name, dt);
        CHECK(worst < 1e-12 * max_norm(S));
      }
    }
  }
}

TEST_CASE("a control's rates are found by probing", "[stability-map]") {
  Subject one = subject(2, spline, Arrangement::uniform, test::named_scene("constant-velocity"));
  one.scheme.control = find_control("SPH sum");
  PlacedScheme placed(one.scheme, *one.scene, one.mu, one.positions(20).front(), 0.13);
  const auto u = test::irregular_values(20, 4);
  const Eigen::VectorXd product = sparse_rates(placed) * Eigen::Map<const Eigen::VectorXd>(u.data(), 20);
  CHECK(test::relative_gap({product.begin(), product.end()}, placed.rate(u)) < 1e-12);
}

TEST_CASE("the spectral radius by the stability function is that of the step", "[stability-map]") {
  const Subject one = subject(2, steep, Arrangement::jittered, test::named_scene("standing-variable-velocity"));
  PlacedScheme placed(one.scheme, *one.scene, one.mu, one.positions(24).front(), 0.7);
  const SparseMatrix R = sparse_rates(placed);
  const Eigen::VectorXcd of_R = eigenvalues(Eigen::MatrixXd(R));
  for (const Integrator& integrator : integrators) {
    for (const double dt : {0.02, 0.3, 2.0}) {
      const double direct = eigenvalues(step_operator(integrator, R, dt)).cwiseAbs().maxCoeff();
      CAPTURE(integrator.name, dt);
      CHECK(spectral_radius(integrator, of_R, dt) == Approx(direct).epsilon(1e-9));
    }
  }
}

TEST_CASE("eigenvalues on uniform standing particles are the symbols of the sum", "[stability-map]") {
  constexpr int N = 30;
  const Subject one = subject(1, inverse, Arrangement::uniform, test::named_scene("constant-velocity"));
  PlacedScheme placed(one.scheme, *one.scene, 0.0, one.positions(N).front(), 4.5 / N);
  const Stencil stencil = placed.scheme().stencil(0);
  Eigen::VectorXcd symbols(N);
  for (int m = 0; m < N; ++m) {
    std::complex<double> symbol = 0.0;
    for (std::size_t k = 0; k < stencil.offset.size(); ++k) {
      symbol -= stencil.weight[k] *
                (1.0 - std::polar(1.0, 2.0 * std::numbers::pi * m * static_cast<double>(stencil.offset[k]) / N));
    }
    symbols[m] = symbol;
  }
  const Eigen::VectorXcd of_R = eigenvalues(Eigen::MatrixXd(sparse_rates(placed)));
  for (const std::complex<double> symbol : symbols) {
    CHECK((of_R.array() - symbol).abs().minCoeff() < 1e-10);
  }
}

TEST_CASE("growth is the norm of the power of a step", "[stability-map]") {
  Eigen::MatrixXd S(2, 2);
  S << 0.5, 1.0, -0.25, 0.75;
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(2, 2);
  for (int n = 0; n <= 13; ++n) {
    CHECK(norm_of_power(S, n) == Approx(max_norm(power)).epsilon(1e-13));
    power = (S * power).eval();
  }
  CHECK(norm_of_power(10.0 * Eigen::MatrixXd::Identity(2, 2), 1'000'000) == largest_norm);
}

TEST_CASE("Lemma 2.4 is sharp row by row: bisection finds c dt sum W_k = 1 for every kernel and horizon",
          "[stability-map]") {
  const StabilityGrid grid{24, {0.01, 0.5, 1.0, 1.5, 2.7, 6.0, 10.0}, {}};
  for (const KernelChoice& kernel : {inverse, spline, singular, KernelChoice{"power", -1.0}}) {
    const Subject one = subject(1, kernel, Arrangement::uniform, test::named_scene("constant-velocity"));
    const Finding finding = sharp_limit(one, forward_euler, grid, Measure::norm).take();
    CAPTURE(kernel.label());
    CHECK(finding.judgement.verdict == Verdict::holds);
    for (const Point& point : finding.points) {
      // The weights of a uniform grid, from the point form of the moment.
      const double h = 1.0 / 24.0;
      const double sum = with_kernel(kernel, [&](const auto& k) {
        const int L = std::max(1, static_cast<int>(point.delta / h * (1.0 + 1e-11)));
        double total = 0.0, inner = 0.0;
        for (int m = 1; m <= L; ++m) {
          const double outer = m == L ? 1.0 : k.first_moment(m * h / point.delta);
          total += (outer - inner) / (m * h);
          inner = outer;
        }
        return total;
      });
      CHECK(point.value == Approx(1.0 / (h * sum)).epsilon(1e-6));
      CHECK(point.upper / point.lower < 1.0 + 3e-6);
    }
  }
}

TEST_CASE("Lemma 3.3: a step is monotone exactly under two conditions on signs", "[stability-map]") {
  const StabilityGrid grid{24, {0.5, 1.0, 2.5, 4.0, 8.0}, {}};
  for (const KernelChoice& kernel : {spline, steep, KernelChoice{"power", 0.0}}) {
    Subject one = subject(2, kernel, Arrangement::uniform, test::named_scene("constant-velocity"));
    CAPTURE(kernel.label());
    for (const double mu : {1.0, 1.7}) {
      one.mu = mu;
      const Finding finding = sharp_limit(one, forward_euler, grid, Measure::norm).take();
      CAPTURE(mu);
      CHECK(finding.judgement.verdict == Verdict::holds);
      for (const Point& point : finding.points) CHECK(point.value > 0.0);
    }
    // mu reach >= |c| |x_i - x_j| fails for a neighbor at the horizon, so that no step is monotone; at 2.5 h the
    // outermost neighbor is at 2 h, and 0.85 is enough.
    one.mu = 0.85;
    const Finding weak = sharp_limit(one, forward_euler, grid, Measure::norm).take();
    CHECK(weak.judgement.verdict == Verdict::holds);
    for (const Point& point : weak.points) {
      CAPTURE(point.variable);
      CHECK((point.value > 0.0) == (point.variable == 2.5));
    }
  }
}

TEST_CASE("a wrong limit is noticed", "[stability-map]") {
  Subject one = subject(1, inverse, Arrangement::uniform, test::named_scene("constant-velocity"));
  const StabilityGrid grid{24, {2.5}, {}};
  Finding finding = sharp_limit(one, forward_euler, grid, Measure::norm).take();
  for (const double factor : {1.0 - 3e-6, 1.0 + 3e-6}) {
    Finding shifted = finding;
    shifted.points[0].value *= factor;
    judge(shifted);
    CHECK(shifted.judgement.verdict == Verdict::violated);
  }
  // Of the SPH sum no step is stable.
  one = subject(2, spline, Arrangement::uniform, test::named_scene("constant-velocity"));
  one.scheme.control = find_control("SPH sum");
  for (const Measure measure : {Measure::norm, Measure::spectral}) {
    finding = sharp_limit(one, forward_euler, {24, {1.5, 4.0}, {}}, measure).take();
    CHECK(finding.judgement.verdict == Verdict::violated);
    for (const Point& point : finding.points) CHECK(point.value == 0.0);
  }
  CHECK(stability_map(one, forward_euler, {24, {2.5}, {0.5, 1.0}}, Measure::growth).take().judgement.verdict ==
        Verdict::violated);
}

TEST_CASE("implicit limits: none of backward Euler, 1 + sqrt(2) of SDIRK2", "[stability-map]") {
  const StabilityGrid grid{24, {0.5, 2.5, 6.0}, {}};
  for (const int model : {1, 2}) {
    const Subject one = subject(model, spline, Arrangement::jittered, test::named_scene("constant-velocity"));
    const Finding backward = sharp_limit(one, backward_euler, grid, Measure::norm).take();
    CHECK(backward.judgement.verdict == Verdict::holds);
    for (const Point& point : backward.points) CHECK(point.value == 1000.0);
    CHECK(sharp_limit(one, sdirk2, grid, Measure::norm).take().judgement.verdict == Verdict::holds);
    for (const Point& point : sharp_limit(one, sdirk2, grid, Measure::spectral).take().points)
      CHECK(point.value == 1000.0);
  }
  // Where the upwind difference is all of the scheme, SDIRK2's limit is that of its numerator, 1 + (1 - 2 gamma) z.
  const Subject upwind = subject(1, inverse, Arrangement::uniform, test::named_scene("constant-velocity"));
  const Finding second = sharp_limit(upwind, sdirk2, {200, {0.5}, {}}, Measure::norm).take();
  CHECK(second.points[0].value == Approx(1.0 + std::sqrt(2.0)).epsilon(1e-3));
}

TEST_CASE("of SDIRK3 nothing is promised, and no step is too long for it", "[stability-map]") {
  const Integrator& sdirk3 = integrators[5];
  CHECK(monotonicity_radius(sdirk3) == 0.0);
  // phi = a w + b w^2 + c w^3, w = 1/(1 - gamma z): the k-th derivative at 0 has the sign of a + b (k + 1) + c (k + 1)
  // (k + 2)/2. Three values give the three numbers.
  const auto w = [](double z) { return 1.0 / (1.0 - sdirk3_gamma * z); };
  Eigen::Matrix3d powers;
  Eigen::Vector3d phi;
  int row = 0;
  for (const double z : {-3.0, -1.0, 1.0}) {
    powers.row(row) << w(z), w(z) * w(z), w(z) * w(z) * w(z);
    phi[row++] = stability_function(sdirk3, z).real();
  }
  const Eigen::Vector3d coefficient = powers.partialPivLu().solve(phi);
  CHECK(coefficient.sum() == Approx(1.0));
  CHECK(coefficient[2] == Approx(-0.957).epsilon(1e-3));

  for (const int model : {1, 2}) {
    const Subject one = subject(model, spline, Arrangement::jittered, test::named_scene("constant-velocity"));
    const Finding limit = sharp_limit(one, sdirk3, {24, {0.5, 2.5, 6.0}, {}}, Measure::spectral).take();
    for (const Point& point : limit.points) CHECK(point.value == 1000.0);
    CHECK(limit.promised == Verdict::inconclusive);
    CHECK(limit.as_expected());
    CHECK(stability_map(one, sdirk3, {24, {2.5}, {0.5, 4.0}}, Measure::norm).take().as_expected());
    CHECK(smallest_entry(one, sdirk3, {24, {2.5}, {0.5, 4.0}}).take().as_expected());
  }
}

TEST_CASE("values that theory does not bound are no evidence", "[stability-map]") {
  const Subject one = subject(1, inverse, Arrangement::uniform, test::named_scene("constant-velocity"));
  const Finding beyond = growth_curve(one, forward_euler, 32, 0.5, 2.0).take();
  CHECK(beyond.judgement.verdict == Verdict::inconclusive);
  CHECK(beyond.promised == Verdict::inconclusive);
  CHECK(beyond.as_expected());
  // A finding that promises something and bounds nothing departs.
  Finding empty = beyond;
  empty.promised = empty.expected = Verdict::holds;
  judge(empty);
  CHECK(!empty.as_expected());
}

TEST_CASE("positivity on moving particles goes by the sign of c - b", "[stability-map]") {
  const auto scene = std::make_shared<const Scene>(SceneText{
      .name = "", .period = "2*pi", .T = "1", .c = "2", .b = "sin(x)/4", .u = "sin(x)", .flow = std::nullopt});
  for (const bool nonlocal : {false, true}) {
    const Subject one = subject(1, spline, Arrangement::uniform, scene, nonlocal);
    const Finding backward = smallest_entry(one, backward_euler, {32, {0.5, 2.5}, {1.0, 20.0, 1000.0}}).take();
    CHECK(backward.expected == Verdict::holds);
    CHECK(backward.judgement.verdict == Verdict::holds);
    CHECK(std::isfinite(backward.points[1].lower));
    CHECK(std::isinf(backward.points[2].lower));  // dt ||b'|| > 1
    CHECK(smallest_entry(one, forward_euler, {32, {0.5}, {0.5}}).take().promised == Verdict::inconclusive);
  }
}

TEST_CASE("Lemma 3.3 as printed fails on jittered particles at a horizon of two spacings", "[stability-map]") {
  Subject one = subject(2, spline, Arrangement::jittered, test::named_scene("lee-du-2019"));
  one.seeds = 3;
  const Finding finding = sharp_limit(one, forward_euler, {48, {2.0}, {}}, Measure::norm).take();
  CHECK(finding.judgement.verdict == Verdict::holds);
  CHECK(finding.points[0].value < 0.98);
}

TEST_CASE("steps, growth and spectral radius keep their bounds on every arrangement", "[stability-map]") {
  const StabilityGrid grid{24, {0.5, 2.5, 6.0}, {0.5, 1.0, 2.0, 20.0}};
  for (const int model : {1, 2}) {
    for (const Arrangement arrangement : arrangements) {
      const Subject one = subject(model, spline, arrangement, test::named_scene("lee-du-2019"), true);
      for (const Integrator& integrator : integrators) {
        for (const Measure measure : {Measure::norm, Measure::spectral, Measure::growth}) {
          const Finding finding = stability_map(one, integrator, grid, measure).take();
          CAPTURE(finding.label(), finding.judgement.reason);
          const bool bounded = monotonicity_radius(integrator) > 0.0;
          CHECK(finding.judgement.verdict == (bounded ? Verdict::holds : Verdict::inconclusive));
          CHECK(finding.as_expected());
          CHECK(finding.points.size() == 12);
        }
      }
    }
  }
}

TEST_CASE("growth in time is bounded within the condition only", "[stability-map]") {
  const Subject moving = subject(1, inverse, Arrangement::uniform, test::named_scene("lee-du-2019"));
  const Finding within = growth_curve(moving, forward_euler, 32, 0.5, 0.9).take();
  CHECK(within.judgement.verdict == Verdict::holds);
  CHECK(std::isfinite(within.points.back().upper));
  CHECK(within.points.back().variable == 1.0);
  CHECK(std::isinf(growth_curve(moving, forward_euler, 32, 0.5, 16.0).take().points.back().upper));
  // At constant velocity the upwind difference grows like |2 CFL - 1|^n.
  const Subject standing = subject(1, inverse, Arrangement::uniform, test::named_scene("constant-velocity"));
  CHECK(growth_curve(standing, forward_euler, 32, 0.5, 1.0).take().points.back().value == Approx(1.0));
  const Finding beyond = growth_curve(standing, forward_euler, 32, 0.5, 2.0).take();
  CHECK(beyond.points.back().value == Approx(std::pow(3.0, static_cast<double>(beyond.points.size()))));
  CHECK(std::isinf(beyond.points.back().upper));
}

TEST_CASE("backward Euler keeps positive what is positive at any step while velocities keep their sign",
          "[stability-map]") {
  const StabilityGrid grid{32, {0.5, 1.0, 2.5, 6.0}, {0.5, 3.0, 100.0, 1e6}};
  for (const char* const c : {"1", "-1", "1 + 0.9*sin(2*pi*x)"}) {
    for (const KernelChoice& kernel : {inverse, spline, singular}) {
      for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
        const Finding finding =
            smallest_entry(subject(1, kernel, arrangement, with_velocity(c)), backward_euler, grid).take();
        CAPTURE(c, finding.judgement.reason);
        CHECK(finding.expected == Verdict::holds);
        CHECK(finding.judgement.verdict == Verdict::holds);
      }
    }
  }
  // Model II: an M-matrix at any step where c is constant.
  const Finding second =
      smallest_entry(subject(2, spline, Arrangement::jittered, with_velocity("1")), backward_euler, grid).take();
  CHECK(second.judgement.verdict == Verdict::holds);
  for (const Point& point : second.points) CHECK(std::isfinite(point.lower));
  // Where c changes its sign, Model I has negative entries at any step.
  for (const Integrator* const integrator : {&forward_euler, &backward_euler}) {
    const Finding finding = smallest_entry(subject(1, spline, Arrangement::uniform, with_velocity("sin(2*pi*x)")),
                                           *integrator, {32, {2.5}, {1e-3, 0.1}})
                                .take();
    CHECK(finding.expected == Verdict::violated);
    CHECK(finding.judgement.verdict == Verdict::violated);
    for (const Point& point : finding.points) CHECK(point.value < -1e-6);
  }
  // SDIRK2 does not keep it at any step.
  const Finding third =
      smallest_entry(subject(1, inverse, Arrangement::uniform, with_velocity("1")), sdirk2, {32, {0.5}, {2.0, 4.0}})
          .take();
  CHECK(third.judgement.verdict == Verdict::holds);
  CHECK(third.points[0].value > -1e-12);
  CHECK(third.points[1].value < -1e-3);
}

}  // namespace acstudy
