#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>

#include "build_info.hpp"
#include "mms/expression.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/say.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace {

/// A real number from `low` to `high`. CLI::Range takes nan for one.
CLI::Validator real_range(double low, double high) {
  return {[low, high](const std::string& text) {
            double value = std::numeric_limits<double>::quiet_NaN();
            CLI::detail::lexical_cast(text, value);
            if (low <= value && value <= high) return std::string();
            return fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
          },
          ""};
}

template <class T>
constexpr bool is_list = requires(T value) {
  value.push_back({});
}
&&!std::is_same_v<T, std::string>;

void add_option(CLI::App& app, const Option& option) {
  CLI::Option* const added = std::visit(
      [&]<class T>(T* target) {
        if constexpr (std::is_same_v<T, bool>) {
          return app.add_flag(option.name, *target, option.help);
        } else {
          CLI::Option* const one = app.add_option(option.name, *target, option.help);
          if constexpr (requires { target->has_value(); }) return one;
          if constexpr (is_list<T>) {
            if (option.name.starts_with("--")) one->allow_extra_args(false);
            if constexpr (!std::is_same_v<typename T::value_type, std::string>) one->delimiter(',');
            if (target->empty()) return one;
          }
          return one->capture_default_str();
        }
      },
      option.target);
  if (!option.type.empty()) added->type_name(option.type);
  added->required(option.required);
  if (option.range) {
    const auto [low, high] = *option.range;
    const bool real = std::holds_alternative<double*>(option.target);
    added->check(real ? real_range(low, high)
                      : CLI::Range(static_cast<std::int64_t>(low), static_cast<std::int64_t>(high)));
  }
  if (!option.one_of.empty()) added->check(CLI::IsMember(option.one_of));
  for (const std::string& other : option.needs) added->needs(app.get_option(other));
  for (const std::string& other : option.excludes) added->excludes(app.get_option(other));
}

/// Says what is wrong with a command line.
int refuse(const CLI::App& app, const CLI::ParseError& error, const std::vector<Command>& commands, const char* first) {
  const auto used = app.get_subcommands();
  if (!used.empty() || first == nullptr) {
    say(fmt::format("{}; see acstudy {}--help", error.what(), used.empty() ? "" : used.front()->get_name() + " "));
    return bad_input;
  }
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  const std::string last = names.back();
  names.pop_back();
  say(fmt::format("unknown command {}; write {} or {}; see acstudy --help", in_quotes(first), fmt::join(names, ", "),
                  last));
  return bad_input;
}

/// Runs a command; what it throws becomes a line and an exit code.
int run(const Command& command, int argc, const char* const* argv) {
  std::string command_line;
  for (int i = 0; i < argc; ++i) command_line += (i > 0 ? " " : "") + std::string(argv[i]);
  try {
    const int status = command.run(command_line);
    if (std::fflush(stdout) != 0) {
      throw StoreError("cannot write to standard output: " + std::string(std::strerror(errno)));
    }
    return status;
  } catch (const InputError& error) {
    say(error.what());
    return bad_input;
  } catch (const std::exception& error) {
    say(error.what());
    return machine_failure;
  }
}

}  // namespace

int run_command_line(const std::vector<Command>& commands, int argc, const char* const* argv) {
  CLI::App app(
      "Verification and convergence studies of asymptotically compatible particle schemes for linear advection.");
  app.set_version_flag("--version", fmt::format("acstudy {}", build_info::version));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done and all as expected, 1 a verdict departs, 2 bad input (nothing run or written),\n"
      "3 a run failed numerically, 4 the machine failed it, 130 interrupted.");
  for (const Command& command : commands) {
    CLI::App* const added = app.add_subcommand(command.name, command.help);
    for (const Option& option : command.options) add_option(*added, option);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error, commands, argc > 1 ? argv[1] : nullptr);
  }
  for (const Command& command : commands) {
    if (app.got_subcommand(command.name)) return run(command, argc, argv);
  }
  return bad_input;
}

}  // namespace acstudy
