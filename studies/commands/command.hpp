#pragma once

/// @file
/// The commands as data. How an argument is read and a help text is set is `command_line.cpp`'s.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace acstudy {

/// Where the value of an option goes; what stands there before is its default. A list of numbers is split at commas.
using Target = std::variant<bool*, int*, std::int64_t*, std::size_t*, double*, std::string*, std::optional<double>*,
                            std::optional<std::string>*, std::vector<std::string>*, std::vector<int>*>;

struct Option {
  std::string name;  ///< "--jobs"; without dashes that of a positional argument
  Target target;
  std::string help;
  std::string type = {};  ///< what a value is called in the help text: "DIR"
  bool required = false;
  std::optional<std::pair<double, double>> range = {};  ///< ends included
  std::vector<std::string> one_of = {};                 ///< the values that it may have; empty: any
  std::vector<std::string> needs = {}, excludes = {};   ///< options above it
};

/// A command: its options, and what it does once they are read. The targets live as long as `run` does.
struct Command {
  std::string name, help;
  std::vector<Option> options;
  std::function<int(const std::string& command_line)> run;  ///< returns an `Exit`. @throws InputError, StoreError
};

Command run_command();
Command check_command();
Command compare_command();
Command fit_command();
Command bench_command();
Command explain_command();
Command list_command();

/// Reads the command line, runs the command that it names, and returns the exit code. What goes wrong is one line on
/// stderr.
int run_command_line(const std::vector<Command>& commands, int argc, const char* const* argv);

}  // namespace acstudy
