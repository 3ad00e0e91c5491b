#include "tall_skinny.h"

#include <petscblaslapack.h>

#include <algorithm>
#include <vector>

namespace floe::reduction {
namespace {

/// The first `count` rows of A become R of their QR; more rows than columns.
void factor_in_place(Eigen::MatrixXd& A, Eigen::Index count) {
  const PetscBLASInt rows = static_cast<int>(count), columns = static_cast<int>(A.cols()),
                     lead = static_cast<int>(A.rows());
  PetscBLASInt info = 0, size = 32 * columns;
  std::vector<double> tau(columns), work(size);
  LAPACKgeqrf_(const_cast<PetscBLASInt*>(&rows), const_cast<PetscBLASInt*>(&columns), A.data(),
               const_cast<PetscBLASInt*>(&lead), tau.data(), work.data(), &size, &info);
  for (Eigen::Index j = 0; j < A.cols(); ++j) A.col(j).segment(j + 1, A.cols() - j - 1).setZero();
}

}  // namespace

Eigen::MatrixXd triangle(Eigen::MatrixXd rows) {
  if (rows.rows() <= rows.cols() || rows.cols() == 0) return rows;
  factor_in_place(rows, rows.rows());
  return rows.topRows(rows.cols());
}

TallSkinnyQr::TallSkinnyQr(Eigen::Index columns) : buffer_(64, columns) {}

Eigen::Ref<Eigen::MatrixXd> TallSkinnyQr::rows(Eigen::Index count) {
  const Eigen::Index most = 2 * buffer_.cols() + 1024;
  if (filled_ + count > most) shrink();
  if (filled_ + count > buffer_.rows())
    buffer_.conservativeResize(std::min(most, 2 * (filled_ + count)), Eigen::NoChange);
  filled_ += count;
  auto added = buffer_.middleRows(filled_ - count, count);
  added.setZero();
  return added;
}

void TallSkinnyQr::shrink() {
  if (buffer_.cols() > 0) factor_in_place(buffer_, filled_);
  filled_ = buffer_.cols();
}

Eigen::MatrixXd TallSkinnyQr::factor() { return triangle(buffer_.topRows(filled_)); }

Eigen::MatrixXd combine(MPI_Comm comm, const Eigen::MatrixXd& mine) {
  int size = 1, rank = 0;
  MPI_Comm_size(comm, &size);
  MPI_Comm_rank(comm, &rank);
  if (size == 1) return triangle(mine);
  const Eigen::Index columns = mine.cols();
  const int count = static_cast<int>(mine.rows());
  std::vector<int> rows(size), sizes(size), first(size, 0);
  MPI_Allgather(&count, 1, MPI_INT, rows.data(), 1, MPI_INT, comm);
  int total = 0;
  for (int r = 0; r < size; ++r) {
    sizes[r] = rows[r] * static_cast<int>(columns);
    first[r] = total * static_cast<int>(columns);
    total += rows[r];
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor send = mine;
  RowMajor all(total, columns);
  MPI_Gatherv(send.data(), sizes[rank], MPI_DOUBLE, all.data(), sizes.data(), first.data(), MPI_DOUBLE, 0, comm);
  Eigen::MatrixXd factor = rank == 0 ? triangle(all) : Eigen::MatrixXd();
  int final_rows = static_cast<int>(factor.rows());
  MPI_Bcast(&final_rows, 1, MPI_INT, 0, comm);
  factor.resize(final_rows, columns);
  MPI_Bcast(factor.data(), static_cast<int>(factor.size()), MPI_DOUBLE, 0, comm);
  return factor;
}

}  // namespace floe::reduction
