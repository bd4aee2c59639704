#pragma once

/// @file
/// The kinds of study. A kind reads its tables and says what is run, what is measured and what theory demands of it.

#include <array>
#include <span>
#include <string_view>

#include "studies/cases/study.hpp"
#include "studies/models/key.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// `name` as a study file writes it in [study] kind; `read` fills what the header does not. A study has no other tables
/// than [study] and `tables`, and these no other keys.
struct Kind {
  std::string_view name, meaning;
  std::span<const TableKeys> tables;
  void (*read)(const Table& root, Study& study);
  bool own_schemes = false;  ///< whether it says something of a scheme of which theory here knows nothing
};

/// Errors of runs along refinement paths, judged by their order. Theorems 2.6 - 2.8, 3.5 - 3.7.
extern const Kind convergence_kind;
/// Truncation errors of the operators, no time stepping. Lemmas 2.3, 2.5, 3.2, 3.4.
extern const Kind consistency_kind;
/// What the weights satisfy exactly or within bounds. Remarks 2.1 and 2.2, (2.3), (3.4), (3.5), Lemma 3.1.
extern const Kind identities_kind;
/// Exact max norms of a step. Lemmas 2.4 and 3.3.
extern const Kind stability_kind;
/// Norm, growth and spectral radius of steps over CFL number and horizon, and the sharp limits. Lemmas 2.4 and 3.3.
extern const Kind stability_map_kind;
/// Schemes, and schemes with a mistake, before every kind of check: which check notices which mistake.
extern const Kind controls_kind;
/// Errors over the plane of horizon and spacing, against the local and the nonlocal solution: in which limits a scheme
/// converges, and to what. Theorems 2.6 - 2.8, 3.5 - 3.7.
extern const Kind map_kind;
/// What is to be expected at the ends of every range, and what is measured there.
extern const Kind extremes_kind;
/// What part of the finest errors of convergence studies is of the time step, of the source's quadrature, of round-off.
extern const Kind pollution_kind;
/// What round-off makes of weights, renormalizations and gaps, against arithmetic of 50 digits.
extern const Kind digits_kind;
/// The judge on synthetic series whose right verdict is known.
extern const Kind corpus_kind;
/// How often the reported interval contains the true order.
extern const Kind coverage_kind;
/// How often the judge is firm and wrong, and how often it decides, on series of two terms.
extern const Kind scan_kind;

/// The first one is that of a study that names none.
inline constexpr std::array kinds = {
    &convergence_kind, &consistency_kind, &identities_kind, &stability_kind, &stability_map_kind,
    &controls_kind,    &map_kind,         &extremes_kind,   &pollution_kind, &digits_kind,
    &corpus_kind,      &coverage_kind,    &scan_kind,
};

}  // namespace acstudy
