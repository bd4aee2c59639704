#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "studies/commands/fit/fit.hpp"
#include "studies/commands/fit/printed_number.hpp"
#include "tests/catch.hpp"

using namespace acstudy;

namespace {

std::vector<double> halves(const std::vector<std::string>& texts) {
  std::vector<PrintedNumber> numbers;
  for (const std::string& text : texts) numbers.push_back(read_number(text).value());
  return half_units(numbers);
}

void require_near(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, found[i], expected[i]);
    CHECK(std::abs(found[i] - expected[i]) <= 1e-9 * expected[i]);
  }
}

}  // namespace

TEST_CASE("numbers are read as C, Fortran and typesetters print them", "[fit]") {
  const std::pair<const char*, double> texts[] = {{"1.0D-01", 0.1},
                                                  {"1.5d+02", 150.0},
                                                  {"2.5-101", 2.5e-101},
                                                  {"+.5", 0.5},
                                                  {"5.", 5.0},
                                                  {"-8.81E-13", -8.81e-13},
                                                  {"1/16", 0.0625},
                                                  {"\xE2\x88\x92"
                                                   "2.5",
                                                   -2.5},
                                                  {"1Q3", 1000.0}};
  for (const auto& [text, value] : texts) {
    CAPTURE(text);
    CHECK(read_number(text).value().value == value);
  }
}

TEST_CASE("half a unit of the last printed digit", "[fit]") {
  require_near(halves({"8.81e-13", "3.50D-12", "1.00e-11"}), {0.5e-15, 0.5e-14, 0.5e-13});
  require_near(halves({"0.1234", "0.0312", "0.0078", "0.0020"}), {0.5e-4, 0.5e-4, 0.5e-4, 0.5e-4});
  require_near(halves({"250.0", "31.25", "nan", "0.0"}), {0.05, 0.005, 0.0, 0.0});
}

TEST_CASE("zeros that a program dropped are digits all the same", "[fit]") {
  require_near(halves({"1.57e-07", "4e-08", "1.01e-08"}), {0.5e-9, 0.5e-10, 0.5e-10});
  require_near(halves({"24500000.0", "881000.0", "31200.0", "1110.0"}), {0.5e5, 0.5e3, 0.5e2, 0.5e1});  // from Python
  require_near(halves({"1", "0.25", "0.0625"}), {0.5e-2, 0.5e-3, 0.5e-4});
}

TEST_CASE("whole numbers without a point are exact", "[fit]") {
  require_near(halves({"1", "10", "0"}), {0.0, 0.0, 0.0});
}

TEST_CASE("other units leave as many digits as there were", "[fit]") {
  for (const double unit : {1e-9, 1.0, 1e9}) {
    std::vector<std::string> texts;
    std::vector<double> expected;
    for (const auto& [error, half] :
         {std::pair{0.0546, 0.5e-4}, {8.81e-3, 0.5e-5}, {9.66e-4, 0.5e-6}, {1.1e-4, 0.5e-6}}) {
      char text[32];
      for (int digits = 1; digits < 18; ++digits) {  // as Python prints it
        std::snprintf(text, sizeof text, "%.*g", digits, error * unit);
        if (std::strtod(text, nullptr) == error * unit) break;
      }
      texts.emplace_back(text);
      expected.push_back(half * unit);
    }
    CAPTURE(unit, texts);
    require_near(halves(texts), expected);
  }
}

TEST_CASE("a level's least noise is that of rounding to its printed digits", "[fit]") {
  const auto file = std::filesystem::temp_directory_path() / ("acstudy-fit-" + std::to_string(getpid()) + ".csv");
  std::ofstream(file) << "h,error\n0.1,8.81e-13\n0.05,0\n0.025,0.012345678901234567\n";
  FitRequest request;
  request.file = file.string();
  const std::vector<Level> coarse = fit_table(request).columns.front().levels;
  std::ofstream(file) << "h,error\n0.1,8.81e-13\n0.05,0\n0.025,-2.20e-13\n";
  const std::vector<Level> levels = fit_table(request).columns.front().levels;
  std::filesystem::remove(file);
  CHECK(coarse[0].noise < 1e-14);
  CHECK(std::abs(levels[0].noise - 0.005 / 8.81 / std::sqrt(3.0)) < 1e-12);
  CHECK(levels[1].noise == 0.0);
  CHECK(std::abs(levels[2].noise - 0.005 / 2.20 / std::sqrt(3.0)) < 1e-12);
}
