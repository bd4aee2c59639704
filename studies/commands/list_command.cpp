#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/list.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

struct ListRequest {
  std::string what, kind;
  bool draw = false;
};

int list(const ListRequest& request) {
  const auto& [what, kind, draw] = request;
  if (what != "keys" && !kind.empty()) {
    throw InputError(
        fmt::format("list {} {}; only keys are of a kind: write keys {}; see acstudy list --help", what, kind, kind));
  }
  if (draw && what != "kernels") {
    throw InputError("only kernels are drawn; write list kernels --draw; see acstudy list --help");
  }
  fmt::print("{}", fitted(what == "keys" ? keys_text(kind) : list_text(what, draw)));
  return done;
}

}  // namespace

Command list_command() {
  const auto request = std::make_shared<ListRequest>();
  return {"list",
          "Print what can be named in a study",
          {{.name = "WHAT",
            .target = &request->what,
            .help = "schemes, kernels, integrators, scenes or kinds, all of them by default; keys: of a study file",
            .one_of = {"schemes", "kernels", "integrators", "scenes", "kinds", "keys"}},
           {.name = "KIND", .target = &request->kind, .help = "with keys: those of studies of this kind"},
           {.name = "--draw",
            .target = &request->draw,
            .help = "with kernels: below each its eta, from the particle to the horizon"}},
          [request](const std::string&) { return list(*request); },
          {{"list kernels --draw", "the kernels, as a study writes them, each with its eta"},
           {"list keys convergence", "the keys of a convergence study, table by table"}}};
}

}  // namespace acstudy
