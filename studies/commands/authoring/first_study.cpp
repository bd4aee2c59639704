#include "studies/commands/authoring/first_study.hpp"

#include <string_view>

namespace acstudy {

namespace {

constexpr std::string_view text = R"toml(# Run it:      acstudy run NAME.toml
# What it asks: acstudy explain NAME.toml        All keys: acstudy list keys convergence

[study]
name = "NAME"                     # names the result files: a-z, 0-9 and -
title = "What this study shows"   # heading in the report

# What is solved: u_t + (c u)_x = f on a periodic interval up to T, with f such that u is the exact solution.
# use = "lee-du-2019" would name a scene; acstudy list scenes prints them.
[scene]
period = "2*pi"
T = 1
c = "1 + cos(x)/4"                # advection velocity
b = "1/2"                         # velocity of the particles; without it they stand still
u = "sin(x - t)"                  # exact solution

# What is examined; each [[scheme]] takes every path. acstudy list schemes, acstudy list kernels.
[[scheme]]
model = 1                         # upwind
divergence = "local"              # or "nonlocal"; without it where particles stand still
kernel = "inverse"                # eta(s) = 1/(delta s); or { name = "power", alpha = 0.5 }

[[scheme]]
model = 2                         # vanishing viscosity
divergence = "local"
kernel = "cubic-spline"

# acstudy list integrators; step is the largest step, in h and N; "cfl" follows the bound of the scheme.
[time]
integrator = "ssprk2"
step = "h/2"

# How horizon and spacing go to zero: the horizon delta in h = period/N and N, the levels coarse to fine.
[[path]]
name = "delta = 3h"
delta = "3*h"
N = [40, 80, 160, 320, 640]
source = "local"                  # u solves the PDE; "nonlocal": the nonlocal model at this delta
# expect = "confirmed"            # what acstudy check demands: that theory's order is observed

[[path]]
name = "delta = sqrt(h)"
delta = "sqrt(h)"
N = [160, 320, 640, 1280, 2560]
source = "local"

# The horizon stays: to the nonlocal model the error goes like h.
[[path]]
name = "delta = 0.2"
delta = 0.2
N = [160, 320, 640, 1280]
source = "nonlocal"
)toml";

}  // namespace

std::string first_study(const std::string& name) {
  std::string study(text);
  constexpr std::string_view placeholder = "NAME";
  for (std::size_t at = study.find(placeholder); at != std::string::npos; at = study.find(placeholder, at)) {
    study.replace(at, placeholder.size(), name);
    at += name.size();
  }
  return study;
}

}  // namespace acstudy
