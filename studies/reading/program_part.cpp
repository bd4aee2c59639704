#include "studies/reading/program_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>

#include "studies/cases/checksum.hpp"
#include "studies/models/outside_program.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

constexpr const char* command_example = "command = [\"python3\", \"solver.py\"]";
constexpr double usual_timeout = 600.0;

/// The entries of a list of texts.
std::vector<std::string> read_words(const Table& table, std::string_view key, std::string_view example) {
  std::vector<std::string> words;
  for (const toml::node& item : table.list(key, example)) {
    const auto word = item.value_exact<std::string>();
    if (!word || word->empty() || word->find('\0') != std::string::npos) {
      table.place(item).fail(fmt::format("{} contains {}; every entry must be a text that is not empty: write {}", key,
                                         Table::described(item), example));
    }
    words.push_back(*word);
  }
  return words;
}

/// Null if there is no such file.
std::optional<OutsideProgram::Input> read_input(const fs::path& folder, const std::string& file) {
  std::error_code none;
  if (!fs::is_regular_file(folder / file, none)) return std::nullopt;
  std::ifstream in(folder / file, std::ios::binary);
  std::uint64_t sum = checksum({});
  std::array<char, 1 << 16> block{};
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    sum = checksum({block.data(), static_cast<std::size_t>(in.gcount())}, sum);
  }
  if (!in.eof()) return std::nullopt;
  return OutsideProgram::Input{file, sum};
}

}  // namespace

bool programs_alone(const Table& root) {
  const toml::node* const schemes = root.find("scheme");
  if (schemes == nullptr || !schemes->is_array_of_tables()) return false;  // whoever needs them says so
  const std::vector<Table> tables = root.array_of_tables("scheme");
  return std::all_of(tables.begin(), tables.end(), is_program);
}

std::shared_ptr<const OutsideProgram> read_program(const Table& scheme) {
  for (const char* const key : {"model", "divergence", "kernel", "mu"}) {
    if (scheme.find(key) == nullptr) continue;
    scheme.place(*scheme.find("command"))
        .fail(
            fmt::format("command stands beside {}, which is of a scheme of acstudy; leave out one or the other", key));
  }
  auto program = std::make_shared<OutsideProgram>();
  program->command = read_words(scheme, "command", command_example);
  program->folder = fs::path(scheme.file()).parent_path().string();
  program->label =
      scheme.find("label") != nullptr ? scheme.text("label", "label = \"upwind\"") : program->command_line();
  if (program->label.empty() || std::any_of(program->label.begin(), program->label.end(), is_control)) {
    scheme.place(*scheme.find("label")).fail("a label is one line of text, for example \"upwind\"");
  }
  const toml::node& order = scheme.need("order", "order = 1");
  program->order = scheme.number("order", order);
  if (program->order < 0.0) {
    scheme.place(order).fail(fmt::format("order = {}; an order must be finite and not negative", program->order));
  }
  if (const toml::node* const expect = scheme.find("expect")) program->expect = read_expected(scheme, *expect);
  const toml::node* const timeout = scheme.find("timeout");
  program->timeout = timeout != nullptr ? scheme.seconds("timeout", *timeout) : usual_timeout;

  for (const std::string& word : program->command) {
    // A word without a folder at the begin is looked for on the PATH.
    const bool on_path = &word == &program->command.front() && word.find('/') == std::string::npos;
    if (on_path) continue;
    if (const auto input = read_input(program->folder, word)) program->inputs.push_back(*input);
  }
  if (scheme.find("inputs") != nullptr) {
    constexpr const char* example = "inputs = [\"solver.py\"]";
    const std::vector<std::string> files = read_words(scheme, "inputs", example);
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto input = read_input(program->folder, files[i]);
      if (!input) {
        scheme.place(scheme.list("inputs", example)[i])
            .fail(fmt::format("inputs contains {}, but there is no such file that can be read; names are relative to "
                              "the study file",
                              in_quotes(files[i])));
      }
      program->inputs.push_back(*input);
    }
  }
  return program;
}

Theory theory_of(const OutsideProgram& program, const PathChoice& path, bool fixed_horizon) {
  const bool by_spacing = path.nonlocal_source || fixed_horizon || path.delta.text() == "h";
  return {by_spacing ? "h" : "max(h,delta)", program.order, "given by the study"};
}

}  // namespace acstudy
