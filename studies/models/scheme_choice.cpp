#include "studies/models/scheme_choice.hpp"

#include <fmt/format.h>

#include "studies/models/control_choice.hpp"
#include "studies/models/outside_program.hpp"

namespace acstudy {

std::string scheme_label(const SchemeChoice& scheme, bool standing) {
  if (scheme.program != nullptr) return scheme.program->label;
  std::string text = scheme.model->label();
  if (!standing) text += scheme.nonlocal_divergence ? ", nonlocal divergence" : ", local divergence";
  text += ", " + scheme.kernel.label();
  return scheme.control == nullptr ? text : fmt::format("{} ({})", scheme.control->name, text);
}

}  // namespace acstudy
