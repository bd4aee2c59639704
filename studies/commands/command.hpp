#pragma once

/// @file
/// The commands as data. How arguments are read is `command_line.cpp`'s, how help texts are set `manual.cpp`'s.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace acstudy {

/// Where the value of an option goes; what stands there before is its default. A list of numbers is split at commas.
using Target = std::variant<bool*, int*, std::int64_t*, std::size_t*, double*, std::string*, std::optional<double>*,
                            std::optional<std::string>*, std::vector<std::string>*, std::vector<int>*>;

/// Whether a target takes several values.
template <class T>
constexpr bool is_list = requires(T value) {
  value.push_back({});
}
&&!std::is_same_v<T, std::string>;

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

/// A command line that shows what a command is for.
struct Example {
  std::string line;  ///< behind the name of the program
  std::string does;
};

/// A command: its options, and what it does once they are read. The targets live as long as `run` does.
struct Command {
  std::string name, help;
  std::vector<Option> options;
  std::function<int(const std::string& command_line)> run;  ///< returns an `Exit`. @throws InputError, StoreError
  std::vector<Example> examples;                            ///< two at least
};

/// -v and --quiet, which mean the same wherever they stand; the first is to be listed behind the second.
Option verbose_option(bool* target, const std::string& help);
Option quiet_option(bool* target, const std::string& help);

Command run_command();
Command merge_command();
Command check_command();
Command compare_command();
Command verify_command();
Command fit_command();
Command bench_command();
Command explain_command();
Command init_command();
Command schema_command();
Command list_command();
Command scene_command();
Command table_command();
/// Those that print what is known of all commands. @param commands  with these; has to live as long as they do
Command completion_command(const std::vector<Command>& commands);
Command man_command(const std::vector<Command>& commands);

/// Reads the command line, runs the command that it names, and returns the exit code. What goes wrong is one line on
/// stderr.
int run_command_line(const std::vector<Command>& commands, int argc, const char* const* argv);

}  // namespace acstudy
