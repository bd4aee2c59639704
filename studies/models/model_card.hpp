#pragma once

/// @file
/// All that the rest of the program needs to know of a model: how it is made, and what is said of it. A file for each
/// (model1.cpp, ...) and a row for each in `model_cards`; nothing else asks which model it has before it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "mms/source.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/field_bounds.hpp"
#include "studies/models/kernel_choice.hpp"
#include "studies/models/printed_sum.hpp"

namespace acstudy {

class LineScheme;
struct SchemeChoice;

/// The fast sweep over moving particles (solver/line/vector/sweeps.hpp) that has a model's rates; none: they are
/// computed in the readable form.
enum class VectorForm { none, upwind, symmetric };

/// What weights are made of: integrals over the cells between neighbors, of the first moment of the kernel, divided by
/// the neighbor's distance, or of the kernel itself, which then has to be integrable.
enum class CellWeights { moments_over_distance, masses };

/// What the constant of an estimate may depend on.
struct EstimateAt {
  const FieldBounds& fields;
  const KernelChoice& kernel;
  bool nonlocal_divergence;
  Gaps gap;
  double delta;
};

/// One estimate of a lemma: max |operator - its limit| is O(h) against the nonlocal model, O(max(h, delta)) against the
/// PDE.
struct LemmaEstimate {
  std::string_view statement, quantity;
  bool viscous;   ///< of the term with mu; else of all the rest
  bool nonlocal;  ///< against the nonlocal model; else against the PDE
  /// C of error <= C h, or of error <= C max(h, delta), by Taylor's formula and the moments of the weights: nothing is
  /// fitted. The largest C of all horizons, which is finite, is the constant of the lemma.
  double (*constant)(const EstimateAt&);
  std::string_view second_term = {};  ///< printed beside O(h), and not small where delta is: "h^2/delta"
};

/// How theory bounds a step of forward Euler.
struct StepLemma {
  std::string_view name;            ///< "Lemma 2.4"
  std::string_view row_by_row;      ///< what its proof needs of each row, `SchemeRows::strongest_decay`, as a statement
  std::string_view sharp;           ///< what is known of that condition where c is constant
  std::string_view where_positive;  ///< where explicit steps within it have no negative entry
  std::string_view m_matrix;        ///< what is known of backward Euler's matrix
  std::string_view limit;           ///< what the step is inverse to: "c - b"
  /// w in the bound dt <= h_min / w at a smallest gap h_min.
  double (*speed)(const Scene& scene, double mu);
  bool enough_for_every_kernel;  ///< whether the printed condition is
  bool promised = true;          ///< false where nothing is known of steps
};

/// Theorems where particles stand still, and where they move with either divergence: "Theorem 2.6". Part (1) of each is
/// the limit h -> 0 at a fixed horizon, part (2) that of h and delta together.
struct Theorems {
  std::string_view standing, local, nonlocal;
};

/// What is said of the weights W_k of a particle.
struct WeightClaims {
  std::string_view not_negative, not_negative_claim;  ///< "Remark 2.2", "W_k >= 0"
  std::string_view first_moment, first_moment_claim;
};

/// The scheme with a horizon below every gap.
struct NearestNeighbors {
  std::string_view statement, claim;  ///< "Remark 2.1", "the upwind difference"
  std::string_view in_words;          ///< "the upwind difference (Remark 2.1)"
  bool bit_by_bit;                    ///< the horizon is not in the rates at all; else it cancels but for round-off
  /// Entries j - 1, j and j + 1 of row j of the matrix of rates.  @param x  at the particle
  std::array<double, 3> (*row)(const SchemeChoice&, const Scene&, double mu, double delta, const double* x);
};

/// Names of controls that show that claims about a model can fail.
struct Mistakes {
  std::string_view inconsistent;  ///< its first moment is not one
  std::string_view not_monotone;  ///< steps make new extremes, however short
  std::string_view classical;     ///< what the model improves on; empty if there is no such scheme
};

struct ModelCard {
  int number;                 ///< model = number in a study, and in stored results
  std::string_view name;      ///< "Model I"
  Theorems equations;         ///< of its schemes: "(2.4)"
  std::string_view left_out;  ///< what it does without, for `explain`

