#include "studies/commands/gate.hpp"
#include "tests/catch.hpp"

using namespace acstudy;

namespace {

Row passing() {
  return {.file = "out/a.json",
          .study = "a",
          .name = "Model I, delta = 4h",
          .observed = "0.98 [0.96, 1.00]",
          .verdict = "confirmed",
          .expected = "confirmed",
          .reason = "order 0.98",
          .passes = true};
}

Row departing() {
  Row row = passing();
  row.name = "Model II";
  row.observed = "-";
  row.verdict = "stagnates";
  row.reason = "the error settles";
  row.passes = false;
  return row;
}

}  // namespace

TEST_CASE("the table has a heading, aligned columns, and the reason where a gate departs") {
  CHECK(table_text({passing(), departing()}, 200) ==
        "gate    study  name                 observed           verdict\n"
        "ok      a      Model I, delta = 4h  0.98 [0.96, 1.00]  confirmed\n"
        "DEPART  a      Model II             -                  stagnates, expected confirmed: the error settles\n");
  CHECK(table_text({}, 200) == "gate    study  name  observed  verdict\n");
}

TEST_CASE("gates are counted, and those that depart") {
  CHECK(count_text({}) == "0 gates, 0 depart\n");
  CHECK(count_text({passing(), departing(), departing()}) == "3 gates, 2 depart\n");
}

TEST_CASE("JUnit has a suite per study of a file, a case per gate, a failure per departure") {
  Row other = departing(), again = passing();
  other.study = "b";
  again.file = "elsewhere/a.json";
  other.file = "out/b.json";
  CHECK(junit_text({passing(), departing(), other, again}) ==
        R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="acstudy" tests="4" failures="2" errors="0">
  <testsuite name="a" tests="2" failures="1" errors="0" skipped="0">
    <testcase name="Model I, delta = 4h" classname="a"/>
    <testcase name="Model II" classname="a">
      <failure message="stagnates, expected confirmed: the error settles" type="stagnates">observed -
stagnates, expected confirmed: the error settles</failure>
    </testcase>
  </testsuite>
  <testsuite name="b" tests="1" failures="1" errors="0" skipped="0">
    <testcase name="Model II" classname="b">
      <failure message="stagnates, expected confirmed: the error settles" type="stagnates">observed -
stagnates, expected confirmed: the error settles</failure>
    </testcase>
  </testsuite>
  <testsuite name="a" tests="1" failures="0" errors="0" skipped="0">
    <testcase name="Model I, delta = 4h" classname="a"/>
  </testsuite>
</testsuites>
)");
}

TEST_CASE("JUnit escapes markup and white space, and replaces what XML cannot hold") {
  Row row = passing();
  row.name = "a&b<c>\"d\"%\te\nf\rg\x01h\x1Fi\xEF\xBF\xBEj\xEF\xBF\xBFk\xCE\xB4'";
  CHECK(junit_text({row}).find(
            "<testcase name=\"a&amp;b&lt;c&gt;&quot;d&quot;%&#9;e&#10;f&#13;g\xEF\xBF\xBDh\xEF\xBF\xBDi"
            "\xEF\xBF\xBDj\xEF\xBF\xBDk\xCE\xB4'\"") != std::string::npos);
}

TEST_CASE("GitHub gets an annotation per departure, and nothing of what passes") {
  CHECK(github_text({passing()}).empty());
  CHECK(github_text({passing(), departing()}) ==
        "::error file=out/a.json,title=a%3A Model II::stagnates, expected confirmed: the error settles\n");
}

TEST_CASE("an annotation cannot be ended, nor another begun, by what it says") {
  Row row = departing();
  row.file = "a,b:c%.json";
  row.name = "50%\r\n::error::x,y";
  row.reason = "100%: a, b\r\n::error::no";
  CHECK(github_text({row}) ==
        "::error file=a%2Cb%3Ac%25.json,title=a%3A 50%25%0D%0A%3A%3Aerror%3A%3Ax%2Cy::"
        "stagnates, expected confirmed: 100%25: a, b%0D%0A::error::no\n");
}
