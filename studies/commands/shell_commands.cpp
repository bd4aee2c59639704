/// @file
/// What a shell and `man` want to know of the commands.

#include <fmt/format.h>

#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/completion.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/manual.hpp"

namespace acstudy {

Command completion_command(const std::vector<Command>& commands) {
  const auto shell = std::make_shared<std::string>();
  return {
      "completion",
      "Print a script by which a shell completes command lines",
      {{.name = "SHELL", .target = shell.get(), .help = "bash or zsh", .required = true, .one_of = {"bash", "zsh"}}},
      [shell, &commands](const std::string&) {
        fmt::print("{}", *shell == "bash" ? bash_completion(commands) : zsh_completion(commands));
        return done;
      },
      {{"completion bash > ~/.local/share/bash-completion/completions/acstudy", "completes in every new bash"},
       {"completion zsh > ~/.zfunc/_acstudy", "completes in zsh, with ~/.zfunc on its fpath"}}};
}

Command man_command(const std::vector<Command>& commands) {
  return {"man",
          "Print the man page, in roff",
          {},
          [&commands](const std::string&) {
            fmt::print("{}", man_page(commands));
            return done;
          },
          {{"man > ~/.local/share/man/man1/acstudy.1", "for man acstudy, where the folder is there"},
           {"man | man -l -", "shows it at once"}}};
}

}  // namespace acstudy