  CellWeights cell_weights;
  bool upwind;              ///< sees one side, where c_hat comes from; else both
  bool viscous;             ///< reads mu, a bound of |c - b|
  bool renormalized;        ///< its sums are divided by N_j
  bool conserves_any_sign;  ///< mass on equal gaps, also where c changes sign

  double pair_cost;        ///< of a pair, in pairs of Model I
  double row_terms;        ///< the most that the terms of a step's row within its bound sum to in absolute value
  double pde_constant;     ///< C of |rate + c u_x| <= C max(h, delta) |u_xx| at constant c, mu = |c|
  double divergence_part;  ///< of max(h, delta) |b''| |u|, by which the nonlocal divergence is off

  VectorForm vector_form;
  const ContinuumModel* continuum;  ///< the nonlocal model that it discretizes
  /// @param scene  outlives the scheme
  std::unique_ptr<LineScheme> (*make)(const SchemeChoice&, const Scene& scene, double mu);
  PrintedRate (*printed_rate)(const PrintedAt&);

  Theorems theorems;
  StepLemma step_lemma;
  std::string_view to_nonlocal, to_pde;  ///< the lemmas that its estimates are parts of
  std::span<const LemmaEstimate> estimates;
  WeightClaims weights;
  NearestNeighbors nearest;
  Mistakes mistakes;

  /// Studies name it, and theory says nothing of it but what is here; false of the paper's, which have numbers.
  bool beyond_paper = false;
  std::string_view limiter = {};  ///< what studies write beside the name: limiter = "clip"
  /// With the nonlocal divergence the unknown on moving particles is V_j u_j, not u_j.
  bool carries_volumes = false;
  /// Why what it leaves of the equation says nothing of its order; empty if that is of its order too.
  std::string_view no_truncation = {};
  bool linear = true;                       ///< in u; else it has no matrix, and no implicit step
  std::string_view no_nonlocal_model = {};  ///< why acstudy has no source of one that it goes to, where it has none

  double order = 1.0;       ///< in max(h, delta), of errors against the PDE
  bool order_in_h = false;  ///< it is in h, whatever the horizon is
  /// Of a scheme that somebody has added: a checksum of what it computes. Null of acstudy's own.
  std::uint64_t (*fingerprint)() = nullptr;

  /// "Model I", "slopes, limiter clip"
  std::string label() const { return std::string(name) + (limiter.empty() ? "" : ", limiter " + std::string(limiter)); }
  bool needs_integrable_kernel() const { return cell_weights == CellWeights::masses; }
  int sides() const { return upwind ? 1 : 2; }
};

extern const ModelCard model_one, model_two;
extern const ModelCard model_slopes, model_clipped_slopes, model_symmetric;

/// All of them, by number: those of acstudy, then those that were added.
std::span<const ModelCard* const> model_cards();
/// Null if there is none.
const ModelCard* find_model(std::int64_t number);
/// One that is not of the paper, as studies name it; null if there is none.
const ModelCard* find_named_model(std::string_view name, std::string_view limiter = {});
/// The same by its label, as results have it.
const ModelCard* find_labeled_model(std::string_view label);

/// Where no theorem is known.
inline constexpr Theorems measured_alone = {"expected, measured; not proven", "expected, measured; not proven",
                                            "expected, measured; not proven"};
/// A card of a model that is not of the paper, on which nothing is said that only theory could know.
constexpr ModelCard card_beyond_paper() {
  ModelCard card{};
  card.beyond_paper = true;
  card.pair_cost = 1.0;
  card.row_terms = 1.0;
  card.vector_form = VectorForm::none;
  card.step_lemma = {.name = "its bound on steps",
                     .row_by_row = "its bound on steps, row by row",
                     .where_positive = "where c - b is constant",
                     .m_matrix = "no entry of a step is negative at any step",
                     .limit = "c - b",
                     .enough_for_every_kernel = true};
  card.to_nonlocal = card.to_pde = "consistency";
  return card;
}
/// Adds a model and gives it its number; the card has to live as long as the program.
/// @throws std::logic_error if it has no name, or that of another one
void add_model(ModelCard& card);

}  // namespace acstudy
