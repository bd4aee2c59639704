#include "mms/code/scene_code.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "mms/code/terms.hpp"

namespace acstudy::code {

namespace {

using Op = Expression::Op;

/// How tightly a text holds together.
enum Binding { sum, product, sign, atom };

struct Text {
  std::string text;
  Binding binding = atom;
};

/// The statements that compute a function: what is used more than once, or is long, has a name of its own.
class FunctionWriter {
 public:
  FunctionWriter(const Function& function, const Language& language) : function_(function), language_(language) {
    uses_.resize(function.terms().size());
    count(function.result());
    body_.name = function.name();
    body_.arguments = function.variables();
    body_.value = write(function.result()).text;
    // An array of points gives an array of values, also where these are all the same.
    if (!used_.contains(0)) body_.value += fmt::format(" + {}*{}", language.number(0.0), function.variables().front());
  }

  const Body& body() const { return body_; }

 private:
  static constexpr std::size_t long_text = 60;

  void count(int term) {
    if (uses_[term]++ > 0) return;
    const Term& t = function_.terms()[term];
    if (t.choice) {
      for (const int operand : {t.p, t.q, t.a, t.b}) count(operand);
    } else if (t.op != Op::constant && t.op != Op::variable) {
      count(t.a);
      if (t.b != t.a || !is_function_of_one(t.op)) count(t.b);
    }
  }

  static bool is_function_of_one(Op op) {
    switch (op) {
      case Op::add:
      case Op::subtract:
      case Op::multiply:
      case Op::divide:
      case Op::power:
      case Op::atan2:
      case Op::min:
      case Op::max:
        return false;
      default:
        return true;
    }
  }

  Text write(int term) {
    if (const auto named = names_.find(term); named != names_.end()) return {named->second};
    const Term& t = function_.terms()[term];
    const bool leaf = !t.choice && (t.op == Op::constant || t.op == Op::variable);
    Text text = written(t);
    if (leaf || (uses_[term] < 2 && text.text.size() < long_text)) return text;
    const std::string name = fmt::format("v{}", names_.size() + 1);
    body_.first.push_back({name, text.text});
    names_[term] = name;
    return {name};
  }

  std::string at_least(Binding binding, int term) {
    const Text text = write(term);
    return text.binding < binding ? "(" + text.text + ")" : text.text;
  }

  Text written(const Term& t) {
    if (t.choice) {
      const std::string p = at_least(product, t.p), q = at_least(product, t.q), a = at_least(product, t.a);
      return {language_.choice(p, q, a, at_least(product, t.b))};
    }
    switch (t.op) {
      case Op::constant:
        return {language_.number(t.constant), std::signbit(t.constant) ? sign : atom};
      case Op::variable:
        used_.insert(t.a);
        return {function_.variables()[t.a]};
      case Op::add:
      case Op::subtract: {
        const std::string a = at_least(sum, t.a);
        // Fortran has no "a - -b".
        const std::string b = at_least(product, t.b);
        const std::string right = b.front() == '-' ? "(" + b + ")" : b;
        return {fmt::format("{} {} {}", a, t.op == Op::add ? '+' : '-', right), sum};
      }
      case Op::multiply:
      case Op::divide: {
        const std::string a = at_least(product, t.a);
        return {fmt::format("{}{}{}", a, t.op == Op::multiply ? '*' : '/', at_least(atom, t.b)), product};
      }
      case Op::power: {
        const std::string base = at_least(atom, t.a);
        const Term& exponent = function_.terms()[t.b];
        const bool square = !exponent.choice && exponent.op == Op::constant && exponent.constant == 2.0;
        return square ? Text{base + "*" + base, product} : Text{language_.power(base, at_least(atom, t.b)), sign};
      }
      case Op::negate:
        return {"-" + at_least(atom, t.a), sign};
      default: {
        const std::string a = write(t.a).text;
        const std::string name = language_.function(t.op);
        return {is_function_of_one(t.op) ? fmt::format("{}({})", name, a)
                                         : fmt::format("{}({}, {})", name, a, write(t.b).text)};
      }
    }
  }

