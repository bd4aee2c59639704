#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <string>

#include "studies/commands/run/runner.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/result_record.hpp"
#include "tests/catch.hpp"

using namespace acstudy;

namespace {

/// Over a short time errors are asymptotic already with few particles.
std::string map_text(const std::string& map) {
  return "[study]\nname = \"tiny-map\"\nkind = \"map\"\n[scene]\nuse = \"lee-du-2019\"\nT = 0.25\n"
         "[[scheme]]\nmodel = 2\ndivergence = \"local\"\nkernel = \"cubic-spline\"\n"
         "[time]\nintegrator = \"forward-euler\"\nstep = \"h/8\"\n[map]\n" +
         map;
}

const std::string tiny =
    "delta = [0.0001, 0.04, 0.08, 0.16, 0.25, 0.4, 0.6]\nN = [57, 80, 113, 160, 226, 320]\nsources = [\"local\", "
    "\"nonlocal\"]\n";

std::string refusal(const std::string& map) {
  try {
    parse_study(map_text(map), "map.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a map of a compatible scheme confirms every limit, and the gate judges its file the same") {
  const auto out = std::filesystem::temp_directory_path() / ("acstudy-map-" + std::to_string(getpid()));
  std::filesystem::create_directories(out);
  const std::vector<Study> studies = {parse_study(map_text(tiny), "map.toml")};
  REQUIRE(studies[0].series.size() == 2 * 7);
  RunOptions options;
  options.out = out;
  const std::atomic<bool> stop{false};
  const RunResult run = run_studies(studies, options, stop);
  CHECK(run.computed == 2 * 7 * 6);
  REQUIRE(run.studies[0].findings.size() == 7);
  int surfaces = 0;
  for (const auto& finding : run.studies[0].findings) {
    REQUIRE(finding);
    CAPTURE(finding->label(), finding->judgement.reason);
    CHECK(finding->as_expected());
    CHECK_FALSE(finding->alarm());
    surfaces += finding->test == Test::surface;
  }
  CHECK(surfaces == 1);

  const ResultRecord record = read_json((out / "tiny-map.json").string());
  const StoredCases stored = load_cases(out / "tiny-map.h5");
  REQUIRE(record.findings.size() == 7);
  REQUIRE(stored.findings.size() == 7);
  for (std::size_t i = 0; i < 7; ++i) {
    const Judgement& judged = run.studies[0].findings.at(i)->judgement;
    CHECK(record.findings.at(i).finding.judgement.reason == judged.reason);
    CHECK(stored.findings.at(i).judgement.reason == judged.reason);
  }
  // The runs are in the store: nothing is run again, and the findings are the same.
  const RunResult again = run_studies(studies, options, stop);
  CHECK(again.computed == 0);
  CHECK(again.studies[0].findings[4]->judgement.reason == run.studies[0].findings[4]->judgement.reason);
  std::filesystem::remove_all(out);
}

TEST_CASE("a surface that a file claims is judged by its values") {
  Finding finding{Check{
      .test = Test::surface, .theory_order = 1.0, .promised = Verdict::confirmed, .expected = Verdict::confirmed}};
  for (const double delta : {0.01, 0.02, 0.05, 0.1, 0.2}) {
    for (const double h : {0.1, 0.07, 0.05, 0.035, 0.025}) {
      finding.points.push_back({.h = h, .delta = delta, .value = 0.05 * h / delta + delta});
    }
  }
  judge(finding);
  CAPTURE(finding.judgement.reason);
  CHECK(finding.alarm());
  for (Point& point : finding.points) point.value = std::hypot(2.0 * point.h, point.delta);
  judge(finding);
  CAPTURE(finding.judgement.reason);
  CHECK_FALSE(finding.alarm());
  REQUIRE(finding.surface);
}

TEST_CASE("what makes no map is refused at its place") {
  const std::string N = "N = [40, 57, 80, 113]\n", sources = "sources = [\"local\"]\n",
                    delta = "delta = [0.01, 0.02, 0.05, 0.1]\n";
  CHECK(refusal(delta + N + sources) == "accepted");
  CHECK(refusal("delta = [0.01, 0.02, 0.02, 0.1]\n" + N + sources) ==
        "map.toml:15:22: delta = 0.02 after 0.02; horizons must go from small to large");
  CHECK(refusal("delta = [0.01, 0.02, 0.05]\n" + N + sources) ==
        "map.toml:15:9: delta has 3 entries; a surface of errors needs at least 4, 8 or more are better");
  CHECK(refusal("delta = [0.01, 0.02, 0.05, 4]\n" + N + sources).find("map.toml:15:28: delta = 4 at h = ") == 0);
  CHECK(refusal(delta + "N = [40, 57]\n" + sources) ==
        "map.toml:16:5: N has 2 entries; a surface of errors needs at least 4, 8 or more are better");
  CHECK(refusal(delta + N + "sources = [\"local\", \"local\"]\n") == "map.toml:17:21: the same source a second time");
  CHECK(refusal(delta + N + "sources = [\"exact\"]\n") ==
        "map.toml:17:12: sources = \"exact\"; it must be one of \"local\", \"nonlocal\"");
  CHECK(refusal(delta + N).find("map.toml:14:1: ") == 0);
}

TEST_CASE("a map says how its first run blew up") {
  const auto out = std::filesystem::temp_directory_path() / ("acstudy-map-unstable-" + std::to_string(getpid()));
  std::filesystem::create_directories(out);
  std::string text =
      map_text("delta = [0.001, 0.002, 0.004, 0.008]\nN = [160, 320, 640, 1280]\nsources = [\"local\"]\n");
  text.replace(text.find("\"h/8\""), 5, "\"3*h\"");
  text.replace(text.find("T = 0.25"), 8, "T = 1");
  RunOptions options;
  options.out = out;
  const std::atomic<bool> stop{false};
  const std::vector<Study> studies = {parse_study(text, "map.toml")};
  const RunResult run = run_studies(studies, options, stop);
  for (const auto& finding : run.studies[0].findings) {
    CAPTURE(finding->label(), finding->remark);
    CHECK_FALSE(finding->as_expected());
    CHECK(finding->remark.find("the solution has grown to") != std::string::npos);
    CHECK(finding->remark.find("particle") != std::string::npos);
  }
  std::filesystem::remove_all(out);
}

TEST_CASE("findings of an interrupted study are taken up one by one") {
  const auto out = std::filesystem::temp_directory_path() / ("acstudy-findings-" + std::to_string(getpid()));
  std::filesystem::create_directories(out);
  const std::string text =
      "[study]\nname = \"tiny\"\nkind = \"stability\"\n[scene]\nuse = \"constant-velocity\"\n"
      "[[scheme]]\nmodel = 1\nkernel = \"inverse\"\n[sweep]\nN = [20]\nratios = [1]\n";
  RunOptions options;
  options.out = out;
  std::atomic<bool> stop{false};
  const auto run = [&](std::size_t interrupt_after) {
    std::vector<Study> studies = {parse_study(text, "tiny.toml")};
    REQUIRE(studies[0].measurements.size() == 6);
    std::size_t taken = 0;
    for (Measurement& measurement : studies[0].measurements) {
      measurement.measure = [&, inner = measurement.measure](Finding& finding, const std::vector<SeriesResult>& all) {
        stop = ++taken == interrupt_after;
        inner(finding, all);
      };
    }
    stop = false;
    run_studies(studies, options, stop);
    return taken;
  };
  CHECK(run(2) == 2);
  CHECK(load_cases(out / "tiny.h5").findings.size() == 2);
  CHECK(run(0) == 4);
  CHECK(load_cases(out / "tiny.h5").findings.size() == 6);
  CHECK(run(0) == 0);
  std::filesystem::remove_all(out);
}
