#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

#include "mms/code/scene_code.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/fit/number_table.hpp"
#include "studies/models/scheme.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

struct SceneRequest {
  std::string scene, source = "local";
  std::optional<std::string> model, divergence, kernel, language, points;
  std::optional<double> delta, mu, time;
};

/// A named scene, or that of a study file.
std::shared_ptr<const Scene> scene_of(const std::string& name) {
  if (name.find_first_of("./") == std::string::npos) {
    const toml::table document = parse_toml(fmt::format("[scene]\nuse = '{}'\n", name), of_options);
    return read_scene(Table(document, of_options, of_options).sub_table("scene"));
  }
  std::ifstream in(name, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    throw InputError(
        fmt::format("{}: cannot be read; name a scene that acstudy list scenes prints, or a study file", name));
  }
  const toml::table document = parse_toml(text.str(), name);
  return read_scene(Table(document, "the study", name).sub_table("scene"), Solution::may_be_unknown);
}

/// The scheme of the options, read as that of a study file is.
SchemeEntry scheme_of(const SceneRequest& request, const Scene& scene) {
  std::string text = "[[scheme]]\n";
  if (request.model) text += fmt::format("model = {}\n", *request.model);
  if (request.divergence) text += fmt::format("divergence = \"{}\"\n", *request.divergence);
  if (request.kernel) {
    const bool table = request.kernel->starts_with('{');
    text += table ? fmt::format("kernel = {}\n", *request.kernel) : fmt::format("kernel = \"{}\"\n", *request.kernel);
  }
  if (request.mu) text += fmt::format("mu = {:.17g}\n", *request.mu);
  const toml::table document = parse_toml(text, of_options);
  return read_schemes(Table(document, of_options, of_options), scene).front();
}

/// Absent: the source is local, or given.
std::optional<NonlocalModel> model_of(const SceneRequest& request, const Scene& scene, std::string& words) {
  if (request.source == "local") {  // that of every model
    words = scene.solved() ? "of the PDE" : "as given";
    return {};
  }
  if (!scene.solved()) {
    throw InputError("--source nonlocal; the scene has no exact solution to make a source of: write u in [scene]");
  }
  if (!request.delta) throw InputError("--source nonlocal needs a horizon; write, for example, --delta 0.1");
  if (!(*request.delta > 0.0 && *request.delta < 0.5 * scene.period())) {
    throw InputError(fmt::format("--delta {}; a horizon is positive and below half the period, {:.6g}", *request.delta,
                                 0.5 * scene.period()));
  }
  const auto [scheme, mu] = scheme_of(request, scene);
  words = fmt::format("of {}, delta = {}", scheme_label(scheme, scene.standing()), *request.delta);
  if (scheme.model->viscous) words += fmt::format(", mu = {}", mu);
  return nonlocal_model(scheme, mu, *request.delta);
}

/// What is known at points, as CSV.
void print_values(const Scene& scene, const NonlocalModel* model, const std::string& file, double t) {
  const NumberTable table(file);
  const std::size_t column = table.has("x") ? table.column("x", "--at") : 0;
  std::vector<double> x;
  for (std::size_t row = 0; row < table.rows(); ++row) x.push_back(table.number(row, column));
  const std::size_t N = x.size();
  const std::unique_ptr<Source> source = model != nullptr ? nonlocal_source(scene, *model) : local_source(scene);
  std::vector<double> c(N), b(N), u(N), f(N);
  scene.c(x, c);
  if (!scene.standing()) scene.b(x, b);
  if (scene.solved()) scene.u(x, t, u);
  source->place(x);
  source->evaluate(t, f);
  fmt::print("x,c{}{},f\n", scene.standing() ? "" : ",b", scene.solved() ? ",u" : "");
  for (std::size_t i = 0; i < N; ++i) {
    fmt::print("{},{}", x[i], c[i]);
    if (!scene.standing()) fmt::print(",{}", b[i]);
    if (scene.solved()) fmt::print(",{}", u[i]);
    fmt::print(",{}\n", f[i]);
  }
}

int print_scene(const SceneRequest& request) {
  if (!request.language && !request.points) {
    throw InputError("scene prints code or values; write --language python, or --at points.csv --time 0.5");
  }
  const std::shared_ptr<const Scene> scene = scene_of(request.scene);
  std::string words;
  const std::optional<NonlocalModel> model = model_of(request, *scene, words);
  const NonlocalModel* const nonlocal = model ? &*model : nullptr;
  try {
    if (request.points) {
      if (!std::isfinite(*request.time)) throw InputError("--time is not finite; write --time 0.5");
      print_values(*scene, nonlocal, *request.points, *request.time);
      return done;
    }
    const SceneText& text = scene->text();
    std::vector<std::string> about = {
        fmt::format("Scene {}: u_t + (c u)_x = f(x, t), period {}, up to t = {}.", request.scene, text.period, text.T),
        "c = " + text.c};
    if (!scene->standing()) about.push_back("b = " + *text.b + ", the velocity of particles");
    about.push_back(scene->solved() ? "u = " + text.u : "u = " + *text.u0 + " at t = 0");
    about.push_back("The source is that " + words + ". Written by acstudy scene.");
    fmt::print("{}", code::scene_code(*scene, nonlocal, *code::find_language(*request.language), about));
  } catch (const std::domain_error& error) {
    throw InputError(error.what());
  }
  return done;
}

}  // namespace

Command scene_command() {
  const auto r = std::make_shared<SceneRequest>();
  return {"scene",
          "Print a manufactured problem, for a solver of your own: as code, or its values at points",
          {{.name = "SCENE",
            .target = &r->scene,
            .help = "a scene that acstudy list scenes prints, or a study file, for its [scene]",
            .required = true},
           {.name = "--source",
            .target = &r->source,
            .help = "that of the PDE, by default, or of a nonlocal model",
            .one_of = {"local", "nonlocal"}},
           {.name = "--model", .target = &r->model, .help = "of a nonlocal source, as in studies", .type = "NUMBER"},
           {.name = "--divergence",
            .target = &r->divergence,
            .help = "of the model, where particles move",
            .one_of = {"local", "nonlocal"}},
           {.name = "--kernel",
            .target = &r->kernel,
            .help = "of the model: a name, or a table as studies write it",
            .type = "KERNEL"},
           {.name = "--delta", .target = &r->delta, .help = "horizon of the model"},
           {.name = "--mu", .target = &r->mu, .help = "viscosity bound of Model II, max |c - b| by default"},
           {.name = "--language",
            .target = &r->language,
            .help = "print functions c, b, u and f, the source, in it",
            .one_of = code::language_names()},
           {.name = "--time", .target = &r->time, .help = "with --at: the time", .type = "T"},
           {.name = "--at",
            .target = &r->points,
            .help = "print values at the points x of a table, as CSV; -: standard input",
            .type = "POINTS.csv",
            .needs = {"--time"},
            .excludes = {"--language"}}},
          [r](const std::string&) { return print_scene(*r); },
          {{"scene lee-du-2019 --language fortran > scene.f90", "a module with c, b, u and the source f of the PDE"},
           {"scene study.toml --at points.csv --time 1", "values at points, of the scene of a study"}}};
}

}  // namespace acstudy
