#include "studies/commands/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "studies/commands/manual.hpp"

namespace acstudy {

namespace {

/// What the value of an option is completed to.
enum class Values { words, files, folders, nothing };

Values values_of(const Option& option) {
  if (!option.one_of.empty()) return Values::words;
  if (option.type == "DIR") return Values::folders;
  if (option.type == "FILE" || (is_positional(option) && option.name.find('.') != std::string::npos)) {
    return Values::files;
  }
  return Values::nothing;
}

/// "toml" of STUDY.toml; empty if any file will do.
std::string extension_of(const Option& option) {
  const std::size_t dot = is_positional(option) ? option.name.rfind('.') : std::string::npos;
  return dot == std::string::npos ? "" : option.name.substr(dot + 1);
}

std::string bash_values(const Option& option) {
  switch (values_of(option)) {
    case Values::words:
      return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\"))", fmt::join(option.one_of, " "));
    case Values::folders:
      return "COMPREPLY=($(compgen -d -- \"$cur\"))";
    case Values::files: {
      const std::string extension = extension_of(option);
      if (extension.empty()) return "COMPREPLY=($(compgen -f -- \"$cur\"))";
      return fmt::format("COMPREPLY=($(compgen -f -X '!*.{}' -- \"$cur\") $(compgen -d -- \"$cur\"))", extension);
    }
    case Values::nothing:
      break;
  }
  return "COMPREPLY=()";
}

/// Text within single quotes of a zsh specification.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string zsh_values(const Option& option) {
  switch (values_of(option)) {
    case Values::words:
      return fmt::format("({})", fmt::join(option.one_of, " "));
    case Values::folders:
      return "_files -/";
    case Values::files: {
      const std::string extension = extension_of(option);
      return extension.empty() ? "_files" : fmt::format("_files -g \"*.{}(-.)\"", extension);
    }
    case Values::nothing:
      break;
  }
  return " ";
}

std::string zsh_option(const Option& option) {
  if (is_positional(option)) {
    const bool several = written(option).ends_with("...");
    return fmt::format("'{}:{}:{}'",
                       several           ? "*"
                       : option.required ? ""
                                         : ":",
                       zsh_text(option.name), zsh_values(option));
  }
  const std::vector<std::string> names = spellings(option);
  const std::string text = zsh_text(option.help);
  const std::string value =
      is_flag(option)
          ? ""
          : fmt::format(":{}:{}", zsh_text(option.type.empty() ? "value" : option.type), zsh_values(option));
  if (names.size() == 1) return fmt::format("'{}[{}]{}'", names.front(), text, value);
  return fmt::format("'({})'{{{}}}'[{}]{}'", fmt::join(names, " "), fmt::join(names, ","), text, value);
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  return names;
}

}  // namespace

std::string bash_completion(const std::vector<Command>& commands) {
  std::string script = fmt::format(R"(# bash completion of acstudy: source <(acstudy completion bash)
_acstudy() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}}
  if [[ $COMP_CWORD -eq 1 ]]; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$cur"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
)",
                                   fmt::join(names_of(commands), " "));
  for (const Command& command : commands) {
    std::vector<std::string> options{"--help"};
    std::string values, positional = "COMPREPLY=()";
    bool has_positional = false;
    for (const Option& option : command.options) {
      const std::vector<std::string> names = spellings(option);
      if (is_positional(option)) {
        if (!has_positional) positional = bash_values(option);
        has_positional = true;
        continue;
      }
      options.insert(options.end(), names.begin(), names.end());
      if (!is_flag(option))
        values += fmt::format("        {}) {}; return ;;\n", fmt::join(names, "|"), bash_values(option));
    }
    script += fmt::format("    {})\n", command.name);
    if (!values.empty()) script += fmt::format("      case $prev in\n{}      esac\n", values);
    script += fmt::format(
        "      if [[ $cur == -* ]]; then\n        COMPREPLY=($(compgen -W '{}' -- \"$cur\"))\n      else\n        {}\n"
        "      fi ;;\n",
        fmt::join(options, " "), positional);
  }
  return script + "  esac\n}\ncomplete -o filenames -F _acstudy acstudy\n";
}

std::string zsh_completion(const std::vector<Command>& commands) {
  std::string script = R"(#compdef acstudy
# zsh completion of acstudy: source <(acstudy completion zsh), or this file as _acstudy on the fpath
_acstudy() {
  local -a commands
  commands=(
)";
  for (const Command& command : commands) {
    script += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.help));
  }
  script += R"(  )
  if (( CURRENT == 2 )); then
    _describe -t commands command commands
    _arguments '(- *)'{-h,--help}'[print this help]' '(- *)--version[print the version]'
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
)";
  for (const Command& command : commands) {
    script += fmt::format("    {})\n      _arguments '(- *)'{{-h,--help}}'[print this help]'", command.name);
    for (const Option& option : command.options) script += " \\\n        " + zsh_option(option);
    script += " ;;\n";
  }
  return script + R"(  esac
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _acstudy "$@"; else compdef _acstudy acstudy; fi
)";
}

}  // namespace acstudy
