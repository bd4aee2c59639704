#include "studies/models/kernel_choice.hpp"

#include <fmt/format.h>

#include <sstream>

namespace acstudy {

namespace {

/// The row of a name.  @throws std::invalid_argument if there is none
const NamedKernel& row_of(const std::string& name) {
  if (const NamedKernel* const found = find_kernel(name)) return *found;
  throw std::invalid_argument("no kernel is named " + name);
}

}  // namespace

AnyKernel make_kernel(const KernelFormula& formula) {
  const std::shared_ptr<const KernelPieces> pieces = kernel_pieces(formula);
  if (pieces->mass.empty()) return PiecewiseKernel(pieces);
  return IntegrablePiecewiseKernel(pieces);
}

std::shared_ptr<const KernelFormula> KernelChoice::its_formula() const {
  if (formula != nullptr) return formula;
  const NamedKernel& row = row_of(name);
  if (row.make != nullptr) return nullptr;
  KernelFormula its{.text = std::string(row.profile), .density = true};
  std::istringstream breaks{std::string(row.breaks)};
  for (std::string point; breaks >> point;) its.breaks.push_back(point);
  return std::make_shared<const KernelFormula>(std::move(its));
}

AnyKernel KernelChoice::kernel() const {
  if (const auto its = its_formula()) return make_kernel(*its);
  return row_of(name).make(parameter);
}

SweepKernel::Form KernelChoice::form() const {
  return formula != nullptr ? SweepKernel::Form::table : row_of(name).form;
}

std::string KernelChoice::label() const { return family() != nullptr ? fmt::format("{}({})", name, parameter) : name; }

}  // namespace acstudy
