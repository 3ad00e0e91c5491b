#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace floe::math {

/// Disjoint sets of the numbers 0 to n - 1, each known by its least number (union-find with path halving).
template <class Index>
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  /// The least number of the set of i.
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace floe::math
