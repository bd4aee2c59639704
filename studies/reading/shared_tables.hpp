#pragma once

/// @file
/// The keys of tables that studies of several kinds share; path_part and study_parts read them.

#include <algorithm>
#include <array>

#include "studies/models/kernel_choice.hpp"
#include "studies/models/key.hpp"

namespace acstudy {

inline constexpr Key study_keys[] = {
    {"name", "text", "names the result files: a-z, 0-9 and -"},
    {"title", "text", "heading in the report", "the name"},
    {"kind", "a kind", "what the study measures", "\"convergence\""},
};
inline constexpr TableKeys study_table{"[study]", study_keys};

inline constexpr Key scene_keys[] = {
    {"use", "a scene", "a named scene; of the other keys only T may stand beside it", "the fields are given"},
    {"period", "expression", "length of the periodic interval", "needed without use"},
    {"T", "expression", "final time", "needed without use"},
    {"c", "expression in x", "advection velocity", "needed without use"},
    {"b", "expression in x", "velocity of the particles", "they stand still"},
    {"u", "expression in x, t", "exact solution", "needed without reference"},
    {"flow", "expression in x, t", "place at t of the particle that starts at x", "x' = b is integrated"},
    {"reference", "\"finest\"", "no solution is known, errors are against a finer run; convergence only", "u is known"},
    {"u0", "expression in x", "values at t = 0; goes with reference", "needed with it"},
    {"f", "expression in x, t", "source; goes with reference", "0"},
};
inline constexpr TableKeys scene_table{"[scene]", scene_keys};

/// Keys, and those of the kernels' parameters behind "kernel.name".
template <std::size_t n>
constexpr auto with_kernel_keys(const Key (&keys)[n]) {
  std::array<Key, n + kernel_keys.size()> all{};
  auto next = all.begin();
  for (const Key& key : keys) {
    *next++ = key;
    if (key.name == "kernel.name") next = std::copy(kernel_keys.begin(), kernel_keys.end(), next);
  }
  return all;
}

inline constexpr auto scheme_keys = with_kernel_keys({
    {"model", "a model", "one of the paper by its number, any other by its name: see acstudy list schemes",
     "needed without command"},
    {"divergence", "\"local\", \"nonlocal\"", "b' is exact, or made of the kernel", "needed where particles move"},
    {"kernel", "a kernel", "by name, or as a table: a name with its parameter, or a text of your own",
     "needed without command"},
    {"kernel.name", "a kernel", "the name, in a table", "needed without a text"},
    {"kernel.profile", "expression in s", "a density rho(s), 0 < s < 1 in units of delta: eta = -rho', normalized",
     "a name or eta"},
    {"kernel.eta", "expression in s", "eta itself, normalized", "a name or a profile"},
    {"kernel.breaks", "list of numbers", "where the text is not smooth, or expressions such as \"1/3\"", "nowhere"},
    {"kernel.exponent", "number below 2", "eta(s) is s^-exponent times the text; in Model II below 1", "0"},
    {"limiter", "\"clip\"", "of slopes, where data are not smooth; goes with model = \"slopes\"", "none"},
    {"mu", "number, 0 or more", "viscosity bound of Model II and symmetric", "max |c - b|"},
    {"command", "list of texts", "a program and its arguments, in place of a model; convergence only",
     "a model is run"},
    {"label", "text", "its name; goes with command", "the command"},
    {"order", "number, 0 or more", "that theory promises; goes with command", "needed with it"},
    {"expect", "a verdict", "in place of what the paths expect; goes with command", "what the paths expect"},
    {"timeout", "time", "that a case may take, \"60 s\", \"10 min\"; goes with command", "\"10 min\""},
    {"inputs", "list of files", "that decide what it does, beside those of the command", "those of the command"},
});
inline constexpr TableKeys scheme_table{"[[scheme]]", scheme_keys};

inline constexpr Key time_keys[] = {
    {"integrator", "an integrator", "how time is stepped"},
    {"step", "expression in h, N", "the largest step; \"cfl\": a bound of the scheme; \"adaptive\": see tolerance"},
    {"safety", "number above 0", "fraction of the bound; goes with step = \"cfl\"", "0.9"},
    {"bound", "\"lemma\", \"rows\"", "by the smallest gap, or by the rows of the scheme; goes with \"cfl\"",
     "\"lemma\""},
    {"tolerance", "expression, or a list", "in h and N: of the error of each adaptive step; of a list each is a series",
     "needed with \"adaptive\""},
    {"first", "expression in h, N", "the first step that is tried; goes with step = \"adaptive\"", "\"h\""},
    {"limit", "time", "that a case may take, \"30 s\", \"10 min\"; a command has its timeout", "none"},
    {"expect", "a verdict", "in place of what the paths expect; convergence only", "what the paths expect"},
};
inline constexpr TableKeys time_table{"[time]", time_keys};
/// The same where it may stand several times, each a series of its own.
inline constexpr TableKeys times_table{"[time] or [[time]]", time_keys};

inline constexpr Key path_keys[] = {
    {"name", "text", "label; each path has its own"},
    {"delta", "expression in h, N", "horizon, below half the period", "needed unless all schemes are commands; then h"},
    {"N", "list of numbers", "levels, numbers of particles from coarse to fine, or a table; that in convergence only"},
    {"N.from", "whole number", "the coarsest level; each other one has twice as many particles", "needed in a table"},
    {"N.until", "\"decided\"", "levels are added until the verdict is neither inconclusive nor pre-asymptotic",
     "needed in a table"},
    {"N.most", "whole number", "no level has more particles", "needed in a table"},
    {"source", "\"local\", \"nonlocal\"", "u solves the PDE, or the nonlocal model at this delta",
     "needed if u is known"},
    {"reference", "number", "N of the run that errors are against, if no u is known", "the finest of N"},
    {"expect", "a verdict", "what the gate demands; not in controls", "\"confirmed\", or \"stagnates\" for order 0"},
    {"order", "number, 0 or more", "in place of theory's, 0: the error settles; not in controls", "theory's"},
    {"start", "a start", "places of the particles at t = 0, by name or as a table", "\"uniform\""},
    {"start.name", "a start", "\"uniform\", \"jittered\" or \"clustered\""},
    {"start.smallest_gap", "number, 0 to 1", "in units of h", "needed unless uniform"},
    {"start.seed", "whole number", "of the jitter", "1"},
};
inline constexpr TableKeys path_table{"[[path]]", path_keys};

inline constexpr Key source_keys[] = {
    {"rule", "\"gauss\", \"gsl\", \"boost\"", "quadrature of nonlocal sources: fixed, or one of two adaptive ones"},
};
inline constexpr TableKeys source_table{"[source]", source_keys, true};

inline constexpr Key sweep_keys[] = {
    {"N", "list of numbers", "numbers of particles, from coarse to fine"},
    {"ratios", "list of numbers", "delta/h; one with delta beyond half the period is left out at that N"},
    {"horizons", "list of numbers", "fixed horizons, below half the period", "none"},
};
inline constexpr TableKeys sweep_table{"[sweep]", sweep_keys};

}  // namespace acstudy
