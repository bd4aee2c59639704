#pragma once

/// @file
/// The vector form of the schemes on moving particles: rates of all particles in one sweep, in which weights are
/// computed where they are used and never stored. ModelI and ModelII are the readable form of the same; tests compare
/// the two.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/line/vector/moment_table.hpp"
#include "solver/rate_matrix.hpp"

namespace acstudy {

/// A kernel as the sweeps know it.
struct SweepKernel {
  enum class Form { inverse, cubic_spline, table };
  Form form;
  // for a `table`, and for rows of any form:
  MomentTable::View moments = {};  ///< of what the sweep asks for: the first moment or the mass
  const void* kernel = nullptr;    ///< the same by a function, where the table is none
  double (*moment)(const void* kernel, double z) = nullptr;
};

/// A scheme that takes part in a sweep: its values and where its rates go. Both divergence forms may, and then share
/// the geometry. Left out: u is null.
struct SweepScheme {
  const double* u = nullptr;     ///< with ghosts
  const double* flux = nullptr;  ///< Model I: c_hat u, with ghosts
  double* rate = nullptr;        ///< [N] and up to the next multiple of eight
};

/// Neighbors whose moments are looked up together: so many beyond the first one after its window are read.
inline constexpr std::ptrdiff_t looked_ahead = 4;

/// Particles of a sweep: begin .. end - 1, begin a multiple of eight. All arrays are readable at the windows' ghosts
/// and as far beyond as a sweep looks ahead; what is there is finite.
struct SweepRange {
  const double* x;
  double delta, inside;
  std::ptrdiff_t begin, end;
};

/// Model I, (2.9) and (2.11).
struct UpwindSweep {
  SweepKernel kernel;
  const double* c_hat;    ///< relative velocity
  const double* b_prime;  ///< of the local form
  const double* c;        ///< of the nonlocal form
  const double* b;        ///< of the nonlocal form, with ghosts
  SweepScheme local, nonlocal;
};

/// Most modes that the velocities at midpoints may have together; more are not worth their products.
inline constexpr int most_modes = 4;

/// A trigonometric field a_0 + sum_i (cosine_i cos(n_i w x) + sine_i sin(n_i w x)).
struct SweepField {
  double constant = 0.0;
  int modes = 0;
  int mode[most_modes] = {};  ///< which of the sweep's modes n_i is
  double cosine[most_modes] = {}, sine[most_modes] = {};
};

/// Fields of a period as polynomials on overlapping panels, each of which holds all midpoints of some particles and
/// their neighbors: panel q is about q `spacing`, `radius` to each side, and serves particles nearest to its center.
struct SweepPanels {
  double spacing = 0.0, radius = 0.0;
  std::ptrdiff_t count = 0;
  int terms =
      0;  ///< coefficients of a polynomial in (x - center)/radius, lowest first; a multiple of four; 0: no panels
  const double *c_hat = nullptr, *b = nullptr;  ///< [count][terms]
};

/// Model II, (3.8) and (3.10).
///
/// Velocities at midpoints come from panels or, where they have few modes, from these. A mode of the midpoint is a sum
/// of products over the two particles, cos(n w (x + y)/2) = C(x) C(y) - S(x) S(y) with C(x) = cos(n w x/2), S(x) =
/// sin(n w x/2).
struct SymmetricSweep {
  SweepKernel kernel;
  double mu;
  const double* x;  ///< with ghosts
  SweepPanels panels;
  const double* half_cosine[most_modes];  ///< C of each mode, with ghosts; none may be null
  const double* half_sine[most_modes];    ///< S
  SweepField c, b;
  const double* b_prime;  ///< of the local form
  SweepScheme local, nonlocal;
};

/// Where the rows of the matrix of rates go, of which local and nonlocal divergence differ by the diagonal alone.
struct SweepRows {
  std::ptrdiff_t room = 0;                ///< offsets from a row to a column that there is room for on each side
  BandedMatrix::Block* blocks = nullptr;  ///< gets first and width of each; null: rows are summed, not stored
  double* value = nullptr;                ///< [2 room + 1][lane] for each block; the diagonal stays zero
  double *own_local = nullptr, *own_nonlocal = nullptr;  ///< the diagonal, or null where it is not asked for
  double* decay = nullptr;  ///< what a particle's own weight takes of its u; see KnowsItsRows. All [N] and up to the
                            ///< next multiple of eight
};

/// constant + sum_n cosine_n cos(n w x) + sine_n sin(n w x), n = 1 .. highest.
struct SweepSeries {
  double constant;
  const double *cosine, *sine;
  std::ptrdiff_t highest;
};

/// The sweeps of one instruction set. They return the number of pairs.
struct Sweeps {
  const char* name;  ///< "x86-64-v4", ...
  int lanes;         ///< particles at a time
  std::int64_t (*upwind)(const SweepRange&, const UpwindSweep&);
  std::int64_t (*symmetric)(const SweepRange&, const SymmetricSweep&);
  // The rows of the same; schemes of a sweep are not looked at. They return the largest offset: beyond the room that
  // there is, entries are missing.
  std::ptrdiff_t (*upwind_rows)(const SweepRange&, const UpwindSweep&, const SweepRows&);
  std::ptrdiff_t (*symmetric_rows)(const SweepRange&, const SymmetricSweep&, const SweepRows&);
  /// rate = R u for blocks begin .. end - 1 of a BandedMatrix, u with ghosts.
  void (*banded)(const BandedMatrix::Block* blocks, const double* value, const double* u, double* rate,
                 std::ptrdiff_t begin, std::ptrdiff_t end);
  /// The series at points given by cos(w x) and sin(w x).
  void (*series)(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                 std::ptrdiff_t count);
};

/// The widest that this processor has; ACSTUDY_VECTOR in the environment names another one.
/// @throws std::runtime_error if it names one that there is not
const Sweeps& sweeps();

}  // namespace acstudy
