#include "studies/reading/toml_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "studies/reading/nearest.hpp"

namespace acstudy {

namespace {

/// Control characters of a quoted value spelled out: a message is one line.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n') {
      line += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      line += fmt::format("\\x{:02x}", static_cast<int>(c));
    } else {
      line += c;
    }
  }
  return line;
}

/// Where the value of the line "key = value" begins, and the value, if it is an expression or a word that is not in
/// quotes; else an empty one.
std::pair<std::size_t, std::string> unquoted_value(std::string_view text, std::size_t line) {
  for (; line > 1 && text.find('\n') != std::string_view::npos; --line) text.remove_prefix(text.find('\n') + 1);
  text = text.substr(0, text.find_first_of("#\r\n"));
  const std::size_t begin = text.find_first_not_of(" \t", std::min(text.find('='), text.size() - 1) + 1);
  if (begin == std::string_view::npos) return {};
  std::string value(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
  const bool other = value.find_first_of("'[{") == 0 || value.find('"') != std::string::npos;
  const bool expression = std::any_of(value.begin(), value.end(), [](unsigned char c) {
    return std::isalpha(c) != 0 || std::string_view("*/^()+").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return other || !expression ? std::pair<std::size_t, std::string>{} : std::pair{begin, std::move(value)};
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    if (const auto [begin, value] = unquoted_value(text, at.line); !value.empty()) {
      Place{file, at.line, static_cast<std::uint32_t>(begin + 1)}.fail(
          fmt::format("{} stands without quotes; put it in quotes: {}", value, in_quotes(value)));
    }
    Place{file, at.line, at.column}.fail("not TOML: " + std::string(error.description()));
  }
}

std::string Place::text(const std::string& message) const {
  if (file == of_options) return fmt::format("{}: {}", file, on_one_line(message));
  return fmt::format("{}:{}:{}: {}", file, line, column, on_one_line(message));
}

void Place::fail(const std::string& message) const { throw InputError(text(message)); }

void Table::allow(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
      at(key.source())
          .fail(fmt::format("unknown key {} in {}; known keys: {}{}", in_quotes(key.str()), title_,
                            fmt::join(known, ", "), did_you_mean(key.str(), known)));
    }
  }
}

void Table::allow(std::span<const Key> keys, std::string_view inner) const {
  std::vector<std::string> known;
  for (const Key& key : keys) {
    const std::size_t dot = key.name.find('.');
    const bool nested = dot != std::string_view::npos;
    if ((nested ? key.name.substr(0, dot) : "") == inner) known.emplace_back(key.name.substr(nested ? dot + 1 : 0));
  }
  allow(known);
}

const toml::node& Table::need(std::string_view key, std::string_view example) const {
  const toml::node* const node = find(key);
  if (node == nullptr) miss(fmt::format("{} has no \"{}\"; write, for example, {}", title_, key, example), example);
  return *node;
}

void Table::refuse(std::string_view key, const toml::node& node, const std::vector<std::string>& known) const {
  std::vector<std::string> quoted;
  for (const std::string& word : known) quoted.push_back('"' + word + '"');
  place(node).fail(fmt::format("{} = {}; it must be one of {}{}", key, described(node), fmt::join(quoted, ", "),
                               did_you_mean(node.value_or(std::string()), known)));
}

void Table::miss(const std::string& message, std::string_view example) const {
  throw MissingKey(place().text(message), &table_, title_, place(), std::string(example));
}

std::string Table::text(std::string_view key, const toml::node& node, std::string_view example) const {
  if (const auto value = node.value_exact<std::string>()) return *value;
  place(node).fail(fmt::format("{} must be a string, not {}; write, for example, {}", key, described(node), example));
}

std::string Table::expression_text(std::string_view key, const toml::node& node, std::string_view example,
                                   std::size_t& offset) const {
  offset = 0;
  if (node.is_floating_point()) return fmt::format("{:.17g}", number(key, node));
  if (const auto value = node.value_exact<std::int64_t>()) return fmt::format("{}", *value);
  offset = 1;
  if (const auto value = node.value_exact<std::string>()) return *value;
  place(node).fail(fmt::format("{} must be an expression or a number, not {}; write, for example, {}", key,
                               described(node), example));
}

