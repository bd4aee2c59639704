#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/processors.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/commands/verify/verify.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/result_record.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

/// The HDF5 files that are meant: of a folder all, of a JSON file that beside it.
std::vector<fs::path> files_of(const std::vector<std::string>& names) {
  std::vector<fs::path> files;
  for (const fs::path name : names) {
    std::error_code error;
    if (fs::is_directory(name, error)) {
      const std::size_t before = files.size();
      for (const auto& entry : fs::directory_iterator(name, error)) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() == ".h5" && stem != "bench" && !stem.starts_with('.'))
          files.push_back(entry.path());
      }
      std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
      if (files.size() > before) continue;
      throw InputError(fmt::format(
          "{}: no result file (.h5) in the folder; name the one that acstudy run has written to", name.string()));
    }
    files.push_back(name.extension() == ".json" ? fs::path(name).replace_extension(".h5") : name);
    if (!fs::is_regular_file(files.back(), error)) {
      throw InputError(
          fmt::format("{}: no such file; name a result file (.h5) that acstudy run has written, which holds "
                      "the study, too",
                      files.back().string()));
    }
  }
  return files;
}

/// "3 of 40 cases and findings computed anew, equal to the last bit"
std::string summary(const Verified& found, const VerifyOptions& options) {
  const std::string equal = options.tolerance > 0.0 ? fmt::format("within {:g}, the largest difference is {:.2g}",
                                                                  options.tolerance, found.largest)
                                                    : "equal to the last bit";
  return fmt::format("{} of {} cases and findings computed anew, {}", found.computed, found.stored,
                     found.differ.empty() ? equal : fmt::format("{} differ", found.differ.size()));
}

int verify_files(const std::vector<std::string>& names, const VerifyOptions& options) {
  const std::atomic<bool>& stop = stop_on_signals();
  bool differs = false;
  for (const fs::path& file : files_of(names)) {
    const Verified found = verify(file, options, stop);
    if (found.interrupted) {
      say("interrupted; nothing is kept of what was verified");
      if (found.left_running) leave(interrupted);
      return interrupted;
    }
    fmt::print("{}: {}\n", file.string(), summary(found, options));
    for (const std::string& what : found.differ) fmt::print("  {}\n", what);
    differs = differs || !found.differ.empty();
  }
  return differs ? departs : done;
}

}  // namespace

Command verify_command() {
  struct Arguments {
    std::vector<std::string> files;
    VerifyOptions options;
    std::size_t sample = *options.sample;
    bool all = false;
  };
  const auto a = std::make_shared<Arguments>();
  a->options.jobs = available_processors();
  return {"verify",
          "Compute stored cases and findings anew and compare; exit 1 if one differs",
          {{.name = "RESULT", .target = &a->files, .help = "result files, or folders of them", .required = true},
           {.name = "--all", .target = &a->all, .help = "every case and finding"},
           {.name = "--sample",
            .target = &a->sample,
            .help = "so many of each result, the same every time; 10 by default",
            .type = "N",
            .range = {{1, 1'000'000'000}},
            .excludes = {"--all"}},
           {.name = "--tolerance",
            .target = &a->options.tolerance,
            .help = "allowed difference of numbers, relative to the largest of their kind, as on another machine; "
                    "bitwise by default",
            .type = "X",
            .range = {{0.0, 1.0}}},
           {.name = "--jobs",
            .target = &a->options.jobs,
            .help = "cases computed at the same time",
            .type = "N",
            .range = {{1, 1024}}}},
          [a](const std::string&) {
            a->options.sample = a->all ? std::nullopt : std::optional(a->sample);
            return verify_files(a->files, a->options);
          },
          {{"verify reports/out/fig2.h5", "ten of its cases, to the last bit"},
           {"verify out --all --tolerance 1e-9", "everything in a folder that comes from another machine"}}};
}

}  // namespace acstudy
