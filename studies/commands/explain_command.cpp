#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/explain.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/kinds/study_file.hpp"

namespace acstudy {

Command explain_command() {
  const auto files = std::make_shared<std::vector<std::string>>();
  return {"explain",
          "Print what a study computes and what it leaves out; computes nothing",
          {{.name = "STUDY.toml", .target = files.get(), .help = "study files", .required = true}},
          [files](const std::string&) {
            for (const Study& study : read_studies(*files)) fmt::print("{}", fitted(explain(study)));
            return done;
          },
          {{"explain studies/fig2.toml", "its cases, what theory promises, and what it leaves out"},
           {"explain my-study.toml | less", "whether a study of your own asks for what you mean"}}};
}

}  // namespace acstudy
