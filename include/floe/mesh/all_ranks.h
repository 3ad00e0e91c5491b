#pragma once
#include "floe/mesh/exchange.h"

namespace floe::mesh {

/// Of every rank, on every rank. Collective.
template <class T>
std::vector<T> of_all_ranks(MPI_Comm comm, const std::vector<T>& mine) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<T> copies;
  for (int r = 0; r < ranks; ++r) copies.insert(copies.end(), mine.begin(), mine.end());
  return exchange(comm, copies, std::vector<int>(ranks, static_cast<int>(mine.size()))).values;
}

}  // namespace floe::mesh
