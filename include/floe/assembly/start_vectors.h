#pragma once
#include "floe/assembly/reduce_bodies.h"

namespace floe::assembly {

/// Joins to the basis of a reduced body what it lacks of the deformation at the start and of its rate: the remainder
/// r = u - V V'M u, where |r|_K > 1 % of sqrt(2 U(u)) (strain energy), and that of the rate, where |r|_M > 1 % of |v|_M
/// (kinetic energy). Without them part of the energy at the start would be lost, and places of joints would move. U is
/// that of the nonlinear strains: a remainder of the foreshortening that belongs to a deflection has forces along the
/// body that bend it more than the deflection does.
///
/// A body whose start is given needs at least one basis vector. Collective.
void join_start(const PlannedBody& body, ReducedBody& reduced);

/// Whether a deformation at the start, or its rate, is given and not zero. Collective.
bool starts_deformed(const PlannedBody& body);

}  // namespace floe::assembly
