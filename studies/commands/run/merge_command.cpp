#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/run/tell.hpp"
#include "studies/commands/stop.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/running/stopwatch.hpp"
#include "studies/storing/origin.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

/// The folders, each once.
std::vector<fs::path> folders_of(const std::vector<std::string>& names) {
  std::vector<fs::path> folders;
  for (const std::string& name : names) {
    std::error_code error;
    if (!fs::is_directory(name, error)) {
      throw InputError(fmt::format("{}: no folder; name those that acstudy run --shard has written to", name));
    }
    const auto same = [&](const fs::path& one) { return fs::equivalent(one, name, error); };
    if (std::none_of(folders.begin(), folders.end(), same)) folders.emplace_back(name);
  }
  return folders;
}

/// The studies whose results are stored there, from the texts that are stored with them.
std::vector<Study> studies_in(const std::vector<fs::path>& folders) {
  std::map<std::string, StudyOrigin> found;
  for (const fs::path& folder : folders) {
    for (const StudyOrigin& one : stored_studies(folder)) {
      const auto [first, is_new] = found.try_emplace(one.name, one);
      if (is_new || first->second.text == one.text) continue;
      throw InputError(
          fmt::format("{}: study \"{}\" has another text than in {}; run its shares with one text, or merge them apart",
                      one.stored_in.string(), one.name, first->second.stored_in.string()));
    }
  }
  if (found.empty()) {
    throw InputError(fmt::format("{}: no results in {}; run studies with --shard first", folders.front().string(),
                                 folders.size() == 1 ? "this folder" : "these folders"));
  }
  std::vector<Study> studies;
  for (const auto& [name, one] : found) studies.push_back(parse_study(one.text, one.file));
  return studies;
}

int merge(const std::vector<std::string>& names, RunOptions options, bool verbose) {
  const std::vector<fs::path> folders = folders_of(names);
  const std::vector<Study> studies = studies_in(folders);
  prepare_folder(options.out);
  for (const fs::path& folder : folders) {
    if (!fs::equivalent(folder, options.out)) options.stores.push_back(folder);
  }
  double seconds = 0.0;
  RunResult result;
  timed(seconds, [&] { result = run_studies(studies, options, stop_on_signals()); });
  const int status = tell(result, seconds, options, verbose);
  return ended(result, status, "the same command merges anew");
}

}  // namespace

Command merge_command() {
  struct Arguments {
    std::vector<std::string> folders;
    RunOptions options;
    bool verbose = false;
    std::string out = options.out.string();
  };
  const auto a = std::make_shared<Arguments>();
  a->options.merge = true;
  return {"merge",
          "Join what shares of studies have stored, as one run would have; exit 1 if a verdict departs",
          {{.name = "DIR",
            .target = &a->folders,
            .help = "folders that acstudy run --shard has written to",
            .required = true},
           {.name = "--out", .target = &a->out, .help = "folder for DIR/<study>.h5 and .json", .type = "DIR"},
           quiet_option(&a->options.quiet, "print only what departs"),
           verbose_option(&a->verbose, "print a table of every series as well")},
          [a](const std::string& command_line) {
            a->options.out = a->out;
            a->options.command = command_line;
            return merge(a->folders, a->options, a->verbose);
          },
          {{"merge out --out out", "joins the shares that were run into one folder, and removes what they left"},
           {"merge node1 node2 node3 --out out", "joins those of three machines"}}};
}

}  // namespace acstudy
