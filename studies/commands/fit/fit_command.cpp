#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/fit/fit_values.hpp"
#include "studies/commands/terminal.hpp"

namespace acstudy {

namespace {

template <class Fits>
int print(const Fits& fits, bool json) {
  fmt::print("{}", json ? as_json(fits) : fitted(as_text(fits)));
  return fits.passes() ? done : departs;
}

}  // namespace

Command fit_command() {
  struct Arguments {
    FitRequest request;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  FitRequest& r = arguments->request;
  return {"fit",
          "Judge a table of errors or values; exit 0 only if all have the order of --order, or without it a sharp one",
          {{.name = "TABLE.csv",
            .target = &r.file,
            .help = "a table whose first line names its columns; -: standard input",
            .required = true},
           {.name = "--variable", .target = &r.variable, .help = "column of the variable", .type = "NAME"},
           {.name = "--count",
            .target = &r.count,
            .help = "in its place, column of a number n of cells: h = n^(-1/D)",
            .type = "NAME",
            .excludes = {"--variable"}},
           {.name = "--dimension",
            .target = &r.dimension,
            .help = "dimension D of the space that the cells fill",
            .type = "D",
            .needs = {"--count"}},
           {.name = "--error",
            .target = &r.errors,
            .help = "columns of errors, each judged; all: every column of numbers but variable, count and weight",
            .type = "NAME,..."},
           {.name = "--weight",
            .target = &r.weight,
            .help = "column of weights, as one over the variance of the relative error",
            .type = "NAME"},
           {.name = "--value",
            .target = &r.values,
            .help = "without an exact solution: columns of values, as norms or functionals of the solution",
            .type = "NAME,...",
            .excludes = {"--error", "--weight"}},
           {.name = "--difference",
            .target = &r.differences,
            .help = "columns of differences of successive levels, or their norms; empty for the finest level",
            .type = "NAME,...",
            .excludes = {"--error", "--weight", "--value"}},
           {.name = "--levels",
            .target = &r.levels,
            .help = "levels to judge, as 3:8, 3: or :6; 1 is the coarsest, ends included",
            .type = "A:B"},
           {.name = "--order", .target = &r.order, .help = "theory's order; 0: the error must settle", .type = "P"},
           {.name = "--scale",
            .target = &r.options.scale,
            .help = "size of the solution; errors below 1e-12 times it are round-off",
            .type = "S"},
           {.name = "--floor",
            .target = &r.options.floor,
            .help = "error that round-off, quadrature or iteration leaves; errors below it tell nothing",
            .type = "F"},
           {.name = "--json", .target = &arguments->json, .help = "print one JSON object"}},
          [arguments](const std::string&) {
            const auto& [request, json] = *arguments;
            if (!request.values.empty() || !request.differences.empty()) return print(fit_values(request), json);
            return print(fit_table(request), json);
          },
          {{"fit errors.csv --order 2", "do the errors fall with order 2 in h?"},
           {"fit runs.csv --value drag --order 2 --json", "values without an exact solution, for a program"}}};
}

}  // namespace acstudy
