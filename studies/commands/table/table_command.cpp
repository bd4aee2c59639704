#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/table/error_table.hpp"

namespace acstudy {

namespace {

struct TableRequest {
  std::string file, format = "markdown", norm = "max";
};

int print_table(const TableRequest& request) {
  const Norm norm = request.norm == "max" ? Norm::max : request.norm == "l1" ? Norm::l1 : Norm::l2;
  const ResultRecord record = stated_json(request.file);
  if (record.damaged) say_damaged(request.file);
  const std::vector<ErrorTable> tables = error_tables(record, norm, request.file);
  fmt::print("{}", request.format == "latex" ? as_latex(tables)
                   : request.format == "csv" ? as_csv(tables)
                                             : as_markdown(tables));
  return done;
}

}  // namespace

Command table_command() {
  const auto request = std::make_shared<TableRequest>();
  return {"table",
          "Print errors and orders as a paper has them, a table for each refinement path",
          {{.name = "FILE.json", .target = &request->file, .help = "a result file", .required = true},
           {.name = "--format",
            .target = &request->format,
            .help = "markdown by default; latex takes booktabs, csv has a row per level and all digits",
            .one_of = {"markdown", "latex", "csv"}},
           {.name = "--norm",
            .target = &request->norm,
            .help = "of the errors, max by default; the judge's order is that of the max norm",
            .one_of = {"max", "l1", "l2"}}},
          [request](const std::string&) { return print_table(*request); },
          {{"table reports/out/fig5.json", "errors and orders, to read"},
           {"table reports/out/fig5.json --format latex > table.tex", "the same for a paper"}}};
}

}  // namespace acstudy
