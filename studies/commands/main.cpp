/// @file
/// The command line: acstudy run | check | compare | merge | verify | fit | bench | explain | init | schema | list |
/// scene | table | completion | man.

#include "studies/commands/command.hpp"

int main(int argc, char** argv) {
  using namespace acstudy;
  std::vector<Command> commands{run_command(),  check_command(), compare_command(), merge_command(), verify_command(),
                                fit_command(),  bench_command(), explain_command(), init_command(),  schema_command(),
                                list_command(), scene_command(), table_command()};
  commands.push_back(completion_command(commands));
  commands.push_back(man_command(commands));
  return run_command_line(commands, argc, argv);
}
