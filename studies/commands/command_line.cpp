#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>

#include "build_info.hpp"
#include "mms/expression.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/manual.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/reading/nearest.hpp"
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

/// One of some words. CLI::IsMember does not know which is nearest.
CLI::Validator one_of(const std::vector<std::string>& words) {
  return {[words](const std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
            return fmt::format("{} is none of {}{}", in_quotes(text), fmt::join(words, ", "),
                               did_you_mean(text, words));
          },
          ""};
}

void add_option(CLI::App& app, const Option& option) {
  CLI::Option* const added = std::visit(
      [&]<class T>(T* target) {
        if constexpr (std::is_same_v<T, bool>) {
          return app.add_flag(option.name, *target, option.help);
        } else {
          CLI::Option* const one = app.add_option(option.name, *target, option.help);
          if constexpr (is_list<T>) {
            if (!is_positional(option)) one->allow_extra_args(false);
            if constexpr (!std::is_same_v<typename T::value_type, std::string>) one->delimiter(',');
          }
          return one;
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
  if (!option.one_of.empty()) added->check(one_of(option.one_of));
  for (const std::string& other : option.needs) added->needs(app.get_option(other));
  for (const std::string& other : option.excludes) added->excludes(app.get_option(other));
}

std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names{"--help", "-h"};
  for (const Option& option : command.options) {
    if (is_positional(option)) continue;
    for (std::string& name : spellings(option)) names.push_back(std::move(name));
  }
  return names;
}

/// What is wrong with the arguments of a command.
std::string mistake(const Command& command, const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return error.what();
  const std::vector<std::string> left = app.remaining();
  const std::string argument = left.empty() ? "" : left.front().substr(0, left.front().find('='));
  if (!argument.starts_with('-')) return error.what();
  return fmt::format("unknown option {} of {}{}", in_quotes(argument), command.name,
                     did_you_mean(argument, option_names(command)));
}

/// Says what is wrong with a command line, and where help is.
int refuse(const std::string& message, const std::string& command = "") {
  say(fmt::format("{}{} see acstudy {}--help", message, message.ends_with('?') ? "" : ";",
                  command.empty() ? "" : command + " "));
  return bad_input;
}

int refuse(const CLI::App& app, const CLI::ParseError& error, const std::vector<Command>& commands, const char* first) {
  const auto used = app.get_subcommands();
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  if (first == nullptr) return refuse(fmt::format("no command; write one of {}", fmt::join(names, ", ")));
  if (!used.empty()) {
    const std::string& name = used.front()->get_name();
    const auto named = [&](const Command& command) { return command.name == name; };
    return refuse(mistake(*std::find_if(commands.begin(), commands.end(), named), *used.front(), error), name);
  }
  if (*first == '-') {
    const std::string nearest = did_you_mean(first, {"--help", "--version"});
    return refuse(fmt::format("unknown option {}{}", in_quotes(first),
                              nearest.empty() ? "; options stand behind a command" : nearest));
  }
  const std::string nearest = did_you_mean(first, names);
  return refuse(fmt::format("unknown command {}{}", in_quotes(first),
                            nearest.empty() ? fmt::format("; write one of {}", fmt::join(names, ", ")) : nearest));
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

Option verbose_option(bool* target, const std::string& help) {
  return {.name = "-v,--verbose", .target = target, .help = help, .excludes = {"--quiet"}};
}

Option quiet_option(bool* target, const std::string& help) {
  return {.name = "-q,--quiet", .target = target, .help = help};
}

int run_command_line(const std::vector<Command>& commands, int argc, const char* const* argv) {
  CLI::App app;
  app.set_version_flag("--version", fmt::format("acstudy {}", build_info::version));
  app.require_subcommand(1);
  const std::size_t width = columns(Stream::out);
  const auto prints = [](CLI::App& whom, std::string text) {
    whom.formatter_fn(
        [text = std::move(text)](const CLI::App*, const std::string&, CLI::AppFormatMode) { return text; });
  };
  prints(app, help_text(commands, width));
  for (const Command& command : commands) {
    CLI::App* const added = app.add_subcommand(command.name, command.help);
    for (const Option& option : command.options) add_option(*added, option);
    prints(*added, help_text(command, width));
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
