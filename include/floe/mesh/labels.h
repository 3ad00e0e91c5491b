#pragma once
#include <petscsys.h>

#include <vector>

namespace floe::mesh {

/// From the labels of a file (any integers) to indices 0..n-1, spread over the ranks.
///
/// Rank r's labels are those of indices first..first + labels.size() - 1. Where the labels are 1..n in order nothing is
/// stored; elsewhere a rank keeps the labels l with l mod ranks = r, sorted.
class LabelDirectory {
 public:
  /// Collective.
  LabelDirectory(MPI_Comm comm, const std::vector<long long>& labels);

  /// Index of each label; -1 where there is none, the minimum index where there are several. Collective.
  std::vector<PetscInt> find(const std::vector<long long>& labels) const;

  /// Positions in this rank's `labels` of those that an earlier index bears too. Collective.
  std::vector<std::size_t> repeated(const std::vector<long long>& labels) const;

  PetscInt first() const { return first_; }
  PetscInt count() const { return count_; }

 private:
  struct Entry {
    long long label;
    PetscInt index;
  };
  PetscInt here(long long label) const;
  int owner(long long label) const;

  MPI_Comm comm_;
  int ranks_ = 1;
  PetscInt first_ = 0, count_ = 0;
  bool in_order_ = false;
  std::vector<Entry> entries_;  // of the labels that this rank keeps
};

/// A map from this rank's numbers to what was found for them: a table where the numbers lie close, else sorted.
class Translation {
 public:
  /// @param keys  in any order, with repetitions
  explicit Translation(std::vector<long long> keys);

  /// The keys, ascending, without repetitions.
  const std::vector<long long>& keys() const { return keys_; }
  /// Position of a key among keys(); -1 where it is none of them.
  PetscInt position(long long key) const;

 private:
  std::vector<long long> keys_;
  std::vector<PetscInt> table_;  // empty where the keys are too sparse
};

}  // namespace floe::mesh
