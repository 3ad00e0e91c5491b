#pragma once
#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

namespace floe::output {

/// The numbers 0 ... count-1 in shares of equal size, give or take one, in the order of the ranks.
struct Shares {
  std::vector<std::int64_t> starts;  ///< one more than ranks
  Shares(MPI_Comm comm, std::int64_t count);
  std::int64_t first(int rank) const { return starts[rank]; }
  std::int64_t size(int rank) const { return starts[rank + 1] - starts[rank]; }
  int owner(std::int64_t number) const;
};

/// Brings rows that lie anywhere to the ranks whose shares their numbers belong to.
class Route {
 public:
  /// @param numbers  of this rank's rows, each within the shares. Collective.
  Route(MPI_Comm comm, const Shares& shares, std::span<const std::int64_t> numbers);
  /// Rows of `width` numbers, in the order of the constructor's; gives those that came here, in the order of ranks.
  /// Collective.
  template <class Number>
  std::vector<Number> send(std::span<const Number> rows, int width) const;
  std::int64_t arriving() const;

 private:
  MPI_Comm comm_;
  std::vector<std::size_t> order_;  ///< of this rank's rows by where they go
  std::vector<int> leave_, leave_from_, come_, come_from_;
};

}  // namespace floe::output
