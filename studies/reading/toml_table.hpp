#pragma once

/// @file
/// Tables of a study file that know where they stand, so that every message names file, line and column.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mms/expression.hpp"
#include "studies/models/key.hpp"
#include "studies/reading/input_error.hpp"

#define TOML_EXCEPTIONS 1
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace acstudy {

/// In place of a file, for text that has no lines: options of a command.
inline constexpr const char* of_options = "the command line";

/// A place in a study file.
struct Place {
  std::string file;
  std::uint32_t line = 0, column = 0;

  /// @throws InputError
  [[noreturn]] void fail(const std::string& message) const;
  /// A message with its place, in one line.
  std::string text(const std::string& message) const;
  Place shifted(std::size_t by) const { return {file, line, column + static_cast<std::uint32_t>(by)}; }
};

/// @throws InputError where it is not TOML. @param file  for messages
toml::table parse_toml(const std::string& text, const std::string& file);

/// A key or a table is not there that has to be.
class MissingKey : public InputError {
 public:
  MissingKey(const std::string& message, const toml::table* in, std::string its_title, Place at, std::string to_write)
      : InputError(message),
        table(in),
        title(std::move(its_title)),
        place(std::move(at)),
        example(std::move(to_write)) {}

  const toml::table* table;  ///< that it is missing in
  std::string title;         ///< of this table; empty where a table of the study is missing
  Place place;               ///< of this table
  std::string example;       ///< what to write, as TOML, perhaps with words behind a comma
};

/// A table of the study file. Every reader fails with an InputError that names the place, the value and a remedy.
class Table {
 public:
  Table(const toml::table& table, std::string title, std::string file)
      : table_(table), title_(std::move(title)), file_(std::move(file)) {}

  Place place() const { return at(table_.source()); }
  Place place(const toml::node& node) const { return at(node.source()); }
  const std::string& file() const { return file_; }

  /// Rejects keys that are not in `known`.
  void allow(const std::vector<std::string>& known) const;
  /// The same; of the keys, those of the inline table `inner`, or those of none.
  void allow(std::span<const Key> keys, std::string_view inner = "") const;

  const toml::node* find(std::string_view key) const { return table_.get(key); }
  const toml::node& need(std::string_view key, std::string_view example) const;
  /// Fails as a key that is needed and is not there does.
  [[noreturn]] void miss(const std::string& message, std::string_view example) const;

  std::string text(std::string_view key, std::string_view example) const {
    return text(key, need(key, example), example);
  }
  std::string text(std::string_view key, const toml::node& node, std::string_view example) const;

  /// An expression or a plain number, as text; `offset` becomes the distance from the node to the first character.
  std::string expression_text(std::string_view key, std::string_view example, std::size_t& offset) const {
    return expression_text(key, need(key, example), example, offset);
  }
  std::string expression_text(std::string_view key, const toml::node& node, std::string_view example,
                              std::size_t& offset) const;
  Expression expression(std::string_view key, std::string_view example,
                        const std::vector<std::string>& variables) const {
    return expression(key, need(key, example), example, variables);
  }
  Expression expression(std::string_view key, const toml::node& node, std::string_view example,
                        const std::vector<std::string>& variables) const;

  /// A finite number.
  double number(std::string_view key, const toml::node& node) const;
  /// A time in seconds, above 0: a number, or a text with its unit, "60 s", "10 min", "2 h".
  double seconds(std::string_view key, const toml::node& node) const;
  /// A whole number from `least` to `most`.
  std::int64_t whole(std::string_view key, const toml::node& node, std::int64_t least, std::int64_t most) const;
  /// The entries of a list that is not empty.
  const toml::array& list(std::string_view key, std::string_view example) const;

  /// One of a list of words.
  template <class T>
  T choice(std::string_view key, const toml::node& node, const std::vector<std::pair<std::string, T>>& words) const {
    const auto value = node.value_exact<std::string>();
    std::vector<std::string> known;
    for (const auto& [word, meaning] : words) {
      if (value && *value == word) return meaning;
      known.push_back(word);
    }
    refuse(key, node, known);
  }

  /// The tables of an array such as [[scheme]], at least one.
  std::vector<Table> array_of_tables(std::string_view key) const;
  /// A table such as [scene].
  Table sub_table(std::string_view key) const;

  static std::string described(const toml::node& node);

 private:
  [[noreturn]] void refuse(std::string_view key, const toml::node& node, const std::vector<std::string>& known) const;
  Place at(const toml::source_region& region) const { return {file_, region.begin.line, region.begin.column}; }

  const toml::table& table_;
  std::string title_;
  std::string file_;
};

}  // namespace acstudy
