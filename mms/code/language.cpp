#include "mms/code/language.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace acstudy::code {

namespace {

using Op = Expression::Op;

/// Names as C's math.h has them, but for abs, min and max.
constexpr std::pair<Op, std::string_view> usual_names[] = {
    {Op::sin, "sin"},   {Op::cos, "cos"},   {Op::tan, "tan"},   {Op::asin, "asin"},
    {Op::acos, "acos"}, {Op::atan, "atan"}, {Op::sinh, "sinh"}, {Op::cosh, "cosh"},
    {Op::tanh, "tanh"}, {Op::exp, "exp"},   {Op::log, "log"},   {Op::sqrt, "sqrt"},
    {Op::abs, "abs"},   {Op::min, "min"},   {Op::max, "max"},   {Op::atan2, "atan2"},
};

std::string usual_name(Op op) {
  const auto* const found = std::find_if(std::begin(usual_names), std::end(usual_names),
                                         [op](const auto& known) { return known.first == op; });
  return std::string(found->second);
}

std::string comment(const std::vector<std::string>& lines, std::string_view mark) {
  std::string out;
  for (const std::string& line : lines) out += fmt::format("{} {}\n", mark, line);
  return out + "\n";
}

/// The rules that a program sums over, each once.
std::vector<const Sum*> rules_of(const Program& program) {
  std::vector<const Sum*> rules;
  for (const Body& body : program.functions) {
    for (const Sum& sum : body.sums) rules.push_back(&sum);
  }
  return rules;
}

/// The entries of an array, a line each: no language's lines are too short for one.
std::string entries(const Language& language, const std::vector<double>& values, std::string_view between) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(language.number(value));
  return fmt::format("{}", fmt::join(texts, between));
}

std::string assignments(const std::vector<Statement>& statements, std::string_view indent, std::string_view end,
                        std::string_view declare = "") {
  std::string out;
  for (const auto& [name, value, adds] : statements) {
    out += adds ? fmt::format("{}{} = {} + {}{}\n", indent, name, name, value, end)
                : fmt::format("{}{}{} = {}{}\n", indent, declare, name, value, end);
  }
  return out;
}

class Python : public Language {
 public:
  std::string_view name() const override { return "python"; }
  std::string function(Op op) const override {
    const std::string name = usual_name(op);
    if (op == Op::min || op == Op::max) return "np." + name + "imum";
    return "np." + (name.front() == 'a' && op != Op::abs ? "arc" + name.substr(1) : name);
  }
  std::string power(const std::string& base, const std::string& exponent) const override {
    return base + "**" + exponent;
  }
  std::string choice(const std::string& p, const std::string& q, const std::string& a,
                     const std::string& b) const override {
    return fmt::format("np.where({} <= {}, {}, {})", p, q, a, b);
  }
  std::string entry(const std::string&, std::string_view array) const override { return std::string(array); }

  std::string write(const Program& program) const override {
    std::string out = comment(program.about, "#") + "import numpy as np\n\n";
    for (const auto& [name, value] : program.constants) out += fmt::format("{} = {}\n", name, number(value));
    for (const Sum* sum : rules_of(program)) {
      for (const auto& [array, values] :
           {std::pair("node", &sum->points.node), std::pair("weight", &sum->points.weight)}) {
        out += fmt::format("{}_{} = [\n    {},\n]\n", sum->rule, array, entries(*this, *values, ",\n    "));
      }
    }
    for (const Body& body : program.functions) {
      out += fmt::format("\n\ndef {}({}):\n{}", body.name, fmt::join(body.arguments, ", "),
                         assignments(body.first, "    ", ""));
      for (const Sum& sum : body.sums) {
        out += fmt::format("    for node, weight in zip({0}_node, {0}_weight):\n{1}", sum.rule,
                           assignments(sum.each, "        ", ""));
      }
      out += fmt::format("    return {}\n", body.value);
    }
    return out;
  }
};

