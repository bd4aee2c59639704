#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/commands/check.hpp"
#include "studies/commands/compare/compare_output.hpp"
#include "studies/commands/compare/folded.hpp"
#include "studies/commands/compare/origin.hpp"
#include "studies/commands/terminal.hpp"

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
  if (!tally.differs()) return "equal";
  if (tally.low > tally.high) return "none";
  const std::string low = ratio_text(tally.low), high = ratio_text(tally.high);
  const std::string range = low == high ? low : fmt::format("{} to {}", low, high);
  return tally.without_ratio ? range + ", or none" : range;
}

std::string sum_text(const Sum& sum) {
  return sum.before == 0.0 && sum.after == 0.0 ? "-" : ratio_text(ratio(sum.before, sum.after));
}

std::string single_text(const Numbers& numbers) {
  return fmt::format("{} cases or points only in OLD, {} only in NEW", numbers.gone, numbers.added);
}

/// What the runs and the values of a finding have become: "NEW/OLD: errors 0.98 to 1.32, pairs 1, seconds 1.1".
std::string numbers_text(const Numbers& numbers) {
  std::vector<std::string> parts;
  const auto say = [&](const char* of, const Tally& tally) {
    if (tally.all > 0) parts.push_back(fmt::format("{} {}", of, range_text(tally)));
  };
  say("errors", numbers.errors);
  say("values", numbers.values);
  if (numbers.pairs.after > 0.0) parts.push_back("pairs " + sum_text(numbers.pairs));
  if (numbers.seconds.after > 0.0) parts.push_back("seconds " + sum_text(numbers.seconds));
  if (numbers.gone + numbers.added > 0) parts.push_back(single_text(numbers));
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

/// The verdicts of both sets on a finding, one below the other, under its name and what is said of it.
Block sides(const FindingComparison& one, const std::string& said) {
  Block lines = folded(name_text(one) + said, "  ", "      ");
  append(lines, folded("OLD  " + side_text(one.before->finding), "    ", "         "));
  append(lines, folded("NEW  " + side_text(one.after->finding), "    ", "         "));
  return lines;
}

/// @param all  the whole reason, however long it is
Block worsened_block(const FindingComparison& one, bool all) {
  constexpr std::size_t most = 2;
  Block lines = sides(one, "");
  append(lines, folded(numbers_text(one.numbers), "    ", "    "));
  const Block why = folded(one.why, "    ", "    ");
  append(lines, all ? why : shortened(why, most));
  return lines;
}

Block changed_block(const FindingComparison& one) {
  Block lines = sides(one, fmt::format(": {}", name_of(one.change)));
  if (one.change == Change::expected) {
    append(lines, folded(fmt::format("expected: OLD {}, NEW {}", expected_text(one.before->finding),
                                     expected_text(one.after->finding)),
                         "    ", "    "));
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
  append(lines, folded(fmt::format("{}; errors {}", text, range_text(one.numbers.errors)), "    ", "    "));
  return lines;
}

struct Section {
  std::string heading;
  std::vector<Block> blocks;
};

/// A heading, the first `shown` blocks and how many are left out.
std::string section_text(const Section& section, std::size_t shown) {
  std::string text = "\n" + section.heading + "\n";
  for (std::size_t i = 0; i < shown; ++i) print_to(text, section.blocks[i]);
  const std::size_t left_out = section.blocks.size() - shown;
  if (left_out > 0)
    text += fmt::format("  {}{}{}; -v shows all\n", shown > 0 ? "and " : "", left_out, shown > 0 ? " more" : "");
  return text;
}

/// How many blocks of each section fit into `room` lines: in turn one of each, the first section first.
std::vector<std::size_t> shares(const std::vector<Section>& sections, std::size_t room) {
  std::vector<std::size_t> shown(sections.size(), 0);
  std::vector<bool> full(sections.size(), false);
  while (std::count(full.begin(), full.end(), false) > 0) {
    for (std::size_t i = 0; i < sections.size(); ++i) {
      full[i] = full[i] || shown[i] == sections[i].blocks.size() || sections[i].blocks[shown[i]].size() > room;
      if (!full[i]) room -= sections[i].blocks[shown[i]++].size();
    }
  }
  return shown;
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

/// How far the numbers of a finding or a study are apart.
double distance(const Numbers& numbers) { return std::max(numbers.errors.distance(), numbers.values.distance()); }

/// Studies as a whole first, then findings whose errors have changed most.
std::vector<Block> worsened_blocks(const Comparison& comparison, bool all) {
  std::vector<Block> blocks;
  for (const StudyComparison& study : comparison.studies) {
    if (!study.worsened.empty()) {
      blocks.push_back(folded(fmt::format("{}: {}", study.any().study, study.worsened), "  ", "      "));
    }
  }
  std::vector<const FindingComparison*> worsened = changed(comparison, {Change::worsened});
  std::stable_sort(worsened.begin(), worsened.end(), [](const auto* one, const auto* other) {
    return distance(one->numbers) > distance(other->numbers);
  });
  for (const FindingComparison* one : worsened) blocks.push_back(worsened_block(*one, all));
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
  for (const bool old : {true, false}) {
    std::vector<std::string> names;
    for (const StudyComparison& study : comparison.studies) {
      if (!study.both() && old == (study.after == nullptr)) names.push_back(study.any().study);
    }
    if (names.empty()) continue;
    blocks.push_back(folded(fmt::format("{}: {} {}: {}", old ? "OLD" : "NEW", names.size(),
                                        names.size() == 1 ? "study" : "studies", fmt::join(names, ", ")),
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
  std::stable_sort(studies.begin(), studies.end(), [](const auto* one, const auto* other) {
    return distance(one->numbers) > distance(other->numbers);
  });
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
    if (study->numbers.gone + study->numbers.added > 0) block.push_back("    " + single_text(study->numbers));
    Tally others = study->numbers.others;
    for (const Tally& more : {study->numbers.norms, study->numbers.work, study->numbers.orders}) others.add(more);
    if (!tally.differs() && others.differs()) {
      block.push_back(fmt::format("    {} of {} orders, steps, counts and other norms differ",
                                  others.all - others.equal, others.all));
    }
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
  if (numbers.pairs.after > 0.0) {
    print_to(text, folded(fmt::format("in total NEW/OLD: pairs {}, seconds {} (for information)",
                                      sum_text(numbers.pairs), sum_text(numbers.seconds)),
                          "", "  "));
  }
  return text;
}

}  // namespace

std::string comparison_text(const Comparison& comparison, bool all) {
  const std::string heading = fmt::format("{:<28}  {:>11}  {:<22} {:>6} {:>7}", "studies whose numbers differ", "equal",
                                          "NEW/OLD", "pairs", "seconds");
  std::vector<Section> sections = {{"worsened", worsened_blocks(comparison, all)},
                                   {"changed otherwise", changed_blocks(comparison)},
                                   {"in one only", single_blocks(comparison)},
                                   {"orders that moved, the verdict being the same", moved_blocks(comparison)},
                                   {heading, number_blocks(comparison)}};
  std::erase_if(sections, [](const Section& section) { return section.blocks.empty(); });
  std::string text = counts_text(comparison);
  const std::string origin = origin_text(comparison, all);
  constexpr std::size_t most = 40;  // lines of the whole
  const auto lines_of = [](const std::string& of) {
    return static_cast<std::size_t>(std::count(of.begin(), of.end(), '\n'));
  };
  // A blank line, a heading and what is left out of each section.
  const std::size_t taken = lines_of(text) + lines_of(origin) + 3 * sections.size();
  const std::vector<std::size_t> shown =
      shares(sections, all ? std::numeric_limits<std::size_t>::max() : most - std::min(most, taken));
  for (std::size_t i = 0; i < sections.size(); ++i) text += section_text(sections[i], shown[i]);
  return text + origin;
}

}  // namespace acstudy
