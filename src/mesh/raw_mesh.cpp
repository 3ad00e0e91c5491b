#include "floe/mesh/raw_mesh.h"

#include <algorithm>

namespace floe::mesh {

Share share_of(PetscInt count, int rank, int ranks) {
  const auto start = [&](long long r) { return static_cast<PetscInt>(r * count / ranks); };
  return {start(rank), start(rank + 1) - start(rank)};
}

std::vector<PetscInt> starts_of(MPI_Comm comm, PetscInt count) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<PetscInt> starts(ranks + 1, 0);
  MPI_Allgather(&count, 1, MPIU_INT, starts.data() + 1, 1, MPIU_INT, comm);
  for (int r = 0; r < ranks; ++r) starts[r + 1] += starts[r];
  return starts;
}

int owner_of(const std::vector<PetscInt>& starts, PetscInt i) {
  return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), i) - starts.begin()) - 1;
}

}  // namespace floe::mesh
