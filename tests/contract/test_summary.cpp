#include <algorithm>
#include <sstream>

#include "catch.hpp"
#include "studies/commands/run/summary.hpp"
#include "studies/commands/seconds.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/reading/nearest.hpp"

using namespace acstudy;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string in_one_line(const std::string& text) {
  std::string line;
  std::istringstream in(text);
  for (std::string word; in >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

Row row(const std::string& study, bool passes) {
  return {.study = study,
          .name = "Model II, nonlocal divergence, power(0.5), delta = 2 sqrt(h), backward-euler, step h",
          .observed = "0.50 [0.40, 0.60]",
          .verdict = passes ? "confirmed" : "below",
          .expected = "confirmed",
          .reason =
              "pairwise orders 0.85, 0.91, 0.95, 0.98 move toward 1 like v^0.77 and extrapolate to 1.03 [0.97, "
              "1.03]; the power law's 0.93 [0.88, 0.97] is not there yet",
          .passes = passes};
}

RunSummary summary_of(std::size_t studies, std::size_t departing_each) {
  RunSummary summary{.studies = studies, .computed = 9 * studies, .seconds = 92.4, .out = "reports/out"};
  for (std::size_t s = 0; s < studies; ++s) {
    const std::string name = "a-study-with-a-long-name-" + std::to_string(s);
    summary.rows.push_back(row(name, true));
    for (std::size_t i = 0; i < departing_each; ++i) summary.rows.push_back(row(name, false));
    summary.by_study.emplace_back(name, 0.5 * static_cast<double>(s));
  }
  summary.verdicts = {{"confirmed", studies}, {"below", studies * departing_each},
                      {"holds", 1892},        {"pre-asymptotic", 210},
                      {"stagnates", 12},      {"violated", 31}};
  return summary;
}

}  // namespace

TEST_CASE("a summary has 25 lines at most for any number of studies and departures", "[summary]") {
  for (const std::size_t studies : {1U, 2U, 40U, 1000U}) {
    for (const std::size_t departing : {0U, 1U, 3U, 100U}) {
      for (const std::size_t width : {50U, 80U, 200U}) {
        const std::string text = summary_text(summary_of(studies, departing), width, 25);
        CAPTURE(studies, departing, width, text);
        const auto lines = lines_of(text);
        const std::string words = in_one_line(text);
        CHECK(lines.size() <= 25);
        CHECK(std::all_of(lines.begin(), lines.end(), [&](const auto& line) { return width_of(line) <= width; }));
        CHECK((words.find("all as expected") != std::string::npos) == (departing == 0));
        CHECK((words.find("DEPART") != std::string::npos) == (departing > 0));
        const bool hidden = words.find(" more; all of them: acstudy check reports/out/") != std::string::npos;
        const bool all_shown = std::size_t(std::count_if(lines.begin(), lines.end(), [](const auto& line) {
                                 return line.starts_with("DEPART");
                               })) == studies * departing;
        CHECK(hidden == !all_shown);
      }
    }
  }
}

TEST_CASE("a departure is there in full, and the slowest studies are named slowest first", "[summary]") {
  const std::string text = summary_text(summary_of(3, 1), 1000, 25);
  CAPTURE(text);
  CHECK(text.find("below, expected confirmed: " + row("", false).reason + "\n") != std::string::npos);
  CHECK(text.find("92 s; longest, in time of a processor: a-study-with-a-long-name-2 1.0 s, "
                  "a-study-with-a-long-name-1 0.50 s\n") != std::string::npos);
  CHECK(text.find("27 cases computed, 0 taken from the store; results in reports/out\n") != std::string::npos);
}

TEST_CASE("what takes no time says nothing of it", "[summary]") {
  RunSummary summary = summary_of(2, 0);
  summary.seconds = 0.9;
  CHECK(summary_text(summary, 80, 25).find("longest") == std::string::npos);
  summary = summary_of(1, 0);
  summary.seconds = 9.9;
  CHECK(summary_text(summary, 80, 25).find("9.9 s") == std::string::npos);
}

TEST_CASE("a table that does not fit becomes records that do", "[summary]") {
  const std::vector<Row> rows{row("fig1", true), row("fig2", false)};
  const std::string whole = table_text(rows, 1000), narrow = table_text(rows, 80);
  CHECK(lines_of(whole).size() == 3);
  CHECK(lines_of(whole)[0].starts_with("gate    study  name"));
  for (const std::string& line : lines_of(narrow)) {
    CAPTURE(line);
    CHECK(width_of(line) <= 80);
  }
  CHECK(narrow.starts_with("ok      fig1: Model II"));
}

TEST_CASE("text is wrapped at blanks, and a word that is too long stays whole", "[terminal]") {
  CHECK(wrapped("one two three", 7, 2) == "one two\n  three");
  CHECK(wrapped("  one two", 6, 4) == "  one\n    two");
  CHECK(wrapped("a-word-that-is-too-long b", 5, 1) == "a-word-that-is-too-long\n b");
  CHECK(wrapped("δ δ δ", 5) == "δ δ δ");
  CHECK(wrapped("", 5).empty());
  CHECK(cut("δδδ", 2) == "δδ");
}

TEST_CASE("what a user may have meant is one mistake in three letters away", "[nearest]") {
  const std::vector<std::string> words{"run", "check", "fit", "bench", "explain", "list"};
  CHECK(did_you_mean("rn", words) == "; did you mean \"run\"?");
  CHECK(did_you_mean("chekc", words) == "; did you mean \"check\"?");
  CHECK(did_you_mean("exp", words) == "; did you mean \"explain\"?");
  CHECK(did_you_mean("frobnicate", words).empty());
  CHECK(edit_distance("--jbos", "--jobs") == 1);
  CHECK(edit_distance("", "abc") == 3);
}

TEST_CASE("seconds have two digits, and whole ones from ten on", "[seconds]") {
  CHECK(seconds_text(0.0002) == "< 0.001 s");
  CHECK(seconds_text(0.0314) == "0.031 s");
  CHECK(seconds_text(0.5) == "0.50 s");
  CHECK(seconds_text(9.94) == "9.9 s");
  CHECK(seconds_text(9.96) == "10 s");
  CHECK(seconds_text(134.4) == "134 s");
}
