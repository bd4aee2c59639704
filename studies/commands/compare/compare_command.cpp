#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/compare/compare_output.hpp"
#include "studies/commands/exit.hpp"

namespace acstudy {

namespace {

struct CompareRequest {
  std::string before, after;
  bool verbose = false, json = false;
};

int compare(const CompareRequest& request) {
  const ResultSet before = read_results(request.before), after = read_results(request.after);
  const Comparison comparison = compare(before, after);
  fmt::print("{}", request.json ? comparison_json(comparison) : comparison_text(comparison, request.verbose));
  return comparison.worsened() ? departs : done;
}

}  // namespace

Command compare_command() {
  const auto request = std::make_shared<CompareRequest>();
  return {
      "compare",
      "Compare results with older ones; exit 1 if a verdict worsened",
      {{.name = "OLD", .target = &request->before, .help = "result file or folder of result files", .required = true},
       {.name = "NEW", .target = &request->after, .help = "what to compare with it", .required = true},
       {.name = "-v,--verbose", .target = &request->verbose, .help = "print every difference"},
       {.name = "--json", .target = &request->json, .help = "print everything as one JSON object"}},
      [request](const std::string&) { return compare(*request); },
      {{"compare reports/before reports/out", "what differs between two folders, worst first"},
       {"compare before/fig5.json out/fig5.h5 --json", "all about one study, for programs"}}};
}

}  // namespace acstudy
