#include "studies/commands/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>

#include "build_info.hpp"
#include "studies/commands/terminal.hpp"

namespace acstudy {

namespace {

constexpr const char* about =
    "Verification and convergence studies of asymptotically compatible particle schemes for linear advection.";

constexpr std::pair<int, const char*> exit_codes[] = {
    {0, "done, and all as expected"}, {1, "a verdict departs"},     {2, "bad input, nothing run or written"},
    {3, "a run failed numerically"},  {4, "the machine failed it"}, {130, "interrupted"},
};

template <class T>
constexpr bool is_list = requires(T value) {
  value.push_back({});
}
&&!std::is_same_v<T, std::string>;

bool takes_several(const Option& option) {
  return std::visit([]<class T>(T*) { return is_list<T>; }, option.target);
}

std::string default_of(const Option& option) {
  return std::visit(
      []<class T>(const T* target) -> std::string {
        if constexpr (std::is_same_v<T, bool> || requires { target->has_value(); }) {
          return "";
        } else if constexpr (is_list<T>) {
          return fmt::format("{}", fmt::join(*target, ","));
        } else {
          return fmt::format("{}", *target);
        }
      },
      option.target);
}

/// What an option does, with what its value may be and is by default.
std::string meaning(const Option& option) {
  std::string text = option.help;
  if (!option.one_of.empty() && text.find(option.one_of.front()) == std::string::npos) {
    text += fmt::format("; {}", fmt::join(option.one_of, ", "));
  }
  if (option.range) text += fmt::format("; from {:g} to {:g}", option.range->first, option.range->second);
  if (!option.needs.empty()) text += fmt::format("; goes with {}", fmt::join(option.needs, ", "));
  if (!option.excludes.empty()) text += fmt::format("; not with {}", fmt::join(option.excludes, ", "));
  const std::string by_default = default_of(option);
  return by_default.empty() ? text : fmt::format("{} ({})", text, by_default);
}

std::string usage(const Command& command) {
  std::string text = fmt::format("acstudy {} [OPTIONS]", command.name);
  for (const Option& option : command.options) {
    if (is_positional(option)) text += option.required ? " " + written(option) : fmt::format(" [{}]", written(option));
  }
  return text;
}

/// A name and what it means, in two columns.
std::string entry(const std::string& name, const std::string& text, std::size_t width) {
  constexpr std::size_t column = 22;
  const std::string begin = "  " + name;
  if (begin.size() + 2 > column) {
    return begin + "\n" + wrapped(std::string(column, ' ') + text, width, column) + "\n";
  }
  return wrapped(fmt::format("{:<{}}{}", begin, column, text), width, column) + "\n";
}

std::string sentence(std::string text) { return text + (text.empty() || text.back() == '.' ? "" : "."); }

std::string help_of_help() { return "print this help"; }

std::string codes_text(std::size_t width) {
  std::vector<std::string> said;
  for (const auto& [code, means] : exit_codes) said.push_back(fmt::format("{} {}", code, means));
  return "\n" + wrapped(fmt::format("Exit codes: {}.", fmt::join(said, "; ")), width, 2) + "\n";
}

std::string examples_text(const std::vector<Example>& examples, std::size_t width) {
  std::string text = examples.empty() ? "" : "\nExamples:\n";
  for (const Example& example : examples) {
    text += fmt::format("  acstudy {}\n", example.line) + wrapped("      " + example.does, width, 6) + "\n";
  }
  return text;
}

/// Text as roff takes it: no letter of it is a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\n') {
      out += ' ';
    } else {
      out += c;
    }
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string tagged(const std::string& tag, const std::string& text) {
  return fmt::format(".TP\n.B {}\n{}\n", roff(tag), roff(text));
}

}  // namespace

bool is_flag(const Option& option) { return std::holds_alternative<bool*>(option.target); }

bool is_positional(const Option& option) { return !option.name.starts_with('-'); }

std::vector<std::string> spellings(const Option& option) {
  std::vector<std::string> all;
  for (std::size_t at = 0; at <= option.name.size();) {
    const std::size_t comma = std::min(option.name.find(',', at), option.name.size());
    all.push_back(option.name.substr(at, comma - at));
    at = comma + 1;
  }
  return all;
}

std::string written(const Option& option) {
  if (is_positional(option)) return option.name + (takes_several(option) ? "..." : "");
  const std::string names = fmt::format("{}", fmt::join(spellings(option), ", "));
  return is_flag(option) ? names : fmt::format("{} {}", names, option.type.empty() ? "VALUE" : option.type);
}

std::string help_text(const std::vector<Command>& commands, std::size_t width) {
  std::string text = wrapped(about, width) + "\n\nUsage: acstudy COMMAND [OPTIONS]\n\nCommands:\n";
  for (const Command& command : commands) text += entry(command.name, command.help, width);
  text += "\nOptions:\n" + entry("-h, --help", help_of_help() + "; behind a command that of the command", width) +
          entry("--version", "print the version", width);
  text += examples_text({{"run studies/fig1.toml", "runs a study, judges its errors and stores both"},
                         {"explain studies/fig1.toml", "says what it would compute"},
                         {"run --help", "options of a command, with examples"}},
                        width);
  return text + codes_text(width);
}

std::string help_text(const Command& command, std::size_t width) {
  std::string text =
      wrapped(sentence(command.help), width) + "\n\n" + wrapped("Usage: " + usage(command), width, 9) + "\n\n";
  for (const Option& option : command.options) {
    if (is_positional(option)) text += entry(written(option), meaning(option), width);
  }
  text += text.ends_with("\n\n") ? "Options:\n" : "\nOptions:\n";
  for (const Option& option : command.options) {
    if (!is_positional(option)) text += entry(written(option), meaning(option), width);
  }
  text += entry("-h, --help", help_of_help(), width);
  return text + examples_text(command.examples, width) + codes_text(width);
}

std::string man_page(const std::vector<Command>& commands) {
  std::string page = fmt::format(
      ".TH ACSTUDY 1 \"\" \"acstudy {}\" \"User Commands\"\n.SH NAME\nacstudy \\- convergence studies of "
      "asymptotically "
      "compatible particle schemes\n.SH SYNOPSIS\n",
      build_info::version);
  for (const Command& command : commands) {
    page += fmt::format("{}.B {}\n", &command == &commands.front() ? "" : ".br\n", roff(usage(command)));
  }
  page += fmt::format(".SH DESCRIPTION\n{}\n.SH COMMANDS\n", roff(about));
  for (const Command& command : commands) {
    page += fmt::format(".SS {}\n{}\n", roff(command.name), roff(sentence(command.help)));
    for (const Option& option : command.options) page += tagged(written(option), meaning(option));
  }
  page += ".SH OPTIONS\n" + tagged("-h, --help", "print a help text; behind a command that of the command") +
          tagged("--version", "print the version");
  page += ".SH EXIT STATUS\n";
  for (const auto& [code, means] : exit_codes) page += tagged(fmt::format("{}", code), means);
  page += ".SH ENVIRONMENT\n" + tagged("COLUMNS", "how long lines may be; by default that of the terminal, or 80") +
          tagged("NO_COLOR", "if set, nothing is printed in color; nor is it where the output is no terminal");
  page += ".SH EXAMPLES\n";
  for (const Command& command : commands) {
    for (const Example& example : command.examples) page += tagged("acstudy " + example.line, example.does);
  }
  return page;
}

}  // namespace acstudy
