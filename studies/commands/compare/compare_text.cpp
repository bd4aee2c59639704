#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "studies/commands/check.hpp"
#include "studies/commands/compare/compare_output.hpp"
#include "studies/commands/compare/folded.hpp"
#include "studies/commands/compare/origin.hpp"

namespace acstudy {

namespace {

/// "1.32", "1 - 2.2e-16"; "1" is what is the same to the last bit.
std::string ratio_text(double ratio) {
  if (std::isnan(ratio)) return "-";
  if (ratio == 1.0) return "1";
  const double beyond = ratio - 1.0;
  if (std::abs(beyond) < 1e-3) return fmt::format("1{}{:.1g}", beyond < 0.0 ? "-" : "+", std::abs(beyond));
  return fmt::format("{:.3g}", ratio);
}

std::string range_text(const Tally& tally) {
  std::string text = ratio_text(tally.low);
  if (tally.low != tally.high) text += " to " + ratio_text(tally.high);
  return tally.without_ratio ? text + ", or none" : text;
}

std::string sum_text(const Sum& sum) {
  return sum.before == 0.0 && sum.after == 0.0 ? "-" : ratio_text(ratio(sum.before, sum.after));
}

/// What the runs and the values of a finding or a study have become: "errors 0.98 to 1.32 of OLD's, pairs 1".
std::string numbers_text(const Numbers& numbers) {
  std::vector<std::string> parts;
  const auto ratios = [&](const char* of, const Tally& tally) {
    if (tally.all > 0) parts.push_back(fmt::format("{} {}", of, range_text(tally)));
  };
  ratios("errors", numbers.errors);
  ratios("values", numbers.values);
  if (numbers.pairs.after > 0.0) parts.push_back("pairs " + sum_text(numbers.pairs));
  if (numbers.seconds.after > 0.0) parts.push_back("seconds " + sum_text(numbers.seconds));
  if (numbers.gone + numbers.added > 0) {
    parts.push_back(fmt::format("{} levels only in OLD, {} only in NEW", numbers.gone, numbers.added));
  }
  return parts.empty() ? "no numbers in both" : fmt::format("NEW/OLD: {}", fmt::join(parts, ", "));
}

std::string name_text(const FindingComparison& one) {
  return fmt::format("{}: {}", one.any().study, one.any().finding.label());
}

std::string side_text(const Finding& finding) {
  std::string text = fmt::format("{:<14}", name_of(finding.judgement.verdict));
  if (!std::isnan(finding.judgement.order)) text += "  " + observed_text(finding.judgement);
  if (finding.as_expected()) return text;
  return text + (std::isnan(finding.judgement.order) ? "  " : ", ") + "expected " + expected_text(finding);
}

using Block = std::vector<std::string>;

Block worsened_block(const FindingComparison& one) {
  Block lines = folded(name_text(one), "  ", "      ");
  const Finding &before = one.before->finding, &after = one.after->finding;
  append(lines, folded("OLD  " + side_text(before), "    ", "         "));
  append(lines, folded("NEW  " + side_text(after), "    ", "         "));
  append(lines, folded(numbers_text(one.numbers), "    ", "    "));
  append(lines, folded(one.why, "    ", "    "));
  return lines;
}

Block changed_block(const FindingComparison& one) {
  Block lines = folded(fmt::format("{}: {}", name_text(one), name_of(one.change)), "  ", "      ");
  const Finding &before = one.before->finding, &after = one.after->finding;
  append(lines, folded("OLD  " + side_text(before), "    ", "         "));
  append(lines, folded("NEW  " + side_text(after), "    ", "         "));
  if (one.change == Change::expected) {
    append(lines, folded(fmt::format("expected: OLD {}, NEW {}", expected_text(before), expected_text(after)), "    ",
                         "    "));
  }
  return lines;
}

Block moved_block(const FindingComparison& one) {
  Block lines = folded(name_text(one), "  ", "      ");
  const Judgement &before = one.before->finding.judgement, &after = one.after->finding.judgement;
  const std::string was = observed_text(before), is = observed_text(after);
  std::string text = was == is ? fmt::format("{}, moved by {:.1g}", was, after.order - before.order)
                               : fmt::format("OLD {}, NEW {}", was, is);
  if (before.low <= before.high && !before.contains(after.order)) text += ", outside OLD's interval";
  append(lines, folded(fmt::format("{}; {}", text, numbers_text(one.numbers)), "    ", "    "));
  return lines;
}

void print_to(std::string& text, const Block& lines) {
  for (const std::string& line : lines) text += line + "\n";
}

/// A section of a text: a heading, and as many blocks as fit into a number of lines, one at least.
std::string section(const std::string& heading, const std::vector<Block>& blocks, std::size_t most, bool all) {
  if (blocks.empty()) return "";
  std::string text = "\n" + heading + "\n";
  std::size_t lines = 0, shown = 0;
  for (const Block& block : blocks) {
    if (!all && shown > 0 && lines + block.size() > most) break;
    print_to(text, block);
    lines += block.size();
    ++shown;
  }
  if (shown < blocks.size()) text += fmt::format("  and {} more; -v shows all\n", blocks.size() - shown);
  return text;
}

/// The findings that have changed in one of these ways, the worst way first.
std::vector<const FindingComparison*> changed(const Comparison& comparison, std::initializer_list<Change> changes) {
  std::vector<const FindingComparison*> all;
  for (const Change change : changes) {
    for (const StudyComparison& study : comparison.studies) {
      for (const FindingComparison& one : study.findings) {
        if (one.change == change) all.push_back(&one);
      }
    }
  }
  return all;
}

std::vector<Block> worsened_blocks(const Comparison& comparison) {
  std::vector<Block> blocks;
  for (const StudyComparison& study : comparison.studies) {
    if (!study.worsened.empty()) {
      blocks.push_back(folded(fmt::format("{}: {}", study.any().study, study.worsened), "  ", "      "));
    }
  }
  for (const FindingComparison* one : changed(comparison, {Change::worsened})) blocks.push_back(worsened_block(*one));
  return blocks;
}

std::vector<Block> changed_blocks(const Comparison& comparison) {
  std::vector<Block> blocks;
  for (const FindingComparison* one : changed(comparison, {Change::expected, Change::improved, Change::verdict})) {
    blocks.push_back(changed_block(*one));
  }
  return blocks;
}

/// What is in one set only: whole studies first.
std::vector<Block> single_blocks(const Comparison& comparison) {
  std::vector<Block> blocks;
  for (const StudyComparison& study : comparison.studies) {
    if (study.both()) continue;
    blocks.push_back(folded(fmt::format("{}: study {}, {} verdicts", study.after == nullptr ? "OLD" : "NEW",
                                        study.any().study, study.findings.size()),
                            "  ", "      "));
  }
  for (const StudyComparison& study : comparison.studies) {
    if (!study.both()) continue;
    for (const FindingComparison& one : study.findings) {
      if (one.both()) continue;
      blocks.push_back(
          folded(fmt::format("{}: {}", one.after == nullptr ? "OLD" : "NEW", name_text(one)), "  ", "      "));
    }
  }
  return blocks;
}

/// How far an order has moved.
double movement(const FindingComparison& one) {
  const double moved = std::abs(one.after->finding.judgement.order - one.before->finding.judgement.order);
  return std::isnan(moved) ? std::numeric_limits<double>::infinity() : moved;
}

std::vector<Block> moved_blocks(const Comparison& comparison) {
  std::vector<const FindingComparison*> moved = changed(comparison, {Change::none});
  std::erase_if(moved, [](const FindingComparison* one) { return !one->numbers.orders.differs(); });
  std::stable_sort(moved.begin(), moved.end(),
                   [](const auto* one, const auto* other) { return movement(*one) > movement(*other); });
  std::vector<Block> blocks;
  for (const FindingComparison* one : moved) blocks.push_back(moved_block(*one));
  return blocks;
}

std::vector<Block> number_blocks(const Comparison& comparison) {
  std::vector<const StudyComparison*> studies;
  for (const StudyComparison& study : comparison.studies) {
    if (study.both() && study.numbers.differ()) studies.push_back(&study);
  }
  const auto distance = [](const StudyComparison* study) {
    return std::max(study->numbers.errors.distance(), study->numbers.values.distance());
  };
  std::stable_sort(studies.begin(), studies.end(),
                   [&](const auto* one, const auto* other) { return distance(one) > distance(other); });
  std::vector<Block> blocks;
  for (const StudyComparison* study : studies) {
    Tally tally = study->numbers.errors;
    tally.add(study->numbers.values);
    Block& block = blocks.emplace_back();
    constexpr std::size_t room = 26;
    std::string name = study->any().study;
    if (name.size() > room) {
      block.push_back("  " + name);
      name.clear();
    }
    block.push_back(fmt::format("  {:<{}}  {:>11}  {:<22} {:>6} {:>7}", name, room,
                                fmt::format("{}/{}", tally.equal, tally.all), range_text(tally),
                                sum_text(study->numbers.pairs), sum_text(study->numbers.seconds)));
  }
  return blocks;
}

std::string counts_text(const Comparison& comparison) {
  std::string text;
  print_to(text, folded(fmt::format("{} of {} verdicts worsened, {} improved, {} changed otherwise",
                                    comparison.count(Change::worsened), comparison.matched(),
                                    comparison.count(Change::improved),
                                    comparison.count(Change::expected) + comparison.count(Change::verdict)),
                        "", "  "));
  const Numbers& numbers = comparison.numbers;
  std::vector<std::string> equal;
  const auto say = [&](const Tally& tally, std::string words) {
    if (tally.all > 0) equal.push_back(std::move(words));
  };
  say(numbers.errors, fmt::format("errors in {} of {} cases", numbers.errors.equal, numbers.errors.all));
  say(numbers.values, fmt::format("{} of {} values", numbers.values.equal, numbers.values.all));
  say(numbers.work, fmt::format("{} of {} counts of work", numbers.work.equal, numbers.work.all));
  if (!equal.empty()) print_to(text, folded(fmt::format("bitwise equal: {}", fmt::join(equal, ", ")), "", "  "));
  return text;
}

std::string set_text(const char* which, const ResultSet& set) {
  std::string first, last;
  for (const ResultRecord& study : set.studies) {
    for (const auto& [name, value] : study.provenance) {
      if (name != "created") continue;
      first = first.empty() ? value : std::min(first, value);
      last = std::max(last, value);
    }
  }
  const std::string when = first.empty()   ? ""
                           : first == last ? " of " + first
                                           : fmt::format(" of {} to {}", first, last);
  return fmt::format("{}  {}: {} {}{}", which, set.path, set.studies.size(),
                     set.studies.size() == 1 ? "study" : "studies", when);
}

std::string values_text(const std::set<std::string>& values) {
  return values.size() == 1 ? *values.begin() : fmt::format("{} different: {}", values.size(), fmt::join(values, ", "));
}

std::string origin_text(const Comparison& comparison) {
  Block lines = folded(set_text("OLD", *comparison.before), "", "     ");
  append(lines, folded(set_text("NEW", *comparison.after), "", "     "));
  std::vector<std::string> alike, causes;
  for (const Origin& one : origins(comparison)) {
    if (!one.differs()) {
      alike.push_back(one.name == "machine" || one.name == "compiler" || one.name == "version" || one.name == "flags"
                          ? fmt::format("{} {}", one.name, *one.before.begin())
                          : one.name);
      continue;
    }
    if (one.decides) causes.push_back(one.name);
    append(lines, folded(fmt::format("{}: OLD {}, NEW {}", one.name, values_text(one.before), values_text(one.after)),
                         "     ", "       "));
  }
  if (!alike.empty()) append(lines, folded(fmt::format("the same: {}", fmt::join(alike, "; ")), "     ", "       "));
  if (comparison.numbers.differ()) {
    const std::string said =
        causes.empty() ? "nothing that decides a run differs between the two, and runs are deterministic: the study "
                         "files differ, or "
                         "the sources that measure and judge, or a file was changed"
                       : fmt::format("runs are deterministic: numbers differ because of {}, or of the study files",
                                     fmt::join(causes, ", "));
    append(lines, folded(said, "     ", "     "));
  }
  std::string text = "\n";
  print_to(text, lines);
  return text;
}

}  // namespace

std::string comparison_text(const Comparison& comparison, bool all) {
  const std::string heading = fmt::format("  {:<26}  {:>11}  {:<22} {:>6} {:>7}", "studies whose numbers differ",
                                          "equal", "NEW/OLD", "pairs", "seconds");
  return counts_text(comparison) + section("worsened", worsened_blocks(comparison), 14, all) +
         section("changed otherwise", changed_blocks(comparison), 6, all) +
         section("in one only", single_blocks(comparison), 3, all) +
         section("orders that moved, the verdict being the same", moved_blocks(comparison), 4, all) +
         section(heading.substr(2), number_blocks(comparison), 5, all) + origin_text(comparison);
}

}  // namespace acstudy
