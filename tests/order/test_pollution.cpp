#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "studies/commands/run/runner.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/input_error.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;

namespace {

/// A folder with the studies of a test.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("acstudy-pollution-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  Study study(const std::string& studies) const {
    write("budget.toml", "[study]\nname = \"budget\"\nkind = \"pollution\"\n[pollution]\n" + studies);
    return read_study((path_ / "budget.toml").string());
  }
  std::string refusal(const std::string& studies) const {
    try {
      study(studies);
    } catch (const InputError& error) {
      std::string message = error.what();
      for (std::size_t at; (at = message.find(path_.string() + "/")) != std::string::npos;) {
        message.erase(at, path_.string().size() + 1);
      }
      return message;
    }
    return "accepted";
  }

 private:
  std::filesystem::path path_;
};

std::string study_text(const std::string& time, const std::string& extra = "") {
  return "[study]\nname = \"tiny\"\n[scene]\nuse = \"lee-du-2019\"\n"
         "[[scheme]]\nmodel = 1\ndivergence = \"local\"\nkernel = \"inverse\"\n"
         "[[scheme]]\nmodel = 2\ndivergence = \"nonlocal\"\nkernel = \"cubic-spline\"\n[time]\n" +
         time + extra +
         "[[path]]\nname = \"delta = 4h\"\ndelta = \"4*h\"\nN = [20, 40]\nsource = \"local\"\n"
         "[[path]]\nname = \"delta = 0.5\"\ndelta = 0.5\nN = [20, 40]\nsource = \"nonlocal\"\n";
}

std::vector<Finding> budgets(const Folder& folder, const Study& study) {
  RunOptions options;
  options.out = folder.path();
  options.fresh = true;
  const std::atomic<bool> stop{false};
  const std::vector<Study> studies = {study};
  const RunResult run = run_studies(studies, options, stop);
  std::vector<Finding> findings;
  for (const auto& finding : run.studies[0].findings) findings.push_back(finding.value());
  return findings;
}

std::map<std::string, double> shares(const Finding& finding) {
  std::map<std::string, double> by_label;
  for (const Point& point : finding.points) by_label[point.label] = point.value;
  return by_label;
}

}  // namespace

TEST_CASE("an error budget finds the time step's part by two ways, and next to nothing of source and round-off") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = \"h/8\"\n"));
  const Study study = folder.study("studies = [\"tiny.toml\"]\n");
  CHECK(study.series.size() == 2 * (4 + 5));
  const auto findings = budgets(folder, study);
  REQUIRE(findings.size() == 4);
  for (const Finding& finding : findings) {
    CAPTURE(finding.label(), finding.judgement.reason);
    CHECK(finding.judgement.verdict == Verdict::holds);
    auto share = shares(finding);
    CHECK(share["time"] > 0.01);
    CHECK(share["time"] < 1.0);
    // A horizon of many spacings leaves Model II so little error in space that most of it is the step's.
    CHECK((finding.remark.find("the time step makes") == 0) == (share["time"] > 0.5));
    CHECK(share["time, against ssprk3"] < 0.01);
    CHECK(share["round-off"] > 0.0);
    CHECK(share["round-off"] < 1e-12);
    // By the triangle inequality.
    CHECK(share["space"] + share["time"] >= 1.0 - 1e-12);
    CHECK(share.count("source") == (finding.label().find("0.5") != std::string::npos ? 1 : 0));
    CHECK(share["source"] < 1e-12);
  }
}

TEST_CASE("a long time step is marked, and one with which the steps' part is not known is an alarm") {
  const Folder folder;
  // The step is three times the spacing, and the solution moves in time alone: no spatial error to speak of.
  const std::string standing =
      "[study]\nname = \"tiny\"\n[scene]\nperiod = \"2*pi\"\nT = 1\nc = \"0.01\"\nu = \"sin(x)*exp(-2*t)\"\n"
      "[[scheme]]\nmodel = 1\nkernel = \"inverse\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"3*h\"\n"
      "[[path]]\nname = \"delta = 4h\"\ndelta = \"4*h\"\nN = [20, 80]\nsource = \"local\"\n";
  folder.write("tiny.toml", standing);
  const Finding finding = budgets(folder, folder.study("studies = [\"tiny.toml\"]\n")).at(0);
  CAPTURE(finding.judgement.reason);
  CHECK(shares(finding)["time"] > 0.9);
  CHECK(finding.remark.find("the time step makes") == 0);
  CHECK(finding.judgement.verdict == Verdict::violated);
  CHECK(finding.alarm());
}