  const Function& function_;
  const Language& language_;
  std::vector<int> uses_;
  std::map<int, std::string> names_;
  std::set<int> used_;  ///< variables
  Body body_;
};

/// f = u_t + (c u)_x in every frame.
SourceFormula local_formula(const Language& in) {
  const auto of = [&](const char* name, const char* arguments) { return call(in, name, arguments); };
  return {{{"sum", fmt::format("{} + {}*{} + {}*{}", of("u_t", "x, t"), of("c", "x"), of("u_x", "x, t"), of("c_x", "x"),
                               of("u", "x, t"))}},
          {},
          {}};
}

/// All that a formula may call.
std::vector<Function> functions_of(const Scene& scene) {
  const SceneText& text = scene.text();
  std::vector<Function> all;
  const auto with_slope = [&](const std::string& name, const std::string& of) {
    all.emplace_back(name, of, std::vector<std::string>{"x"});
    all.push_back(all.back().derivative(name + "_x", 0));
  };
  with_slope("c", text.c);
  with_slope("b", scene.standing() ? "0" : *text.b);
  with_slope("c_hat", scene.standing() ? text.c : fmt::format("({}) - ({})", text.c, *text.b));
  all.push_back(all[all.size() - 2].sign("side"));
  const std::vector<std::string> x_t = {"x", "t"};
  if (scene.flow()) all.emplace_back("flow", *text.flow, x_t);
  if (scene.solved()) {
    const Function u("u", text.u, x_t);
    for (const Function& one : {u, u.derivative("u_x", 0), u.derivative("u_t", 1)}) all.push_back(one);
  } else {
    all.emplace_back("u0", *text.u0, std::vector<std::string>{"x"});
    all.emplace_back("f", text.f.value_or("0"), x_t);
  }
  return all;
}

/// Whether a function of the scene is called by a formula, or is what a solver asks for.
bool wanted(const std::string& name, const SourceFormula& formula, const Language& language) {
  for (const char* const always : {"c", "b", "flow", "u", "u0", "f"}) {
    if (name == always) return true;
  }
  // Behind a letter it is the end of another name.
  const std::string called = language.own(name) + "(";
  const auto calls = [&](const Statement& statement) {
    for (auto at = statement.value.find(called); at != std::string::npos; at = statement.value.find(called, at + 1)) {
      if (at == 0 ||
          (std::isalnum(static_cast<unsigned char>(statement.value[at - 1])) == 0 && statement.value[at - 1] != '_')) {
        return true;
      }
    }
    return false;
  };
  return std::any_of(formula.first.begin(), formula.first.end(), calls) ||
         std::any_of(formula.sums.begin(), formula.sums.end(),
                     [&](const Sum& one) { return std::any_of(one.each.begin(), one.each.end(), calls); });
}

}  // namespace

std::string call(const Language& language, const std::string& name, const std::string& arguments) {
  return fmt::format("{}({})", language.own(name), arguments);
}

std::string scene_code(const Scene& scene, const NonlocalModel* model, const Language& language,
                       const std::vector<std::string>& about) {
  SourceFormula formula;
  if (model != nullptr) {
    formula = model->continuum->formula(scene, *model, sufficient_points(scene, *model), language);
  } else if (scene.solved()) {
    formula = local_formula(language);
  }
  Program program{
      .about = about, .constants = {{"period", scene.period()}, {"final_time", scene.T()}}, .functions = {}};
  program.constants.insert(program.constants.end(), formula.constants.begin(), formula.constants.end());
  for (const Function& one : functions_of(scene)) {
    if (wanted(one.name(), formula, language)) program.functions.push_back(FunctionWriter(one, language).body());
  }
  if (scene.solved()) program.functions.push_back({"f", {"x", "t"}, formula.first, formula.sums, "sum"});
  return language.write(program);
}

}  // namespace acstudy::code
