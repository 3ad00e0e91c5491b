#pragma once
#include <utility>
#include <vector>

#include "floe/reduction/statics.h"

namespace floe::reduction {

/// Where frequencies repeat: first and past-last index of each run of lambda that agree within 1e-8. Ascending lambda.
std::vector<std::pair<int, int>> clusters(const std::vector<double>& lambda);

/// Modes of one frequency are any basis of their space; this makes it one that neither ranks nor the solver choose.
///
/// The first is the mode that moves most, for its size, at a pivot: the first translation, by original numbers, that
/// the space moves more than half as much as the one it moves most (both are the same in every orthonormal basis). The
/// others stand still there, and are chosen likewise among themselves. Each moves its pivot in the positive sense.
///
/// @param phi     orthonormalised in M, then combined, within each cluster of `lambda`
/// @param lambda  likewise, the Rayleigh quotients of the combinations
/// Collective.
void make_canonical(const fem::Structure& structure, Mat M, Columns& phi, std::vector<double>& lambda);

}  // namespace floe::reduction