class C : public Language {
 public:
  std::string_view name() const override { return "c"; }
  std::string function(Op op) const override {
    return op == Op::abs ? "fabs" : op == Op::min ? "fmin" : op == Op::max ? "fmax" : usual_name(op);
  }
  std::string power(const std::string& base, const std::string& exponent) const override {
    return fmt::format("pow({}, {})", base, exponent);
  }
  std::string choice(const std::string& p, const std::string& q, const std::string& a,
                     const std::string& b) const override {
    return fmt::format("({} <= {} ? {} : {})", p, q, a, b);
  }
  std::string own(const std::string& name) const override { return "scene_" + name; }
  std::string entry(const std::string& rule, std::string_view array) const override {
    return fmt::format("{}_{}[q]", rule, array);
  }

  std::string write(const Program& program) const override {
    std::string out = comment(program.about, "//") + "#include <math.h>\n\n";
    for (const auto& [name, value] : program.constants) {
      out += fmt::format("const double {} = {};\n", own(name), number(value));
    }
    for (const Sum* sum : rules_of(program)) {
      for (const auto& [array, values] :
           {std::pair("node", &sum->points.node), std::pair("weight", &sum->points.weight)}) {
        out += fmt::format("static const double {}_{}[{}] = {{\n  {},\n}};\n", sum->rule, array, values->size(),
                           entries(*this, *values, ",\n  "));
      }
    }
    for (const Body& body : program.functions) {
      out += fmt::format("\ndouble {}(double {}) {{\n{}", own(body.name), fmt::join(body.arguments, ", double "),
                         assignments(body.first, "  ", ";", "double "));
      for (const Sum& sum : body.sums) {
        out += fmt::format("  for (int q = 0; q < {}; ++q) {{\n{}  }}\n", sum.points.size(),
                           assignments(sum.each, "    ", ";", "const double "));
      }
      out += fmt::format("  return {};\n}}\n", body.value);
    }
    return out;
  }
};

class Fortran : public Language {
 public:
  std::string_view name() const override { return "fortran"; }
  std::string number(double value) const override { return Language::number(value) + "_dp"; }
  std::string function(Op op) const override { return usual_name(op); }
  std::string power(const std::string& base, const std::string& exponent) const override {
    return base + "**" + exponent;
  }
  std::string choice(const std::string& p, const std::string& q, const std::string& a,
                     const std::string& b) const override {
    return fmt::format("merge({}, {}, {} <= {})", a, b, p, q);
  }
  std::string entry(const std::string& rule, std::string_view array) const override {
    return fmt::format("{}_{}(q)", rule, array);
  }

  std::string write(const Program& program) const override {
    std::string out = comment(program.about, "!") +
                      "module scene\n  implicit none\n  integer, parameter, private :: dp = kind(1.0d0)\n";
    for (const auto& [name, value] : program.constants) {
      out += fmt::format("  real(dp), parameter :: {} = {}\n", name, number(value));
    }
    for (const Sum* sum : rules_of(program)) {
      for (const auto& [array, values] :
           {std::pair("node", &sum->points.node), std::pair("weight", &sum->points.weight)}) {
        out += fmt::format("  real(dp), parameter, private :: {}_{}({}) = [ &\n    {} ]\n", sum->rule, array,
                           values->size(), entries(*this, *values, ", &\n    "));
      }
    }
    out += "\ncontains\n";
    for (const Body& body : program.functions) {
      std::vector<std::string> locals;
      const auto declare = [&](const std::vector<Statement>& statements) {
        for (const Statement& one : statements) {
          if (std::find(locals.begin(), locals.end(), one.name) == locals.end()) locals.push_back(one.name);
        }
      };
      declare(body.first);
      for (const Sum& sum : body.sums) declare(sum.each);
      out += fmt::format("\n  elemental real(dp) function {}({}) result(value)\n    real(dp), intent(in) :: {}\n",
                         body.name, fmt::join(body.arguments, ", "), fmt::join(body.arguments, ", "));
      for (const std::string& local : locals) out += fmt::format("    real(dp) :: {}\n", local);
      if (!body.sums.empty()) out += "    integer :: q\n";
      out += assignments(body.first, "    ", "");
      for (const Sum& sum : body.sums) {
        out += fmt::format("    do q = 1, {}\n{}    end do\n", sum.points.size(), assignments(sum.each, "      ", ""));
      }
      out += fmt::format("    value = {}\n  end function {}\n", body.value, body.name);
    }
    return out + "end module scene\n";
  }
};

