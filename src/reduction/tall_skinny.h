#pragma once
#include <petscsys.h>

#include <Eigen/Dense>

namespace floe::reduction {

/// R of a QR of very many rows, which are added some at a time: a block of rows is stacked under the R so far, and
/// LAPACK makes a new one of both.
class TallSkinnyQr {
 public:
  explicit TallSkinnyQr(Eigen::Index columns);
  /// Room for `count` more rows, zero; valid until the next call. @param count  at most 64
  Eigen::Ref<Eigen::MatrixXd> rows(Eigen::Index count);
  /// At most as many rows as columns.
  Eigen::MatrixXd factor();

 private:
  void shrink();
  Eigen::MatrixXd buffer_;
  Eigen::Index filled_ = 0;
};

/// R of LAPACK's QR of the rows, at most as many rows as columns; fewer rows are left as they are.
Eigen::MatrixXd triangle(Eigen::MatrixXd rows);

/// One triangle from those of all ranks, in rank order, the same on all. Collective.
Eigen::MatrixXd combine(MPI_Comm comm, const Eigen::MatrixXd& mine);

}  // namespace floe::reduction
