#include "studies/commands/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "studies/commands/terminal.hpp"

namespace acstudy {

namespace {

std::string departure(const Row& row) {
  return fmt::format("{}, expected {}: {}", row.verdict, row.expected, row.reason);
}

std::string begin_of(const Row& row) { return row.passes ? "ok" : "DEPART"; }

/// A line of a row with its first word in color.
std::string painted(const std::string& line, const Row& row) {
  const std::string word = begin_of(row);
  if (line.rfind(word, 0) != 0) return line;
  return colored(word, row.passes ? Color::green : Color::red) + line.substr(word.size());
}

/// Text for XML 1.0 content and attributes. White space but the blank is written as a reference: an attribute would
/// lose it.
std::string xml(std::string_view text) {
  constexpr std::string_view replacement = "\xEF\xBF\xBD", no_character = "\xEF\xBF\xBE", nor_this = "\xEF\xBF\xBF";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\t' || c == '\n' || c == '\r') {
      out += fmt::format("&#{};", c);
    } else if (c < 0x20) {
      out += replacement;
    } else if (const auto three = text.substr(i, 3); three == no_character || three == nor_this) {
      out += replacement;
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

/// The message of a workflow command, and with `property` one of its properties, whose separators are escaped as well.
std::string workflow_escape(std::string_view text, bool property) {
  std::string out;
  for (const char c : text) {
    const bool escaped = c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ','));
    out += escaped ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out;
}

}  // namespace

std::size_t departing_in(std::span<const Row> rows) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.passes; }));
}

std::string table_text(const std::vector<Row>& rows, std::size_t width) {
  std::size_t study = 5, name = 4, observed = 8, verdict = 7;  // as wide as the headings at least
  for (const Row& row : rows) {
    study = std::max(study, row.study.size());
    name = std::max(name, row.name.size());
    observed = std::max(observed, row.observed.size());
    verdict = std::max(verdict, row.verdict.size());
  }
  constexpr std::size_t gate = 6, between = 2;
  std::string out;
  if (gate + study + name + observed + verdict + 4 * between > width) {
    for (const Row& row : rows) out += record_text(row, width);
    return out;
  }
  const auto line = [&](const std::string& begin, const Row& row, const std::string& end) {
    const std::string text = fmt::format("{:<{}}  {:<{}}  {:<{}}  {:<{}}  {}", begin, gate, row.study, study, row.name,
                                         name, row.observed, observed, end);
    return painted(wrapped(text, width, gate + between), row) + "\n";
  };
  out =
      line("gate", {.study = "study", .name = "name", .observed = "observed", .reason = {}, .passes = true}, "verdict");
  for (const Row& row : rows) out += line(begin_of(row), row, row.passes ? row.verdict : departure(row));
  return out;
}

std::string record_text(const Row& row, std::size_t width) {
  constexpr std::size_t indent = 8;
  const std::string observed = row.observed == "-" ? "" : row.observed + "  ";
  const std::string what = fmt::format("{:<{}}{}: {}", begin_of(row), indent, row.study, row.name);
  const std::string came_of_it =
      fmt::format("{:{}}{}{}", "", indent, observed, row.passes ? row.verdict : departure(row));
  return painted(wrapped(what, width, indent), row) + "\n" + wrapped(came_of_it, width, indent) + "\n";
}

std::string count_text(const std::vector<Row>& rows) {
  return fmt::format("{} gates, {} depart\n", rows.size(), departing_in(rows));
}

std::string junit_text(const std::vector<Row>& rows) {
  const auto counts = [](std::span<const Row> some) {
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\"", some.size(), departing_in(some));
  };
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"acstudy\" {}>\n", counts(rows));
  for (auto begin = rows.begin(); begin != rows.end();) {
    const auto end = std::find_if(begin, rows.end(),
                                  [&](const Row& row) { return row.file != begin->file || row.study != begin->study; });
    out += fmt::format("  <testsuite name=\"{}\" {} skipped=\"0\">\n", xml(begin->study), counts({begin, end}));
    for (; begin != end; ++begin) {
      out += fmt::format("    <testcase name=\"{}\" classname=\"{}\"", xml(begin->name), xml(begin->study));
      if (begin->passes) {
        out += "/>\n";
        continue;
      }
      out += fmt::format(">\n      <failure message=\"{}\" type=\"{}\">observed {}\n{}</failure>\n    </testcase>\n",
                         xml(departure(*begin)), xml(begin->verdict), xml(begin->observed), xml(departure(*begin)));
    }
    out += "  </testsuite>\n";
  }
  return out + "</testsuites>\n";
}

std::string github_text(const std::vector<Row>& rows) {
  std::string out;
  for (const Row& row : rows) {
    if (row.passes) continue;
    out += fmt::format("::error file={},title={}::{}\n", workflow_escape(row.file, true),
                       workflow_escape(row.study + ": " + row.name, true), workflow_escape(departure(row), false));
  }
  return out;
}

}  // namespace acstudy
