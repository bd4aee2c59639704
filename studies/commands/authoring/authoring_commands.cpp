/// @file
/// What helps to write a study file: one to begin with, and the schema of all.

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "studies/commands/authoring/first_study.hpp"
#include "studies/commands/authoring/schema.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/output.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/storing/files.hpp"

namespace acstudy {

namespace {

int init(const std::string& name) {
  const std::string file = name.ends_with(".toml") ? name : name + ".toml";
  const std::string text = first_study(std::filesystem::path(file).stem().string());
  parse_study(text, file);
  if (std::filesystem::exists(file)) {
    throw InputError(fmt::format("{}: is there already; choose another name, or remove it", file));
  }
  require_writable(file);
  replace_atomically(file, text);
  fmt::print("{0} is written; acstudy explain {0} says what it asks, acstudy run {0} runs it\n", file);
  return done;
}

}  // namespace

Command init_command() {
  const auto name = std::make_shared<std::string>();
  return {
      "init",
      "Write a commented study file that runs as it is",
      {{.name = "NAME", .target = name.get(), .help = "of the study: writes NAME.toml", .required = true}},
      [name](const std::string&) { return init(*name); },
      {{"init my-study", "writes my-study.toml, to be changed"}, {"init paths/first", "the same in another folder"}}};
}

Command schema_command() {
  return {"schema",
          "Print the JSON Schema of study files, by which editors complete and check them",
          {},
          [](const std::string&) {
            fmt::print("{}", study_schema());
            return done;
          },
          {{"schema > acstudy.schema.json", "for an editor, or taplo lint --schema"},
           {"schema | jq .properties.time", "the keys of one table"}}};
}

}  // namespace acstudy
