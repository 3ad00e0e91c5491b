#pragma once
#include <petscmat.h>

namespace floe::petsc {

/// Makes MatMatSolve on several ranks keep what puts MUMPS' solutions into their places, for F, a MUMPS factor whose
/// analysis is done.
///
/// PETSc makes that scatter anew for every block, with an index for each row of each column, which takes longer than
/// the solves; here one of a single column serves them all, as it does in PETSc's MatSolve. Right-hand sides go to
/// MUMPS where they are (ICNTL(20) = 10), 64 at a time, solutions come back as MUMPS leaves them (ICNTL(21) = 1).
/// PETSc's own way remains on one rank, for sparse right-hand sides, where an option of F sets ICNTL(20) or
/// -mat_mumps_use_omp_threads, and where MUMPS' structure is not found at the start of the factor's data, by the
/// version it was compiled with. Collective.
PetscErrorCode keep_block_scatter(Mat F);

}  // namespace floe::petsc
