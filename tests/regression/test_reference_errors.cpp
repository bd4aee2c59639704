#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "studies/kinds/study_file.hpp"
#include "studies/running/run_case.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinRel;

namespace {

struct Row {
  std::string model, kernel, divergence, delta, source, N, dt;
  double error;
};

std::vector<Row> read_rows() {
  std::ifstream in(std::filesystem::path(__FILE__).parent_path() / "reference_errors.csv");
  std::vector<Row> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    Row row;
    for (std::string* field : {&row.model, &row.kernel, &row.divergence, &row.delta, &row.source, &row.N, &row.dt}) {
      std::getline(fields, *field, ',');
    }
    fields >> row.error;
    rows.push_back(row);
  }
  return rows;
}

Case case_of(const Row& row) {
  const Study study =
      parse_study("[study]\nname = \"reference\"\n[scene]\nuse = \"lee-du-2019\"\n[[scheme]]\nmodel = " + row.model +
                      "\ndivergence = \"" + row.divergence + "\"\nkernel = \"" + row.kernel +
                      "\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"" + row.dt +
                      "\"\n[[path]]\nname = \"reference\"\ndelta = \"" + row.delta + "\"\nN = [" + row.N +
                      "]\nsource = \"" + row.source + "\"\n",
                  "reference.toml");
  return study.series.at(0).cases.at(0);
}

}  // namespace

TEST_CASE("max-norm errors of an independent implementation are reproduced") {
  const auto rows = read_rows();
  REQUIRE(rows.size() == 44);
  const std::atomic<bool> stop{false};
  for (const Row& row : rows) {
    INFO("Model " << row.model << ", " << row.kernel << ", " << row.divergence << " divergence, delta = " << row.delta
                  << ", " << row.source << " source, N = " << row.N);
    const CaseResult result = run_case(case_of(row), stop);
    CHECK(result.completed);
    CHECK(result.failure == "");
    // Round-off accumulated over some 1000 steps; the two implementations sum in different orders.
    CHECK_THAT(result.error_linf, WithinRel(row.error, 1e-9));
  }
}
