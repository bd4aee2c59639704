#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solver/line/vector/moment_table.hpp"
#include "studies/models/kernel_choice.hpp"
#include "tests/catch.hpp"

using namespace acstudy;

namespace {

/// The largest relative error at many distances, those beside the bounds of pieces among them.
double largest_error(const MomentTable& table, const std::function<double(double)>& moment) {
  double largest = 0.0;
  for (const MomentTable::Piece& piece : table.pieces) {
    if (piece.begin == 0.0 && table.power < 0) continue;
    for (int i = 1; i <= 1000; ++i) {
      const double z = piece.begin + (piece.end - piece.begin) * i / 1000.0, exact = moment(z);
      largest = std::fmax(largest, std::abs(table.at(piece, z) - exact) / exact);
    }
  }
  return largest;
}

template <class Check>
void for_each_moment(const KernelChoice& choice, Check check) {
  std::visit(
      [&]<class K>(const K& kernel) {
        std::span<const double> corners = kernel.breaks();
        if constexpr (std::is_base_of_v<PiecewiseKernel, K>) corners = kernel.corners();
        check([&](double z) { return kernel.first_moment(z); }, corners);
        if constexpr (IntegrableKernel<K>) check([&](double z) { return kernel.mass(z); }, corners);
      },
      choice.kernel());
}

}  // namespace

TEST_CASE("a table has the moments of every kernel to some units in the last place", "[vector]") {
  std::vector<KernelChoice> kernels = {{"power", 1.99}, {"power", 1.5},  {"power", 0.5}, {"power", 0.4},
                                       {"power", 0.0},  {"power", -1.0}, {"power", -3.3}};
  for (const NamedKernel& row : named_kernels) {
    if (!row.parameter) kernels.push_back({std::string(row.name)});
  }
  kernels.push_back(KernelChoice::written({.text = "exp(-s)", .exponent = 0.7}));
  for (const KernelChoice& kernel : kernels) {
    INFO(kernel.label());
    for_each_moment(kernel, [](const std::function<double(double)>& moment, std::span<const double> corners) {
      const MomentTable table = moment_table(moment, corners);
      CHECK(largest_error(table, moment) < 1e-14);
      // Where it is no polynomial near 0, a function has to do no more than the nearest.
      if (table.power < 0) CHECK(table.pieces[0].end <= 0x1p-12);
    });
  }
  // Negative control: a piece less is noticed.
  const auto spline = [](double z) { return CubicSplineKernel{}.first_moment(z); };
  MomentTable table = moment_table(spline, std::vector{0.5});
  CHECK(table.pieces.size() == 2);
  table.pieces.pop_back();
  table.pieces[0].end = 1.0;
  CHECK(largest_error(table, spline) > 1e-3);
}

TEST_CASE("smooth kernels need few pieces, of as many terms as they have", "[vector]") {
  const auto pieces_of = [](const KernelChoice& kernel) {
    std::size_t most = 0;
    for_each_moment(kernel, [&](const std::function<double(double)>& moment, std::span<const double> corners) {
      most = std::max(most, moment_table(moment, corners).pieces.size());
    });
    return most;
  };
  for (const char* const name : {"wendland-c2", "wendland-c4", "wendland-c6", "constant", "hat"}) {
    CHECK(pieces_of({name}) == 1);
  }
  CHECK(pieces_of({"quintic-spline"}) == 3);
  CHECK(pieces_of({"gaussian"}) == 1);
  CHECK(pieces_of({"power", 1.5}) == 1);
  CHECK(pieces_of({"power", 1.4}) <= 26);
}
