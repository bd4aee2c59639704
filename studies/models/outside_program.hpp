#pragma once

/// @file
/// A scheme that is a program of its own, in any language: it is told a case and gives its solution.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "solver/time/integrators.hpp"
#include "studies/models/model_card.hpp"

namespace acstudy {

/// True of a character that is not to be printed.
inline bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

struct OutsideProgram {
  /// A file that decides what the program does; with another content it is another scheme.
  struct Input {
    std::string file;
    std::uint64_t checksum;
  };
  std::vector<std::string> command;  ///< program and arguments; no shell reads them
  std::string folder;                ///< where it runs; empty: where acstudy does
  std::string label;
  double order;                   ///< that theory promises
  std::optional<Verdict> expect;  ///< in place of what paths expect
  double timeout;                 ///< seconds that a case may take
  std::vector<Input> inputs;

  /// The command in one line, for a reader.
  std::string command_line() const;
  /// Text that is equal for two programs exactly if they are to give the same.
  std::string key() const;
};

/// Stands where a scheme has its model: nothing is known of the sums of an outside program.
extern const ModelCard outside_model;
/// The same for its integrator.
inline constexpr Integrator own_steps{"its own", 0, {}};

}  // namespace acstudy
