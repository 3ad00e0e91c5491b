#include "block_lanczos.h"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"

namespace floe::reduction {

using Eigen::MatrixXd;
using petsc::check;

namespace {

constexpr int width = 3;

/// Between -1/2 and 1/2, without a pattern.
double rough(PetscInt dof, int column) {
  const double x = 43758.5453 * std::sin(12.9898 * double(dof + 1) + 78.233 * (column + 1));
  return x - std::floor(x) - 0.5;
}

/// C = A'B of all ranks, the same on all.
MatrixXd inner(MPI_Comm comm, const double* A, int a, const double* B, int b, PetscBLASInt n) {
  MatrixXd C = MatrixXd::Zero(a, b);
  const PetscBLASInt rows = a, columns = b, lead = std::max(n, PetscBLASInt(1));
  const double one = 1, zero = 0;
  if (a > 0 && n > 0) BLASgemm_("T", "N", &rows, &columns, &n, &one, A, &lead, B, &lead, &zero, C.data(), &rows);
  MatrixXd all = C;
  MPI_Reduce(C.data(), all.data(), a * b, MPI_DOUBLE, MPI_SUM, 0, comm);
  MPI_Bcast(all.data(), a * b, MPI_DOUBLE, 0, comm);
  return all;
}

/// B += factor A C
void add_product(const double* A, const MatrixXd& C, double factor, double* B, PetscBLASInt n) {
  const PetscBLASInt inner = static_cast<PetscBLASInt>(C.rows()), columns = static_cast<PetscBLASInt>(C.cols());
  const double one = 1;
  if (n > 0 && inner > 0) BLASgemm_("N", "N", &n, &columns, &inner, &factor, A, &n, C.data(), &inner, &one, B, &n);
}

/// B <- B R^-1, R upper triangular.
void divide(const MatrixXd& R, double* B, PetscBLASInt n) {
  const PetscBLASInt columns = static_cast<PetscBLASInt>(R.rows());
  const double one = 1;
  if (n > 0) BLAStrsm_("R", "U", "N", "N", &n, &columns, &one, R.data(), &columns, B, &n);
}

/// The Krylov space: Q and M Q of this rank, by columns, and T = Q'M K^-1 M Q.
class Space {
 public:
  Space(const fem::Structure& structure, KSP solver, Mat M, const fem::Conditions& held, int most)
      : structure_(structure),
        solver_(solver),
        M_(M),
        held_(held),
        n_(static_cast<PetscBLASInt>(structure.owned_dofs())),
        loads_(dense_like(fem::field(structure), width)),
        found_(dense_like(fem::field(structure), width)),
        from_(fem::field(structure)),
        to_(fem::field(structure)),
        Q_(n_, most),
        MQ_(n_, most),
        T_(MatrixXd::Zero(most, most)) {}

  /// The first block, smooth: K^-1 of rough loads that depend on the dofs' original numbers only, not on ranks.
  bool start() {
    for (int j = 0; j < width; ++j) {
      Vec load = nullptr;
      check(MatDenseGetColumnVecWrite(loads_, j, &load));
      {
        petsc::Values values(load);
        for (PetscInt i = 0; i < values.end - values.first; ++i)
          values.begin()[i] = rough(structure_.original_dof(static_cast<int>(i)), j);
      }
      fem::hold(load, held_);
      check(MatMult(M_, load, to_));
      check(VecCopy(to_, load));
      check(MatDenseRestoreColumnVecWrite(loads_, j, &load));
    }
    block_solve(solver_, loads_, found_);
    return join().has_value();
  }

  /// One block more. @return  R with K^-1 M Q_j - Q T_j = Q_(j+1) R; empty where nothing new is left
  std::optional<MatrixXd> grow() {
    double* load = nullptr;
    check(MatDenseGetArrayWrite(loads_, &load));
    std::copy(MQ_.col(columns_ - width).data(), MQ_.col(columns_ - width).data() + std::ptrdiff_t(n_) * width, load);
    check(MatDenseRestoreArrayWrite(loads_, &load));
    block_solve(solver_, loads_, found_);
    return join();
  }

