#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "studies/commands/check.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/output.hpp"
#include "studies/storing/files.hpp"

namespace acstudy {

namespace {

struct CheckRequest {
  std::vector<std::string> files;
  std::optional<std::string> junit;
  bool github = false;
};

int check(const CheckRequest& request) {
  if (request.junit) require_writable(*request.junit);
  std::vector<Row> rows;
  for (const std::string& file : request.files) {
    for (Row& row : check_file(file)) rows.push_back(std::move(row));
  }
  fmt::print("{}{}{}", table_text(rows), count_text(rows), request.github ? github_text(rows) : "");
  if (request.junit) replace_atomically(*request.junit, junit_text(rows));
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passes; }) ? done : departs;
}

}  // namespace

Command check_command() {
  const auto request = std::make_shared<CheckRequest>();
  return {"check",
          "The gate: judge result files; exit 1 if a verdict departs",
          {{.name = "FILE.json", .target = &request->files, .help = "result files", .required = true},
           {.name = "--junit", .target = &request->junit, .help = "write the gates as JUnit XML, too", .type = "FILE"},
           {.name = "--github",
            .target = &request->github,
            .help = "print an annotation for GitHub Actions per gate that departs"}},
          [request](const std::string&) { return check(*request); }};
}

}  // namespace acstudy
