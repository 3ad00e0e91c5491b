#pragma once
#include "floe/assembly/offline.h"

namespace floe::assembly {

/// Whether a body of the scene has reduction.responses.
bool has_responses(const Scene& scene);

/// Adds reduction.responses: N to the bodies, N vectors each (of a split body: each of its frames).
///
/// The reduced model without them is simulated in the scene's steps from the scene's start. At the instant of the
/// maximum deformation and at 15 others, equally spaced, the full-order residual r = M q.. - Q_v + dU/dq - Q_e +
/// C_q' lambda is evaluated at the prolonged states q = V eta; of the static responses K_T^-1 P' r, K_T at rest and at
/// up to two unlike deformations of the motion, the 8 main ones (proper orthogonal decomposition in the norm of M) join
/// the basis of each body. The enriched model is simulated again, until each body has N of them.
///
/// @param offline   bodies reduced without them, with their factors of K
/// @param warnings  where a body gets fewer: the others are linearly dependent
/// @throws RunError  the reduced model does not get beyond its start. Collective; the same on all ranks.
void add_residual_responses(Offline& offline, std::vector<std::string>& warnings);

}  // namespace floe::assembly