class Julia : public Language {
 public:
  std::string_view name() const override { return "julia"; }
  std::string function(Op op) const override { return op == Op::atan2 ? "atan" : usual_name(op); }
  std::string power(const std::string& base, const std::string& exponent) const override {
    return base + "^" + exponent;
  }
  std::string choice(const std::string& p, const std::string& q, const std::string& a,
                     const std::string& b) const override {
    return fmt::format("ifelse({} <= {}, {}, {})", p, q, a, b);
  }
  std::string entry(const std::string&, std::string_view array) const override { return std::string(array); }

  std::string write(const Program& program) const override {
    std::string out = comment(program.about, "#") + "module Scene\n\n";
    for (const auto& [name, value] : program.constants) out += fmt::format("const {} = {}\n", name, number(value));
    for (const Sum* sum : rules_of(program)) {
      for (const auto& [array, values] :
           {std::pair("node", &sum->points.node), std::pair("weight", &sum->points.weight)}) {
        out += fmt::format("const {}_{} = [\n    {},\n]\n", sum->rule, array, entries(*this, *values, ",\n    "));
      }
    }
    for (const Body& body : program.functions) {
      out += fmt::format("\nfunction {}({})\n{}", body.name, fmt::join(body.arguments, ", "),
                         assignments(body.first, "    ", ""));
      for (const Sum& sum : body.sums) {
        out += fmt::format("    for (node, weight) in zip({0}_node, {0}_weight)\n{1}    end\n", sum.rule,
                           assignments(sum.each, "        ", ""));
      }
      out += fmt::format("    return {}\nend\n", body.value);
    }
    return out + "\nend\n";
  }
};

/// For programs that write code, or evaluate expressions: the same functions as data.
class Json : public Language {
 public:
  std::string_view name() const override { return "json"; }
  std::string function(Op op) const override { return usual_name(op); }
  std::string power(const std::string& base, const std::string& exponent) const override {
    return base + "^" + exponent;
  }
  std::string choice(const std::string& p, const std::string& q, const std::string& a,
                     const std::string& b) const override {
    return fmt::format("if({} <= {}, {}, {})", p, q, a, b);
  }
  std::string entry(const std::string&, std::string_view array) const override { return std::string(array); }

  std::string write(const Program& program) const override {
    using json = nlohmann::ordered_json;
    const auto as_json = [](const std::vector<Statement>& statements) {
      json all = json::array();
      for (const auto& [name, value, adds] : statements)
        all.push_back({{adds ? "add_to" : "set", name}, {"value", value}});
      return all;
    };
    json root = {{"format", "acstudy-scene-1"}, {"about", program.about}};
    for (const auto& [name, value] : program.constants) root["constants"][name] = value;
    root["rules"] = json::object();
    for (const Sum* sum : rules_of(program)) {
      root["rules"][sum->rule] = {{"node", sum->points.node}, {"weight", sum->points.weight}};
    }
    for (const Body& body : program.functions) {
      json& one = root["functions"][body.name];
      one = {{"arguments", body.arguments}, {"first", as_json(body.first)}};
      for (const Sum& sum : body.sums) one["sums"].push_back({{"over", sum.rule}, {"each", as_json(sum.each)}});
      one["value"] = body.value;
    }
    return root.dump(2) + "\n";
  }
};

const Python python;
const C c;
const Fortran fortran;
const Julia julia;
const Json json;
const Language* const languages[] = {&python, &c, &fortran, &julia, &json};

}  // namespace

std::string Language::number(double value) const {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

const Language* find_language(std::string_view name) {
  for (const Language* language : languages) {
    if (language->name() == name) return language;
  }
  return nullptr;
}

std::vector<std::string> language_names() {
  std::vector<std::string> names;
  for (const Language* language : languages) names.emplace_back(language->name());
  return names;
}

}  // namespace acstudy::code