TEST_CASE("a run that blows up has no budget") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = 0.5\n"));
  for (const Finding& finding : budgets(folder, folder.study("studies = [\"tiny.toml\"]\n"))) {
    if (std::isfinite(finding.points[0].value)) continue;
    CHECK(finding.judgement.verdict == Verdict::violated);
  }
}

TEST_CASE("implicit steps are not compared with explicit ones of their length, and what must blow up is left out") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"backward-euler\"\nstep = \"h/4\"\n"));
  CHECK(folder.study("studies = [\"tiny.toml\"]\n").series.size() == 2 * (3 + 4));
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = \"h\"\nexpect = \"unstable\"\n"));
  CHECK(folder.study("studies = [\"tiny.toml\"]\n").series.empty());
}

TEST_CASE("a third-order integrator is not compared with itself, an adaptive source with the Gauss rule") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"ssprk3\"\nstep = \"h/2\"\n", "[source]\nrule = \"gsl\"\n"));
  const Study study = folder.study("studies = [\"tiny.toml\"]\n");
  REQUIRE(study.series.size() == 2 * (3 + 4));
  const Series& source = study.series[3 + 2];
  CHECK(source.cases[0].source_rule == SourceRule::gauss);
  CHECK(source.cases[0].source_refinement == 1);
  for (const Finding& finding : budgets(folder, study)) {
    CAPTURE(finding.label(), finding.judgement.reason);
    CHECK(finding.judgement.verdict == Verdict::holds);
    auto share = shares(finding);
    CHECK(share.count("time, against ssprk3") == 0);
    CHECK(share["time"] < 0.1);
  }
}

TEST_CASE("a budget's cases are the study's own, but for the one thing that each rerun changes") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = \"h/4\"\n"));
  const Study budget = folder.study("studies = [\"tiny.toml\"]\n"),
              tiny = read_study((folder.path() / "tiny.toml").string());
  CHECK(budget.series[0].cases[0].key() == tiny.series[0].cases.back().key());
  std::map<std::string, int> keys;
  for (const Series& series : budget.series) ++keys[series.cases[0].key()];
  CHECK(keys.size() == budget.series.size());
}

TEST_CASE("a budget is of a coarser level where it is asked for") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = \"h/4\"\n"));
  const Study tiny = read_study((folder.path() / "tiny.toml").string());
  const auto first_key = [&](const std::string& coarser) {
    return folder.study("studies = [\"tiny.toml\"]\n" + coarser).series[0].cases[0].key();
  };
  CHECK(first_key("coarser = 1\n") == tiny.series[0].cases[0].key());
  CHECK(first_key("coarser = 0\n") == tiny.series[0].cases[1].key());
  CHECK(first_key("coarser = 0\n") == first_key(""));
  CHECK(folder.refusal("studies = [\"tiny.toml\"]\ncoarser = 2\n") ==
        "budget.toml:6:11: coarser = 2, but " + tiny.series[0].label() + " of tiny has 2 levels; it must be less");
}

TEST_CASE("studies that an error budget cannot be of are refused at their place") {
  const Folder folder;
  folder.write("tiny.toml", study_text("integrator = \"forward-euler\"\nstep = \"h/4\"\n"));
  CHECK(folder.refusal("studies = [\"tiny.toml\"]\n") == "accepted");
  CHECK(folder.refusal("studies = [\"tiny.toml\", \"none.toml\"]\n") ==
        "budget.toml:5:25: studies contains \"none.toml\", but there is no such file; names are relative to the "
        "study file");
  CHECK(folder.refusal("studies = [\"budget.toml\"]\n") ==
        "budget.toml:5:12: studies contains \"budget.toml\", which is of kind \"pollution\"; name studies of kind "
        "\"convergence\"");
  CHECK(folder.refusal("studies = [1]\n") ==
        "budget.toml:5:12: studies contains 1; every entry must be the name of a study file");
  CHECK(folder.refusal("studies = []\n").find("budget.toml:5:11: studies must be a list, not an empty list") == 0);
  folder.write("broken.toml", "[study\n");
  CHECK(folder.refusal("studies = [\"broken.toml\"]\n").find("broken.toml:1:") == 0);
}