Expression Table::expression(std::string_view key, const toml::node& node, std::string_view example,
                             const std::vector<std::string>& variables) const {
  std::size_t offset = 0;
  const std::string text = expression_text(key, node, example, offset);
  try {
    return Expression(text, variables);
  } catch (const ExpressionError& error) {
    const bool too_long = text.size() > Expression::most_letters;  // then the error begins with the text
    const std::string said = too_long ? "" : " = " + in_quotes(text);
    place(node).shifted(offset + error.position).fail(fmt::format("{}{}: {}", key, said, error.what()));
  }
}

double Table::number(std::string_view key, const toml::node& node) const {
  const auto value = node.value<double>();
  if (!value || !node.is_number()) place(node).fail(fmt::format("{} must be a number, not {}", key, described(node)));
  if (!std::isfinite(*value)) place(node).fail(fmt::format("{} = {}; it must be finite", key, described(node)));
  return *value;
}

double Table::seconds(std::string_view key, const toml::node& node) const {
  constexpr std::pair<std::string_view, double> units[] = {{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}};
  double value = 0.0;
  if (const auto text = node.value_exact<std::string>()) {
    std::istringstream in(*text);
    double count = 0.0;
    std::string unit, rest;
    const bool two_words = in >> count >> unit && !(in >> rest);
    for (const auto& [name, factor] : units) {
      if (two_words && unit == name) value = factor * count;
    }
  } else if (node.is_number()) {
    value = number(key, node);
  }
  constexpr double most = 1e7;
  if (!(value > 0.0 && value <= most)) {
    place(node).fail(
        fmt::format("{} = {}; it is a time of at most {:g} s with its unit, s, min or h: write {} = \"60 s\"", key,
                    described(node), most, key));
  }
  return value;
}

std::int64_t Table::whole(std::string_view key, const toml::node& node, std::int64_t least, std::int64_t most) const {
  const auto value = node.value_exact<std::int64_t>();
  if (!value || *value < least || *value > most) {
    place(node).fail(
        fmt::format("{} = {}; it must be a whole number from {} to {}", key, described(node), least, most));
  }
  return *value;
}

const toml::array& Table::list(std::string_view key, std::string_view example) const {
  const toml::node& node = need(key, example);
  const toml::array* const array = node.as_array();
  if (array == nullptr || array->empty()) {
    place(node).fail(fmt::format("{} must be a list, not {}; write, for example, {}", key,
                                 array == nullptr ? described(node) : "an empty list", example));
  }
  return *array;
}

std::vector<Table> Table::array_of_tables(std::string_view key) const {
  const toml::node* const node = find(key);
  const std::string title = fmt::format("[[{}]]", key);
  if (node == nullptr) {
    const Place at{file_, 1, 1};
    throw MissingKey(at.text(fmt::format("the study has no {}; add at least one", title)), &table_, "", at, title);
  }
  const toml::array* const array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    place(*node).fail(fmt::format("{} must be a list of tables; write {} above its keys", key, title));
  }
  std::vector<Table> tables;
  for (const toml::node& item : *array) tables.emplace_back(*item.as_table(), title, file_);
  return tables;
}

Table Table::sub_table(std::string_view key) const {
  const toml::node* const node = find(key);
  if (node == nullptr) {
    const Place at{file_, 1, 1};
    const std::string title = fmt::format("[{}]", key);
    throw MissingKey(at.text(fmt::format("the study has no {}; add it", title)), &table_, "", at, title);
  }
  if (!node->is_table()) place(*node).fail(fmt::format("{0} must be a table; write [{0}] above its keys", key));
  return {*node->as_table(), fmt::format("[{}]", key), file_};
}

std::string Table::described(const toml::node& node) {
  std::ostringstream out;
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  if (const auto value = node.value_exact<std::string>()) return in_quotes(*value);
  if (const auto value = node.value_exact<double>()) {
    const std::string text = fmt::format("{}", *value);
    return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
  }
  node.visit([&](const auto& n) { out << n; });
  return out.str();
}

}  // namespace acstudy
