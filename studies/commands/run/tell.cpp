#include "studies/commands/run/tell.hpp"

#include <fmt/format.h>

#include "studies/commands/exit.hpp"
#include "studies/commands/run/summary.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/commands/terminal.hpp"

namespace acstudy {

int tell(const RunResult& result, double seconds, const RunOptions& options, bool verbose) {
  const RunSummary summary = summarize(result, seconds, options.out.string());
  constexpr std::size_t most_lines = 25, most_notes = 3;
  const std::size_t width = columns(Stream::out);
  if (options.quiet) {
    fmt::print("{}", departures_text(summary, width, most_lines));
    return summary.status;
  }
  const std::vector<std::string> notes = steps_beyond_bounds(result.studies, most_notes);
  for (const std::string& note : notes) say("note: " + note);
  fmt::print("{}{}", verbose ? table_text(summary.rows, table_width()) + adaptive_steps_text(result.studies) : "",
             summary_text(summary, width, most_lines - 2 * notes.size()));
  return summary.status;
}

int ended(const RunResult& result, int status, const std::string& how_to_go_on) {
  if (!result.interrupted) return status;
  say("interrupted; " + how_to_go_on);
  if (result.left_running) leave(interrupted);
  return interrupted;
}

}  // namespace acstudy
