#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/list.hpp"

namespace acstudy {

Command list_command() {
  const auto what = std::make_shared<std::string>();
  return {"list",
          "Print what can be named in a study",
          {{.name = "WHAT",
            .target = what.get(),
            .help = "schemes, kernels, integrators or scenes; everything by default",
            .one_of = {"schemes", "kernels", "integrators", "scenes"}}},
          [what](const std::string&) {
            print_list(*what);
            return done;
          }};
}

}  // namespace acstudy
