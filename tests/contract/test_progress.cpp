#include "catch.hpp"
#include "studies/commands/run/progress.hpp"

using namespace acstudy;

TEST_CASE("progress says what is left by what was measured, and nothing where nothing was") {
  Pace pace{.cases = 40, .work = 100.0, .findings = 10};
  CHECK(pace.line(0.0) == "0 of 40 cases and 0 of 10 findings, 0 s");
  CHECK(pace.line(59.9) == "0 of 40 cases and 0 of 10 findings, 59 s");
  // A fifth of the work in 10 s: four times as long for the rest, however many cases that is.
  pace.cases_done = 2;
  pace.work_done = 20.0;
  CHECK(pace.line(10.0) == "2 of 40 cases and 0 of 10 findings, 10 s, about 40 s left for the cases");
  pace.cases_done = 40;
  pace.work_done = 100.0;
  pace.cases_ended = 50.0;
  CHECK(pace.line(170.0) == "40 of 40 cases and 0 of 10 findings, 170 s");
  // Two findings in the 120 s since the last case.
  pace.findings_done = 2;
  CHECK(pace.line(170.0) == "40 of 40 cases and 2 of 10 findings, 170 s, about 480 s left");
  pace.findings_done = 10;
  CHECK(pace.line(650.0) == "40 of 40 cases and 10 of 10 findings, 650 s, about 0 s left");
}

TEST_CASE("progress names what a run has") {
  CHECK(Pace{.cases = 4, .cases_done = 1, .work = 4.0, .work_done = 1.0}.line(1.0) ==
        "1 of 4 cases, 1 s, about 3 s left");
  CHECK(Pace{.findings = 6, .findings_done = 3}.line(2.0) == "3 of 6 findings, 2 s, about 2 s left");
}

TEST_CASE("a study's line says how far it is, and its end no later than that of all") {
  StudyPace study{.name = "map", .pace = {.cases = 40, .cases_done = 10, .work = 100.0, .work_done = 20.0}};
  CHECK(study.line(10.0, 5, std::nullopt) == "map     20 %  10 of 40 cases, about 40 s left");
  CHECK(study.line(10.0, 5, 30.0) == "map     20 %  10 of 40 cases, about 30 s left");
  CHECK(study.last_line(12.3, 3) == "map  40 cases, 12 s");
  study.pace = {.cases = 4, .cases_done = 4, .work = 1.0, .work_done = 1.0, .findings = 3, .findings_done = 1};
  CHECK(study.line(2.0, 3, std::nullopt) == "map   33 %  1 of 3 findings, about 4 s left");
}