  int columns() const { return columns_; }
  /// Of all blocks but the last one.
  auto projected() const { return T_.topLeftCorner(columns_ - width, columns_ - width); }
  /// K^-1 M Q s / theta, a column for each of S and theta: Q s, of which what decays fast has decayed once more.
  Columns refined(const MatrixXd& S, const std::vector<double>& theta) const {
    const petsc::MatHandle loads = dense_like(from_, theta.size()), found = dense_like(from_, theta.size());
    double* load = nullptr;
    check(MatDenseGetArray(loads, &load));
    add_product(MQ_.data(), S, 1, load, n_);
    check(MatDenseRestoreArray(loads, &load));
    block_solve(solver_, loads, found);
    Columns columns = columns_of(found);
    for (std::size_t i = 0; i < columns.size(); ++i) check(VecScale(columns[i], 1 / theta[i]));
    return columns;
  }

 private:
  /// Puts what `found_` has besides Q into Q.
  std::optional<MatrixXd> join() {
    const MPI_Comm comm = structure_.mesh.comm;
    double *W = Q_.col(columns_).data(), *MW = MQ_.col(columns_).data();
    const double* found = nullptr;
    check(MatDenseGetArrayRead(found_, &found));
    std::copy(found, found + std::ptrdiff_t(n_) * width, W);
    check(MatDenseRestoreArrayRead(found_, &found));
    MatrixXd along = MatrixXd::Zero(columns_, width);
    for (int twice = 0; twice < 2 && columns_ > 0; ++twice) {
      const MatrixXd more = inner(comm, MQ_.data(), columns_, W, width, n_);
      add_product(Q_.data(), more, -1, W, n_);
      along += more;
    }
    multiply(W, MW);
    MatrixXd R = MatrixXd::Identity(width, width);
    for (int twice = 0; twice < 2; ++twice) {
      const MatrixXd G = inner(comm, W, width, MW, width, n_);
      const Eigen::LLT<MatrixXd> cholesky((G + G.transpose()) / 2);
      const MatrixXd U = cholesky.matrixU();
      if (cholesky.info() != Eigen::Success ||
          !(U.diagonal().cwiseAbs().minCoeff() > 1e-7 * U.diagonal().cwiseAbs().maxCoeff()))
        return {};
      divide(U, W, n_), divide(U, MW, n_);
      R = U * R;
    }
    if (columns_ > 0) {
      const int last = columns_ - width;
      T_.block(0, last, columns_, width) = along;
      T_.block(last, 0, width, columns_) = along.transpose();
    }
    columns_ += width;
    return R;
  }
  void multiply(const double* from, double* to) {
    for (int j = 0; j < width; ++j) {
      std::copy(from + std::ptrdiff_t(n_) * j, from + std::ptrdiff_t(n_) * (j + 1), petsc::Values(from_).begin());
      check(MatMult(M_, from_, to_));
      std::copy_n(petsc::Values(to_).begin(), n_, to + std::ptrdiff_t(n_) * j);
    }
  }

  const fem::Structure& structure_;
  KSP solver_;
  Mat M_;
  const fem::Conditions& held_;
  PetscBLASInt n_;
  petsc::MatHandle loads_, found_;
  petsc::VecHandle from_, to_;
  MatrixXd Q_, MQ_, T_;
  int columns_ = 0;
};

}  // namespace

std::optional<RitzPairs> block_lanczos(const fem::Structure& structure, KSP solver, Mat M, const fem::Conditions& held,
                                       int count, double tolerance) {
  const int most = width * ((3 * count + 60) / width);
  Space space(structure, solver, M, held, most);
  if (!space.start()) return {};
  while (space.columns() + width <= most) {
    const std::optional<MatrixXd> R = space.grow();
    if (!R) return {};
    const MatrixXd T = space.projected();
    if (T.rows() < count) continue;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz((T + T.transpose()) / 2);
    RitzPairs pairs;
    double worst = 0;
    for (int i = 0; i < count; ++i) {
      const Eigen::Index at = T.rows() - 1 - i;
      pairs.theta.push_back(ritz.eigenvalues()[at]);
      pairs.residual.push_back((*R * ritz.eigenvectors().col(at).tail(width)).norm() / pairs.theta[i]);
      worst = std::max(worst, pairs.residual[i]);
    }
    if (!(worst < tolerance)) continue;
    pairs.vectors = space.refined(ritz.eigenvectors().rightCols(count).rowwise().reverse(), pairs.theta);
    return pairs;
  }
  return {};
}

}  // namespace floe::reduction
