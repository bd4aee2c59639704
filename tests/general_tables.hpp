#pragma once

/// @file
/// Integrators that the program does not have: tables of a general shape.

#include "solver/time/integrators.hpp"

namespace acstudy::test {

inline constexpr Stage rk4_stages[] = {{.c = 0.5, .alpha = {1.0}, .beta = {0.5}},
                                       {.c = 0.5, .alpha = {1.0}, .beta = {0.0, 0.5}},
                                       {.c = 1.0, .alpha = {1.0}, .beta = {0.0, 0.0, 1.0}},
                                       {.c = 1.0, .alpha = {1.0}, .beta = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}}};
inline constexpr Stage heun3_stages[] = {{.c = 1.0 / 3, .alpha = {1.0}, .beta = {1.0 / 3}},
                                         {.c = 2.0 / 3, .alpha = {1.0}, .beta = {0.0, 2.0 / 3}},
                                         {.c = 1.0, .alpha = {1.0}, .beta = {0.25, 0.0, 0.75}}};
/// Four stages of order three: convex combinations of forward Euler steps half as long.
inline constexpr Stage ssprk43_stages[] = {{.c = 0.5, .alpha = {1.0}, .beta = {0.5}},
                                           {.c = 1.0, .alpha = {0.0, 1.0}, .beta = {0.0, 0.5}},
                                           {.c = 0.5, .alpha = {2.0 / 3, 0.0, 1.0 / 3}, .beta = {0.0, 0.0, 1.0 / 6}},
                                           {.c = 1.0, .alpha = {0.0, 0.0, 0.0, 1.0}, .beta = {0.0, 0.0, 0.0, 0.5}}};
/// Order two in three registers: the last stage averages all before it.
inline constexpr Stage three_register_stages[] = {
    {.c = 0.5, .alpha = {1.0}, .beta = {0.5}},
    {.c = 1.0, .alpha = {0.0, 1.0}, .beta = {0.0, 0.5}},
    {.c = 1.0, .alpha = {1.0 / 3, 1.0 / 3, 1.0 / 3}, .beta = {0.0, 1.0 / 6, 1.0 / 3}}};
/// Crouzeix's scheme, whose last stage is explicit.
inline constexpr double crouzeix_gamma = 0.78867513459481288225;
inline constexpr Stage crouzeix_stages[] = {
    {.c = crouzeix_gamma, .alpha = {1.0}, .beta = {0.0, crouzeix_gamma}},
    {.c = 1.0 - crouzeix_gamma, .alpha = {1.0}, .beta = {0.0, 1.0 - 2.0 * crouzeix_gamma, crouzeix_gamma}},
    {.c = 1.0, .alpha = {1.0}, .beta = {0.0, 0.5, 0.5}}};

inline constexpr Integrator general_tables[] = {{"classical Runge-Kutta", 4, rk4_stages},
                                                {"Heun, order 3", 3, heun3_stages},
                                                {"SSPRK(4,3)", 3, ssprk43_stages},
                                                {"three registers", 2, three_register_stages},
                                                {"Crouzeix", 3, crouzeix_stages}};

}  // namespace acstudy::test
