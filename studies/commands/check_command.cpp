#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "studies/commands/check.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/storing/files.hpp"

namespace acstudy {

namespace {

struct CheckRequest {
  std::vector<std::string> files;
  std::optional<std::string> junit;
  bool github = false, verbose = false, quiet = false;
};

int check(const CheckRequest& request) {
  if (request.junit) require_writable(*request.junit);
  std::vector<Row> rows;
  for (const std::string& file : request.files) {
    for (Row& row : check_file(file)) rows.push_back(std::move(row));
  }
  std::string said = request.verbose ? table_text(rows, table_width()) : "";
  for (const Row& row : rows) {
    if (!request.verbose && !row.passes) said += record_text(row, columns(Stream::out));
  }
  if (!request.quiet) said += count_text(rows);
  fmt::print("{}{}", said, request.github ? github_text(rows) : "");
  if (request.junit) replace_atomically(*request.junit, junit_text(rows));
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passes; }) ? done : departs;
}

}  // namespace

Command check_command() {
  const auto request = std::make_shared<CheckRequest>();
  return {"check",
          "Judge result files again, the gate; exit 1 if a verdict departs",
          {{.name = "FILE.json", .target = &request->files, .help = "result files", .required = true},
           {.name = "--junit", .target = &request->junit, .help = "write the gates as JUnit XML, too", .type = "FILE"},
           {.name = "--github",
            .target = &request->github,
            .help = "print an annotation for GitHub Actions per gate that departs"},
           verbose_option(&request->verbose, "print a line per gate"),
           quiet_option(&request->quiet, "print only what departs")},
          [request](const std::string&) { return check(*request); },
          {{"check reports/out/*.json", "judges all results again; exit code 1 if a verdict departs"},
           {"check -v reports/out/fig2.json --junit gates.xml", "a line per gate of one study, and a report for CI"}}};
}

}  // namespace acstudy
