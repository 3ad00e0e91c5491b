#pragma once
#include <slepceps.h>

namespace floe::reduction {

/// Name of the EPS type.
inline constexpr char block_lanczos[] = "block-lanczos";

/// Registers the EPS type block-lanczos with SLEPc.
///
///   (K - s M)^-1 M V_j = V_j-1 B_j' + V_j A_j + V_j+1 B_j+1,   V'M V = 1,   theta = 1 / (lambda - s)
///
/// The Lanczos method with blocks of b vectors for K x = lambda M x, both symmetric, M positive semi-definite, by
/// shift-and-invert. Each step solves for b right-hand sides at once (KSPMatSolve), which reads the factor once where
/// b single solves read it b times: a direct solver takes a fifth of the time for each of eight. About two and a half
/// times as many solves are needed as by single vectors. Each block is made orthogonal to all before it, as often as
/// it takes; the pairs are those of the projected matrix; it restarts with the best of them where the space is full
/// (thick restart), those that have converged locked. Frequencies repeated up to b times are found together; of more,
/// some may be passed over.
///
/// Options: -eps_block_lanczos_size <8> (b), -eps_ncv (most vectors), -eps_tol, -eps_max_it (steps of a block each),
/// monitors, deflation and initial spaces as of any EPS. Of the ST types sinvert only.
/// Sources: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; Wu and Simon, ibid. 22 (2000) 602
/// (thick restart); Stathopoulos and Wu, SIAM J. Sci. Comput. 23 (2002) 2165 (orthonormal blocks).
void register_block_lanczos();

/// How many vectors an EPS starts with: b, or one if it is of another type.
PetscInt block_size(EPS eps);

/// How many vectors the space needs for `count` pairs without a restart, as a rule.
PetscInt block_lanczos_space(PetscInt count);

}  // namespace floe::reduction
