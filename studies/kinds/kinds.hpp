#pragma once

/// @file
/// The kinds of study. A kind reads its tables and says what is run, what is measured and what theory demands of it.

#include <array>
#include <string_view>

#include "studies/cases/study.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// Errors of runs along refinement paths, judged by their order. Theorems 2.6 - 2.8, 3.5 - 3.7.
void read_convergence(const Table& root, Study& study);
/// Truncation errors of the operators, no time stepping. Lemmas 2.3, 2.5, 3.2, 3.4.
void read_consistency(const Table& root, Study& study);
/// What the weights satisfy exactly or within bounds. Remarks 2.1 and 2.2, (2.3), (3.4), (3.5), Lemma 3.1.
void read_identities(const Table& root, Study& study);
/// Exact max norms of a step. Lemmas 2.4 and 3.3.
void read_stability(const Table& root, Study& study);
/// Norm, growth and spectral radius of steps over CFL number and horizon, and the sharp limits. Lemmas 2.4 and 3.3.
void read_stability_map(const Table& root, Study& study);
/// Schemes, and schemes with a mistake, before every kind of check: which check notices which mistake.
void read_controls(const Table& root, Study& study);
/// Errors over the plane of horizon and spacing, against the local and the nonlocal solution: in which limits a scheme
/// converges, and to what. Theorems 2.6 - 2.8, 3.5 - 3.7.
void read_map(const Table& root, Study& study);
/// What is to be expected at the ends of every range, and what is measured there.
void read_extremes(const Table& root, Study& study);
/// What part of the finest errors of convergence studies is of the time step, of the source's quadrature, of round-off.
void read_pollution(const Table& root, Study& study);
/// What round-off makes of weights, renormalizations and gaps, against arithmetic of 50 digits.
void read_digits(const Table& root, Study& study);
/// The judge on synthetic series whose right verdict is known.
void read_corpus(const Table& root, Study& study);
/// How often the reported interval contains the true order.
void read_coverage(const Table& root, Study& study);
/// How often the judge is firm and wrong, and how often it decides, on series of two terms.
void read_scan(const Table& root, Study& study);

/// `name` as a study file writes it in [study] kind; `read` fills what the header does not.
struct Kind {
  std::string_view name, meaning;
  void (*read)(const Table& root, Study& study);
};

/// The first one is that of a study that names none.
inline constexpr std::array kinds = {
    Kind{"convergence", "errors of runs along refinement paths", read_convergence},
    Kind{"consistency", "truncation errors of the operators, no time stepping", read_consistency},
    Kind{"identities", "what the weights satisfy, exactly or within bounds", read_identities},
    Kind{"stability", "max norm of a forward Euler step", read_stability},
    Kind{"stability-map", "where steps are stable, over CFL number and horizon", read_stability_map},
    Kind{"controls", "which check notices which deliberate mistake", read_controls},
    Kind{"map", "errors over the plane of horizon and spacing", read_map},
    Kind{"extremes", "expectation and observation at the ends of every range", read_extremes},
    Kind{"pollution", "parts of the finest errors that are not of the scheme in space", read_pollution},
    Kind{"digits", "round-off of weights and renormalizations, against 50 digits", read_digits},
    Kind{"corpus", "verdicts on synthetic series whose right verdict is known", read_corpus},
    Kind{"coverage", "how often the 95 % interval contains the true order", read_coverage},
    Kind{"scan", "how often verdicts are firm and wrong, and how often they decide", read_scan},
};

}  // namespace acstudy
