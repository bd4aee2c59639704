#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "solver/line/particles.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"

using namespace acstudy;
using namespace acstudy::test;

TEST_CASE("windows are those of a search over all pairs") {
  for (const std::size_t N : {3u, 4u, 7u, 40u, 101u}) {
    for (const double period : {1.0, 2.0 * std::numbers::pi, 1e-3, 1e6}) {
      const auto x = irregular_positions(N, period, static_cast<unsigned>(N));
      const double h = period / static_cast<double>(N);
      for (const double delta : {1e-6 * h, 0.3 * h, h, 1.7 * h, 6.1 * h, 0.2 * period, 0.49 * period}) {
        if (delta >= 0.5 * period) continue;
        CAPTURE(N, period, delta);
        const Particles particles = placed(x, period, delta);
        std::size_t widest = 0;
        bool same = true;
        for (std::size_t j = 0; j < N; ++j) {
          const std::size_t left = neighbors(x, period, delta, j, -1).size();
          const std::size_t right = neighbors(x, period, delta, j, +1).size();
          same = same && particles.windows.right[j] == static_cast<int>(right) &&
                 particles.windows.left[j] == static_cast<int>(left);
          widest = std::max({widest, left, right});
        }
        CHECK(same);
        CHECK(particles.windows.widest == static_cast<int>(widest));
      }
    }
  }
}

TEST_CASE("i sees j exactly when j sees i, ties at the horizon included") {
  // Horizons that are distances of pairs, disturbed by less than the tolerance of a tie.
  constexpr std::size_t N = 37;
  constexpr double period = 2.0 * std::numbers::pi;
  const auto x = irregular_positions(N, period, 5);
  for (const std::size_t m : {2u, 5u, 11u}) {
    for (const double disturbance : {-1e-15, 0.0, 1e-15}) {
      const double delta = (x[m] - x[0]) * (1.0 + disturbance);
      const Particles particles = placed(x, period, delta);
      CAPTURE(m, disturbance);
      CHECK(particles.windows.right[0] == static_cast<int>(m));
      CHECK(particles.windows.left[m] == static_cast<int>(m));
      std::vector<int> seen_from_left(N, 0);
      for (std::size_t j = 0; j < N; ++j) {
        for (int k = 1; k <= particles.windows.right[j]; ++k) ++seen_from_left[(j + k) % N];
      }
      CHECK(seen_from_left == particles.windows.left);
    }
  }
}

TEST_CASE("delta = 4h on the uniform start sees four neighbors on each side") {
  for (const std::size_t N : {9u, 10u, 160u, 320u, 1001u, 2560u}) {
    for (const double period : {1.0, 2.0 * std::numbers::pi, 1.0 / 3.0, 1e5}) {
      CAPTURE(N, period);
      const double h = period / static_cast<double>(N);
      const Particles particles = placed(uniform_positions(N, period), period, 4.0 * h);
      CHECK(particles.windows.left == std::vector<int>(N, 4));
      CHECK(particles.windows.right == std::vector<int>(N, 4));
      // Beyond the tolerance of a tie the horizon decides again.
      CHECK(placed(uniform_positions(N, period), period, 4.0 * h * (1.0 - 1e-9)).windows.right ==
            std::vector<int>(N, 3));
    }
  }
}

TEST_CASE("the nearest neighbor is kept however small the horizon, (2.4)") {
  constexpr std::size_t N = 20;
  const Particles particles = placed(irregular_positions(N, 1.0, 3), 1.0, 1e-12);
  CHECK(particles.windows.left == std::vector<int>(N, 1));
  CHECK(particles.windows.right == std::vector<int>(N, 1));
  CHECK(particles.windows.widest == 1);
}

TEST_CASE("windows do not depend on where the interval begins") {
  constexpr std::size_t N = 30;
  const auto x = irregular_positions(N, 1.0, 8);
  const Windows here = placed(x, 1.0, 0.11).windows;
  for (std::size_t turn = 1; turn < N; turn += 7) {
    std::vector<double> turned;
    for (std::size_t j = 0; j < N; ++j) turned.push_back(j + turn < N ? x[j + turn] : x[j + turn - N] + 1.0);
    const Windows there = placed(turned, 1.0, 0.11).windows;
    for (std::size_t j = 0; j < N; ++j) {
      CAPTURE(turn, j);
      CHECK(there.left[j] == here.left[(j + turn) % N]);
      CHECK(there.right[j] == here.right[(j + turn) % N]);
    }
  }
}

