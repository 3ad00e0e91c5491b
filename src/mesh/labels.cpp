#include "floe/mesh/labels.h"

#include <algorithm>

#include "floe/mesh/exchange.h"
#include "floe/mesh/raw_mesh.h"

namespace floe::mesh {

LabelDirectory::LabelDirectory(MPI_Comm comm, const std::vector<long long>& labels) : comm_(comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks_);
  const auto starts = starts_of(comm, static_cast<PetscInt>(labels.size()));
  first_ = starts[rank];
  count_ = starts.back();
  bool straight = true;
  for (std::size_t i = 0; i < labels.size() && straight; ++i)
    straight = labels[i] == first_ + static_cast<long long>(i) + 1;
  MPI_Allreduce(&straight, &in_order_, 1, MPI_C_BOOL, MPI_LAND, comm);
  if (in_order_) return;
  std::vector<Entry> mine(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) mine[i] = {labels[i], first_ + static_cast<PetscInt>(i)};
  entries_ = scatter(comm, mine, [this](const Entry& entry) { return owner(entry.label); }).values;
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.label != b.label ? a.label < b.label : a.index < b.index; });
}

int LabelDirectory::owner(long long label) const {
  return static_cast<int>(static_cast<unsigned long long>(label) % static_cast<unsigned long long>(ranks_));
}

PetscInt LabelDirectory::here(long long label) const {
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), label,
                                      [](const Entry& entry, long long sought) { return entry.label < sought; });
  return found != entries_.end() && found->label == label ? found->index : -1;
}

std::vector<PetscInt> LabelDirectory::find(const std::vector<long long>& labels) const {
  if (!in_order_)
    return ask<PetscInt>(
        comm_, labels, [this](long long l) { return owner(l); }, [this](long long l) { return here(l); });
  std::vector<PetscInt> found(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i)
    found[i] = labels[i] >= 1 && labels[i] <= count_ ? static_cast<PetscInt>(labels[i] - 1) : -1;
  return found;
}

std::vector<std::size_t> LabelDirectory::repeated(const std::vector<long long>& labels) const {
  const auto same = [](const Entry& a, const Entry& b) { return a.label == b.label; };
  const bool mine = std::adjacent_find(entries_.begin(), entries_.end(), same) != entries_.end();
  bool any = false;
  MPI_Allreduce(&mine, &any, 1, MPI_C_BOOL, MPI_LOR, comm_);
  std::vector<std::size_t> positions;
  if (!any) return positions;
  const auto found = find(labels);
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (found[i] != first_ + static_cast<PetscInt>(i)) positions.push_back(i);
  return positions;
}

Translation::Translation(std::vector<long long> keys) : keys_(std::move(keys)) {
  constexpr unsigned long long sparse = 4;  // places of the table for each number given
  if (keys_.empty()) return;
  const auto [least, greatest] = std::minmax_element(keys_.begin(), keys_.end());
  const long long low = *least;
  const unsigned long long span = static_cast<unsigned long long>(*greatest) - static_cast<unsigned long long>(low);
  if (span / sparse >= keys_.size()) {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    return;
  }
  table_.assign(span + 1, -1);
  for (const long long key : keys_) table_[key - low] = 0;
  keys_.clear();
  for (std::size_t i = 0; i < table_.size(); ++i) {
    if (table_[i] < 0) continue;
    table_[i] = static_cast<PetscInt>(keys_.size());
    keys_.push_back(low + static_cast<long long>(i));
  }
}

PetscInt Translation::position(long long key) const {
  if (keys_.empty() || key < keys_.front() || key > keys_.back()) return -1;
  if (!table_.empty()) return table_[key - keys_.front()];
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
  return *found == key ? static_cast<PetscInt>(found - keys_.begin()) : -1;
}

}  // namespace floe::mesh
