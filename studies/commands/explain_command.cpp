#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/explain.hpp"
#include "studies/commands/forecast/plan_json.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/storing/result_record.hpp"

namespace acstudy {

namespace {

/// The error budgets in the result files of a folder.
std::vector<Finding> stored_budgets(const std::filesystem::path& folder) {
  std::vector<Finding> budgets;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().extension() != ".json") continue;
    try {
      for (FindingRecord& record : stated_json(entry.path().string()).findings) {
        if (record.finding.statement != "error budget") continue;
        for (const auto& [name, value] : record.coordinates) record.finding.coordinates.emplace_back(name, value, "");
        budgets.push_back(std::move(record.finding));
      }
    } catch (const InputError&) {
      // Other files stand there too.
    }
  }
  return budgets;
}

}  // namespace

Command explain_command() {
  struct Arguments {
    std::vector<std::string> files;
    std::string out = "reports/out";
    bool json = false;
  };
  const auto a = std::make_shared<Arguments>();
  return {"explain",
          "Print what a study computes, what it takes and what it leaves out; runs no case to its end",
          {{.name = "STUDY.toml", .target = &a->files, .help = "study files", .required = true},
           {.name = "--out",
            .target = &a->out,
            .help = "folder of results, whose error budgets say where time hides space",
            .type = "DIR"},
           {.name = "--json", .target = &a->json, .help = "print the plan for a scheduler, a record per case"}},
          [a](const std::string&) {
            const std::vector<Study> studies = read_studies(a->files);
            require_memory(studies);
            Speeds speeds;
            std::vector<StudyForecast> forecasts;
            for (const Study& study : studies) forecasts.push_back(forecast(study, speeds));
            if (a->json) {
              fmt::print("{}", plan_json(forecasts));
              return done;
            }
            const std::vector<Finding> budgets = stored_budgets(a->out);
            for (const StudyForecast& one : forecasts) fmt::print("{}", fitted(explain(one, budgets)));
            return done;
          },
          {{"explain studies/fig2.toml", "its cases, what theory promises, and what it leaves out"},
           {"explain my-study.toml | less", "whether a study of your own asks for what you mean"},
           {"explain --json my-study.toml", "its cases with predicted seconds and bytes, for a scheduler"}}};
}

}  // namespace acstudy
