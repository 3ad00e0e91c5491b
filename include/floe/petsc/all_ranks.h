#pragma once
#include <mpi.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace floe::petsc {

/// The entries of every rank, one rank after the other, on every rank. Collective.
template <class T>
std::vector<T> of_all_ranks(MPI_Comm comm, const std::vector<T>& mine) {
  static_assert(std::is_trivially_copyable_v<T>);
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(ranks), starts(ranks + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  std::vector<T> all(static_cast<std::size_t>(starts.back()));
  MPI_Datatype type;
  MPI_Type_contiguous(sizeof(T), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Allgatherv(mine.data(), count, type, all.data(), counts.data(), starts.data(), type, comm);
  MPI_Type_free(&type);
  return all;
}

}  // namespace floe::petsc