TEST_CASE("placed positions are wrapped as far as the windows reach") {
  constexpr std::size_t N = 12;
  constexpr double period = 3.0;
  const auto x = irregular_positions(N, period, 1);
  const Particles particles = placed(x, period, 0.45 * period);
  REQUIRE(particles.windows.widest > 3);
  for (std::ptrdiff_t j = 1 - particles.windows.widest; j < std::ssize(particles.x) + particles.windows.widest; ++j) {
    CAPTURE(j);
    CHECK(particles.x[j - 1] < particles.x[j]);
  }
  CHECK(particles.x[-1] == x[N - 1] - period);
  CHECK(particles.x[N] == x[0] + period);
}

TEST_CASE("wrap makes the periodic images and touches nothing else") {
  PeriodicArray u = periodic({1.0, 2.0, 3.0, 4.0, 5.0});
  u.wrap(3, 10.0);
  const std::vector<double> expected = {3 - 10, 4 - 10, 5 - 10, 1, 2, 3, 4, 5, 11, 12, 13};
  for (std::ptrdiff_t j = -3; j < 8; ++j) {
    CAPTURE(j);
    CHECK(u[j] == expected[j + 3]);
    CHECK(*u.at(j) == u[j]);
  }
  u[0] = -7.0;
  u.wrap(5);
  CHECK(u[5] == -7.0);
  CHECK(u[9] == 5.0);
  CHECK(u[-5] == -7.0);
  CHECK(u[-1] == 5.0);
  CHECK(std::vector<double>(u.values().begin(), u.values().end()) == std::vector<double>{-7, 2, 3, 4, 5});
}

TEST_CASE("particles that cross are refused") {
  Particles particles(4, 1.0, 0.1);
  using Positions = std::vector<double>;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Positions sound = {-0.1, 0.2, 0.5, 0.8};
  CHECK_NOTHROW(particles.place(sound));
  for (const Positions& crossed :
       {Positions{0.0, 0.5, 0.2, 0.8}, Positions{0.0, 0.2, 0.2, 0.8}, Positions{0.0, 0.2, 0.5, 1.0},
        Positions{0.0, 0.2, 0.5, 1.3}, Positions{0.0, nan, 0.5, 0.8}, Positions{0.0, 0.2, 0.5, nan}}) {
    CAPTURE(crossed);
    CHECK_THROWS_AS(particles.place(crossed), std::domain_error);
    CHECK_THROWS_WITH(particles.place(crossed),
                      "particles have crossed: positions no longer increase within one period");
  }
}

TEST_CASE("particles without a sound interval or horizon are refused") {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(Particles(3, 1.0, 0.4999));
  CHECK_THROWS_WITH(Particles(2, 1.0, 0.1), "a periodic interval needs at least 3 particles");
  for (const double period : {0.0, -1.0, infinity, nan}) {
    CAPTURE(period);
    CHECK_THROWS_AS(Particles(10, period, 0.1), std::invalid_argument);
  }
  for (const double delta : {0.0, -0.1, 0.5, 0.7, infinity, nan}) {
    CAPTURE(delta);
    CHECK_THROWS_WITH(Particles(10, 1.0, delta), "the horizon must be positive and below half a period");
  }
}

TEST_CASE("a horizon of four spacings ties for every one of a million particles") {
  constexpr std::size_t N = 1'000'000;
  constexpr double period = 6.283185307179586;
  Windows windows;
  find_windows(uniform_positions(N, period), period, 4.0 * period / N, windows);
  CHECK(std::all_of(windows.right.begin(), windows.right.end(), [](int r) { return r == 4; }));
  CHECK(std::all_of(windows.left.begin(), windows.left.end(), [](int l) { return l == 4; }));
}
