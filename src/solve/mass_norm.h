#pragma once
#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// sqrt(M_ii): weights that make lengths and angles comparable; multipliers have none. Collective.
petsc::VecHandle root_masses(const System& system, double t, Vec U, Vec V);

/// sum_i w_i^2 a_i b_i. Collective.
double weighted_product(Vec a, Vec b, Vec weights);

/// The root of the product of a change with itself. Collective.
double weighted_size(Vec change, Vec weights);

}  // namespace floe::solve
