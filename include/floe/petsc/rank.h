#pragma once
#include <mpi.h>

namespace floe::petsc {

inline int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

/// Whether this one prints and writes for all.
inline bool first_rank(MPI_Comm comm) { return rank_of(comm) == 0; }

}  // namespace floe::petsc
