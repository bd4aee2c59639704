#pragma once

/// @file
/// The kinds of study. A kind reads its tables and says what is run, what is measured and what theory demands of it.

#include <array>
#include <string_view>

#include "studies/study.hpp"
#include "studies/toml_table.hpp"

namespace acstudy {

/// Errors of runs along refinement paths, judged by their order. Theorems 2.6 - 2.8, 3.5 - 3.7.
void read_convergence(const Table& root, Study& study);
/// Truncation errors of the operators, no time stepping. Lemmas 2.3, 2.5, 3.2, 3.4.
void read_consistency(const Table& root, Study& study);

/// The judge on synthetic series whose right verdict is known.
void read_corpus(const Table& root, Study& study);
/// How often the reported interval contains the true order.
void read_coverage(const Table& root, Study& study);

/// `name` as a study file writes it in [study] kind; `read` fills what the header does not.
struct Kind {
  std::string_view name, meaning;
  void (*read)(const Table& root, Study& study);
};

/// The first one is that of a study that names none.
inline constexpr std::array kinds = {
    Kind{"convergence", "errors of runs along refinement paths", read_convergence},
    Kind{"consistency", "truncation errors of the operators, no time stepping", read_consistency},
    Kind{"corpus", "verdicts on synthetic series whose right verdict is known", read_corpus},
    Kind{"coverage", "how often the 95 % interval contains the true order", read_coverage},
};

}  // namespace acstudy
