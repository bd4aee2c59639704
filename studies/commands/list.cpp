#include "studies/commands/list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mms/scene.hpp"
#include "solver/time/integrators.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/model_card.hpp"

namespace acstudy {

namespace {

/// eta over the unit horizon, from the particle to the horizon, in columns of eight heights. Of what grows without
/// bound at 0 the first column alone is full.
std::string drawn(const NamedKernel& row) {
  constexpr const char* heights[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  constexpr int columns = 40;
  const KernelChoice choice{std::string(row.name), row.parameter ? row.parameter->example : 0.0};
  std::array<double, columns> eta;
  with_kernel(choice, [&](const auto& kernel) {
    for (int i = 0; i < columns; ++i) eta[i] = kernel.eta((i + 0.5) / columns);
  });
  const double largest = *std::max_element(eta.begin(), eta.end());
  std::string out;
  for (const double value : eta) out += heights[std::lround(8.0 * value / largest)];
  return out;
}

}  // namespace

std::string list_text(const std::string& what, bool draw) {
  std::string out;
  const auto heading = [&](const char* title) {
    if (what.empty()) out += fmt::format("{}:\n", title);
  };
  const char* indent = what.empty() ? "  " : "";
  if (what.empty() || what == "schemes") {
    heading("schemes");
    for (const ModelCard* model : model_cards()) {
      if (model->beyond_paper) {
        const std::string limiter = model->limiter.empty() ? "" : fmt::format(", limiter = \"{}\"", model->limiter);
        const std::string order = fmt::format("order {:g} in {} ({})", model->order,
                                              model->order_in_h ? "h" : "max(h,delta)", model->equations.local);
        if (model->fingerprint != nullptr) {
          out += fmt::format("{}model = \"{}\"  {}\n", indent, model->name, order);
          continue;
        }
        out += fmt::format(
            "{0}model = \"{1}\"{2}, divergence = \"local\"     {3}\n"
            "{0}model = \"{1}\"{2}, divergence = \"nonlocal\"  {3}\n",
            indent, model->name, limiter, order);
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
    for (const NamedKernel& kernel : named_kernels) {
      out += fmt::format("{}{:<35} {}\n", indent, kernel.written, kernel.meaning);
      if (draw) out += fmt::format("{}{:<35} {}\n", indent, "", drawn(kernel));
    }
  }
  if (what.empty() || what == "integrators") {
    heading("integrators");
    for (const Integrator& integrator : integrators) {
      const std::size_t stages = integrator.stage_count();
      out +=
          fmt::format("{}{:<35} order {}, {} {}{}{}\n", indent, fmt::format("\"{}\"", integrator.name),
                      integrator.order, stages, stages == 1 ? "stage" : "stages",
                      integrator.implicit() ? ", implicit" : "", integrator.estimates() ? ", estimates its error" : "");
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
