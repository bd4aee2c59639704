#include "studies/commands/list.hpp"

#include <fmt/format.h>

#include "mms/scene.hpp"
#include "solver/time/integrators.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/model_card.hpp"

namespace acstudy {

std::string list_text(const std::string& what) {
  std::string out;
  const auto heading = [&](const char* title) {
    if (what.empty()) out += fmt::format("{}:\n", title);
  };
  const char* indent = what.empty() ? "  " : "";
  if (what.empty() || what == "schemes") {
    heading("schemes");
    for (const ModelCard* model : model_cards()) {
      if (model->own()) {
        out += fmt::format("{}model = \"{}\"  order {:g} in {} ({})\n", indent, model->name, model->order,
                           model->order_in_h ? "h" : "max(h,delta)", model->equations.local);
        continue;
      }
      const Theorems& equations = model->equations;
      out += fmt::format(
          "{0}model = {1}, divergence = \"local\"     {2}, scheme 1 {3}; {4} where particles stand still\n"
          "{0}model = {1}, divergence = \"nonlocal\"  {2}, scheme 2 {5}\n",
          indent, model->number, model->name, equations.local, equations.standing, equations.nonlocal);
    }
  }
  if (what.empty() || what == "kernels") {
    heading("kernels");
    for (const NamedKernel& kernel : named_kernels)
      out += fmt::format("{}{:<35} {}\n", indent, kernel.written, kernel.meaning);
  }
  if (what.empty() || what == "integrators") {
    heading("integrators");
    for (const Integrator& integrator : integrators) {
      const std::size_t stages = integrator.stage_count();
      out +=
          fmt::format("{}{:<35} order {}, {} {}{}\n", indent, fmt::format("\"{}\"", integrator.name), integrator.order,
                      stages, stages == 1 ? "stage" : "stages", integrator.implicit() ? ", implicit" : "");
    }
  }
  if (what.empty() || what == "scenes") {
    heading("scenes");
    for (const SceneText& scene : named_scenes()) {
      out +=
          fmt::format("{}{:<35} period {}, T = {}, c = {}, b = {}, u = {}\n", indent, fmt::format("\"{}\"", scene.name),
                      scene.period, scene.T, scene.c, scene.b.value_or("0"), scene.u);
    }
  }
  if (what.empty() || what == "kinds") {
    heading("kinds");
    for (const Kind* kind : kinds)
      out += fmt::format("{}{:<35} {}\n", indent, fmt::format("\"{}\"", kind->name), kind->meaning);
  }
  return out;
}

}  // namespace acstudy
