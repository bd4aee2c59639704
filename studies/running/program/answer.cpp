#include "studies/running/program/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "studies/cases/checksum.hpp"
#include "studies/models/operator.hpp"
#include "studies/models/outside_program.hpp"
#include "studies/running/outcome.hpp"
#include "studies/running/program/npy.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Where particles start, and the values there.
PositionsAndValues at_start(const Case& c) {
  const auto count = static_cast<std::size_t>(c.N);
  PositionsAndValues start{start_positions(c.start, count, c.scene->period()), std::vector<double>(count)};
  c.scene->initial(start.x, start.u);
  return start;
}

json scene_json(const Scene& scene) {
  const SceneText& text = scene.text();
  json fields = {{"c", text.c}, {"b", text.b.value_or("0")}};
  if (scene.solved()) fields["u"] = text.u;
  if (text.u0) fields["u0"] = *text.u0;
  if (!scene.solved()) fields["f"] = text.f.value_or("0");
  if (text.flow) fields["flow"] = *text.flow;
  return fields;
}

/// The text with null where numbers are not finite, for which JSON has no word and programs have three.
std::string with_nulls(const std::string& text) {
  std::string plain;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto stands_here = [&](std::string_view word) { return text.compare(i, word.size(), word) == 0; };
    std::size_t length = 0;
    if (quoted && text[i] == '\\') {
      plain += text[i++];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted) {
      for (const std::string_view word : {"NaN", "nan", "Infinity", "-Infinity", "inf", "-inf", "-NaN", "-nan"}) {
        if (stands_here(word)) length = std::max(length, word.size());
      }
    }
    if (length > 0) {
      plain += "null";
      i += length - 1;
    } else if (i < text.size()) {
      plain += text[i];
    }
  }
  return plain;
}

json parsed(const std::string& answer) {
  if (answer.find_first_not_of(" \t\r\n") == std::string::npos) throw AnswerError("wrote nothing to stdout");
  try {
    json all = json::parse(with_nulls(answer));
    if (!all.is_object()) throw AnswerError("wrote JSON that is no object; write {\"x\": [...], \"u\": [...]}");
    return all;
  } catch (const json::parse_error& error) {
    const std::string begin = json(answer.substr(0, 60)).dump(-1, ' ', false, json::error_handler_t::replace);
    throw AnswerError(
        fmt::format("wrote {} bytes to stdout that are not JSON from byte {} on, beginning with {}; write "
                    "one object there, and all else to stderr",
                    answer.size(), error.byte, begin));
  }
}

/// A number, NaN if it is null.
double real(const json& value, const std::string& name) {
  if (value.is_null()) return unknown;
  if (!value.is_number()) throw AnswerError(fmt::format("gives a {} that is no number", name));
  return value.get<double>();
}

std::vector<double> reals(const json& all, const char* name) {
  const json& list = all.at(name);
  if (!list.is_array()) throw AnswerError(fmt::format("gives a {} that is no list", name));
  std::vector<double> values;
  values.reserve(list.size());
  for (const json& value : list) values.push_back(real(value, fmt::format("{}[{}]", name, values.size())));
  return values;
}

