#pragma once
#include <optional>

#include "floe/reduction/statics.h"

namespace floe::reduction {

/// The greatest eigenvalues theta of K^-1 M x = theta x, vectors of M-norm 1 but for the residual.
struct RitzPairs {
  std::vector<double> theta;     ///< descending
  std::vector<double> residual;  ///< |K^-1 M x - theta x|_M / theta
  Columns vectors;
};

/// Block Lanczos with full orthogonalisation in the M inner product: a factor is read once for all columns of a block,
/// so that a block of three costs little more than one vector; M Q is kept, so that M is applied once to each column.
///
/// @param solver  K^-1, a direct one
/// @param held    dofs at zero, in which M is empty
/// @return  empty where `count` pairs do not reach the tolerance before the space has grown to its most columns, or the
///   space is exhausted
/// Source: Golub and Underwood 1977; Grimes, Lewis and Simon 1994. Collective.
std::optional<RitzPairs> block_lanczos(const fem::Structure& structure, KSP solver, Mat M, const fem::Conditions& held,
                                       int count, double tolerance);

}  // namespace floe::reduction
