#include "floe/dynamics/coordinates.h"

#include <algorithm>

namespace floe::dynamics {
namespace {

/// Exclusive prefix sum over ranks, with the total at the end: where each rank's share of a block begins.
std::vector<PetscInt> ranges(MPI_Comm comm, PetscInt owned) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  std::vector<PetscInt> first(size + 1, 0);
  MPI_Allgather(&owned, 1, MPIU_INT, first.data() + 1, 1, MPIU_INT, comm);
  for (int r = 0; r < size; ++r) first[r + 1] += first[r];
  return first;
}

}  // namespace

void Coordinates::belongs_to(std::string owner) { owners_.push_back(std::move(owner)); }

int Coordinates::add_shared(int count, bool multipliers) {
  blocks_.push_back({true, multipliers, count, {}, local_size_, static_cast<int>(owners_.size()) - 1});
  local_size_ += count;
  return blocks_.back().first;
}

int Coordinates::add_distributed(PetscInt owned, std::vector<PetscInt> foreign) {
  const int first = local_size_;
  local_size_ += static_cast<int>(owned + foreign.size());
  blocks_.push_back({false, false, owned, std::move(foreign), first, static_cast<int>(owners_.size()) - 1});
  return first;
}

std::vector<int> Coordinates::owner_of_local() const {
  std::vector<int> owner(local_size_, -1);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const int end = b + 1 < blocks_.size() ? blocks_[b + 1].first : local_size_;
    std::fill(owner.begin() + blocks_[b].first, owner.begin() + end, blocks_[b].owner);
  }
  return owner;
}

void Coordinates::number() {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm_, &rank);
  MPI_Comm_size(comm_, &size);
  const bool last = rank == size - 1;

  owned_size_ = 0;
  for (const Block& block : blocks_)
    if (!block.shared || last) owned_size_ += block.owned;
  const std::vector<PetscInt> begin = ranges(comm_, owned_size_);
  global_size_ = begin[size];
  global_.assign(local_size_, 0);
  multiplier_.assign(local_size_, 0);
  owned_multipliers_.clear();
  multiplier_count_ = 0;

  // Where in each rank's share the block begins: distributed blocks first, then (on the last rank) the shared ones.
  std::vector<PetscInt> offset(size, 0);
  for (const Block& block : blocks_) {
    if (block.shared) continue;
    const std::vector<PetscInt> share = ranges(comm_, block.owned);
    auto global = [&](PetscInt index) {
      const int r = static_cast<int>(std::upper_bound(share.begin(), share.end(), index) - share.begin()) - 1;
      return begin[r] + offset[r] + index - share[r];
    };
    for (PetscInt i = 0; i < block.owned; ++i) global_[block.first + i] = begin[rank] + offset[rank] + i;
    for (std::size_t i = 0; i < block.foreign.size(); ++i)
      global_[block.first + block.owned + i] = global(block.foreign[i]);
    for (int r = 0; r < size; ++r) offset[r] += share[r + 1] - share[r];
  }
  PetscInt shared = begin[size - 1] + offset[size - 1];
  for (const Block& block : blocks_) {
    if (!block.shared) continue;
    for (PetscInt i = 0; i < block.owned; ++i, ++shared) {
      global_[block.first + i] = shared;
      multiplier_[block.first + i] = block.multipliers;
      if (block.multipliers && last) owned_multipliers_.push_back(shared);
      multiplier_count_ += block.multipliers;
    }
  }
}

}  // namespace floe::dynamics