/// Particles within one period, from left to right.
PositionsAndValues in_order(const PositionsAndValues& given, const Case& c) {
  const auto count = static_cast<std::size_t>(c.N);
  const double period = c.scene->period();
  for (const auto& [name, values] : {std::pair("x", &given.x), std::pair("u", &given.u)}) {
    if (values->size() != count) {
      throw AnswerError(
          fmt::format("gives {} values of {}, and the case has N = {} particles", values->size(), name, count));
    }
  }
  std::vector<double> place(count);
  for (std::size_t j = 0; j < count; ++j) {
    if (!std::isfinite(given.x[j])) throw AnswerError(fmt::format("gives no finite x[{}]", j));
    place[j] = given.x[j] - period * std::floor(given.x[j] / period);
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
  PositionsAndValues sorted;
  for (const std::size_t j : order) {
    if (!sorted.x.empty() && place[j] == sorted.x.back()) {
      throw AnswerError(fmt::format("gives two particles at x = {:.17g}; the period is {:.17g}", place[j], period));
    }
    sorted.x.push_back(place[j]);
    sorted.u.push_back(given.u[j]);
  }
  return sorted;
}

void take_solution(const PositionsAndValues& given, const Case& c, CaseResult& result) {
  const Scene& scene = *c.scene;
  PositionsAndValues end = in_order(given, c);
  result.x.assign(Points(end.x));
  result.u = std::move(end.u);
  Errors errors{unknown, unknown, unknown};
  if (scene.solved()) {
    result.u_exact.resize(result.u.size());
    scene.u(end.x, scene.T(), result.u_exact);
    errors = errors_of(widths_on_line(end.x, scene.period()), scene.period(), result.u, result.u_exact);
    result.solution_linf = std::max(result.solution_linf, max_norm(result.u_exact));
  }
  result.error_linf = errors.linf;
  result.error_l1 = errors.l1;
  result.error_l2 = errors.l2;
  const auto wrong = std::find_if_not(result.u.begin(), result.u.end(), [](double u) { return std::isfinite(u); });
  if (wrong == result.u.end()) return;
  const std::ptrdiff_t particle = wrong - result.u.begin();
  result.last.time = scene.T();
  result.last.particle = particle;
  result.last.place = end.x[static_cast<std::size_t>(particle)];
  result.blow_up = fmt::format("N = {}: the solution is not finite at T, at x = {:.6g}", c.N, result.last.place);
}

constexpr const char* error_names[] = {"error_linf", "error_l1", "error_l2"};

void take_errors(const json& all, const Case& c, CaseResult& result) {
  if (!c.scene->solved()) {
    throw AnswerError("gives errors, but no solution is known here, so none can be right; write x and u");
  }
  double* const errors[] = {&result.error_linf, &result.error_l1, &result.error_l2};
  for (std::size_t i = 0; i < std::size(errors); ++i) {
    *errors[i] = all.contains(error_names[i]) ? real(all.at(error_names[i]), error_names[i]) : unknown;
    if (*errors[i] < 0.0)
      throw AnswerError(fmt::format("gives {} = {:g}; an error is not negative", error_names[i], *errors[i]));
  }
  if (!std::isfinite(result.error_linf)) result.blow_up = fmt::format("N = {}: its error is not finite", c.N);
}

void take_work(const json& work, CaseResult& result) {
  const std::pair<const char*, std::int64_t*> counts[] = {{"pairs", &result.work.pairs},
                                                          {"weight_builds", &result.work.weight_builds},
                                                          {"quadrature_points", &result.quadrature_points}};
  if (!work.is_object()) throw AnswerError("gives a work that is no object; write {\"pairs\": 1000}");
  for (const auto& [name, value] : work.items()) {
    const auto* const count = std::find_if(std::begin(counts), std::end(counts),
                                           [&, &key = name](const auto& one) { return one.first == key; });
    if (count == std::end(counts) || !value.is_number_unsigned()) {
      throw AnswerError(
          fmt::format("gives work with a \"{}\" = {}; it has whole numbers pairs, weight_builds and "
                      "quadrature_points",
                      name, value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 60)));
    }
    *count->second = value.get<std::int64_t>();
  }
}

}  // namespace

std::string case_json(const Case& c, const std::filesystem::path& files) {
  const Scene& scene = *c.scene;
  json all = {{"case", fmt::format("{:016x}", checksum(c.key()))},
              {"path", c.path},
              {"source", c.nonlocal_source ? "nonlocal" : "local"},
              {"period", scene.period()},
              {"T", scene.T()},
              {"N", c.N},
              {"h", c.h},
              {"delta", c.delta}};
  if (c.steps > 0) all.update({{"dt", c.dt}, {"steps", c.steps}});
  all["scene"] = scene_json(scene);
  const PositionsAndValues start = at_start(c);
  if (files.empty()) {
    all["x"] = start.x;
    all["u0"] = start.u;
  } else {
    write_npy(files / "start.npy", start.x, start.u);
    all["file"] = (files / "start.npy").string();
    all["answer_file"] = (files / "answer.npy").string();
  }
  return all.dump() + "\n";
}

void take_answer(const std::string& answer, const Case& c, CaseResult& result) {
  const json all = parsed(answer);
  constexpr std::string_view known[] = {"x", "u", "file", "error_linf", "error_l1", "error_l2", "seconds", "work"};
  for (const auto& [name, value] : all.items()) {
    if (std::find(std::begin(known), std::end(known), name) == std::end(known)) {
      throw AnswerError(fmt::format("gives \"{}\"; known are {}", name, fmt::join(known, ", ")));
    }
  }
  const bool fields = all.contains("x") && all.contains("u"), file = all.contains("file"),
             errors = all.contains("error_linf");
  if (fields + file + errors != 1) {
    throw AnswerError("has to give x and u, or file, or error_linf, and one of these only");
  }
  result.solution_linf = max_norm(at_start(c).u);
  if (fields) {
    take_solution({reals(all, "x"), reals(all, "u")}, c, result);
  } else if (errors) {
    take_errors(all, c, result);
  } else {
    if (!all.at("file").is_string()) throw AnswerError("gives a file that is no name");
    // Relative names are of the folder in which the program runs.
    const auto name = std::filesystem::path(c.scheme.program->folder) / all.at("file").get<std::string>();
    PositionsAndValues given;
    try {
      given = read_npy(name, static_cast<std::size_t>(c.N));
    } catch (const std::runtime_error& error) {
      throw AnswerError(fmt::format("gives a file that is none: {}", error.what()));
    }
    take_solution(given, c, result);
  }
  if (all.contains("work")) take_work(all.at("work"), result);
  if (all.contains("seconds")) {
    result.seconds = real(all.at("seconds"), "seconds");
    if (!(result.seconds >= 0.0)) throw AnswerError("gives seconds that are no time");
  }
}

}  // namespace acstudy
