#pragma once
#include "floe/petsc/handle.h"

namespace floe::solve {

/// |J| |x|, what the terms of J x amount to before they cancel: J x is known to some eps of it, row by row, in whatever
/// units the rows are. Collective.
petsc::VecHandle sizes_of_terms(Mat J, Vec x);

/// Whether every row of F, the residual near x, is within so many eps of its terms: Newton's method finds nothing more
/// there. Terms are sums of products themselves, whose round-off has been seen at 75 eps. Collective.
bool is_round_off(Mat J, Vec x, Vec F, double several);

/// |d| / |x| in the norm sqrt(sum |J_ii| x_i^2), which no unit enters; multipliers have no weight. Collective.
double share_of(Mat J, Vec d, Vec x);

/// A dense LU overwrites its matrix: a copy of a dense one, nothing for a sparse one. Collective.
petsc::MatHandle copy_of_dense(Mat J);

}  // namespace floe::solve
