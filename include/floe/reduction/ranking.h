#pragma once
#include <vector>

#include "floe/reduction/statics.h"

namespace floe::reduction {

/// A candidate that ranking took.
struct Ranked {
  std::size_t candidate;  ///< its index
  double weight;          ///< of its new part, against the first
};

/// Takes the `count` candidates that add most, largest first: the next one has the maximum
///
///   factor_c |x_c|_M,   x_c = candidate c without its part along `given` and along those taken before
///
/// Candidates with |x_c|_M <= tolerance |candidate c|_M add nothing and are never taken. Ties go to the first.
/// The candidates' coordinates in one M-orthonormal basis (Gram-Schmidt with refinement) carry the selection: a QR with
/// column pivoting of a small matrix, the same on all ranks.
/// Collective.
std::vector<Ranked> rank(const fem::Structure& structure, const Columns& given, const Columns& candidates,
                         const std::vector<double>& factors, int count, double tolerance);

}  // namespace floe::reduction
