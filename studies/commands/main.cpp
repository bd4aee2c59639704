/// @file
/// The command line: acstudy run | check | compare | fit | bench | explain | list.

#include "studies/commands/command.hpp"

int main(int argc, char** argv) {
  using namespace acstudy;
  return run_command_line({run_command(), check_command(), compare_command(), fit_command(), bench_command(),
                           explain_command(), list_command()},
                          argc, argv);
}
