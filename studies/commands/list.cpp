#include "studies/commands/list.hpp"

#include <fmt/format.h>

#include "mms/scene.hpp"
#include "solver/time/integrators.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/kernel_choice.hpp"

namespace acstudy {

void print_list(const std::string& what) {
  const auto heading = [&](const char* title) {
    if (what.empty()) fmt::print("{}:\n", title);
  };
  const char* indent = what.empty() ? "  " : "";
  if (what.empty() || what == "schemes") {
    heading("schemes");
    fmt::print(
        "{0}model = 1, divergence = \"local\"     Model I, scheme 1 (2.9); (2.4) where particles stand still\n"
        "{0}model = 1, divergence = \"nonlocal\"  Model I, scheme 2 (2.11)\n"
        "{0}model = 2, divergence = \"local\"     Model II, scheme 1 (3.8); (3.6) where particles stand still\n"
        "{0}model = 2, divergence = \"nonlocal\"  Model II, scheme 2 (3.10)\n",
        indent);
  }
  if (what.empty() || what == "kernels") {
    heading("kernels");
    for (const NamedKernel& kernel : named_kernels) fmt::print("{}{:<35} {}\n", indent, kernel.written, kernel.meaning);
  }
  if (what.empty() || what == "integrators") {
    heading("integrators");
    for (const Integrator& integrator : integrators) {
      fmt::print("{}{:<35} order {}, {} stage(s){}\n", indent, fmt::format("\"{}\"", integrator.name), integrator.order,
                 integrator.stage_count(), integrator.implicit() ? ", implicit" : "");
    }
  }
  if (what.empty() || what == "scenes") {
    heading("scenes");
    for (const SceneText& scene : named_scenes()) {
      fmt::print("{}{:<35} period {}, T = {}, c = {}, b = {}, u = {}\n", indent, fmt::format("\"{}\"", scene.name),
                 scene.period, scene.T, scene.c, scene.b.value_or("0"), scene.u);
    }
  }
  if (what.empty() || what == "kinds") {
    heading("kinds");
    for (const Kind* kind : kinds)
      fmt::print("{}{:<35} {}\n", indent, fmt::format("\"{}\"", kind->name), kind->meaning);
  }
}

}  // namespace acstudy
