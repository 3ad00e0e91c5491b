#include "reduced_file_shares.h"

#include <algorithm>
#include <numeric>

namespace floe::output {

Shares::Shares(MPI_Comm comm, std::int64_t count) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  for (int r = 0; r <= ranks; ++r) starts.push_back(count / ranks * r + std::min<std::int64_t>(r, count % ranks));
}

int Shares::owner(std::int64_t number) const {
  return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), number) - starts.begin()) - 1;
}

Route::Route(MPI_Comm comm, const Shares& shares, std::span<const std::int64_t> numbers) : comm_(comm) {
  const std::size_t ranks = shares.starts.size() - 1;
  order_.resize(numbers.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(),
                   [&](auto a, auto b) { return shares.owner(numbers[a]) < shares.owner(numbers[b]); });
  leave_.resize(ranks), leave_from_.resize(ranks), come_.resize(ranks), come_from_.resize(ranks);
  for (const std::int64_t number : numbers) ++leave_[shares.owner(number)];
  MPI_Alltoall(leave_.data(), 1, MPI_INT, come_.data(), 1, MPI_INT, comm_);
  std::exclusive_scan(leave_.begin(), leave_.end(), leave_from_.begin(), 0);
  std::exclusive_scan(come_.begin(), come_.end(), come_from_.begin(), 0);
}

std::int64_t Route::arriving() const { return std::accumulate(come_.begin(), come_.end(), std::int64_t{0}); }

template <class Number>
std::vector<Number> Route::send(std::span<const Number> rows, int width) const {
  std::vector<Number> leaving, arrived(arriving() * width);
  leaving.reserve(rows.size());
  for (const std::size_t row : order_) {
    const auto numbers = rows.subspan(row * width, width);
    leaving.insert(leaving.end(), numbers.begin(), numbers.end());
  }
  MPI_Datatype one;
  MPI_Type_contiguous(static_cast<int>(width * sizeof(Number)), MPI_BYTE, &one);
  MPI_Type_commit(&one);
  MPI_Alltoallv(leaving.data(), leave_.data(), leave_from_.data(), one, arrived.data(), come_.data(), come_from_.data(),
                one, comm_);
  MPI_Type_free(&one);
  return arrived;
}

template std::vector<double> Route::send(std::span<const double>, int) const;
template std::vector<std::int64_t> Route::send(std::span<const std::int64_t>, int) const;

}  // namespace floe::output
