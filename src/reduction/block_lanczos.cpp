#include "block_lanczos.h"

#include <slepc/private/epsimpl.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "block_vectors.h"
#include "floe/petsc/error.h"

namespace floe::reduction {
namespace {

using namespace block_vectors;

constexpr PetscInt usual_block = 8;
constexpr double orthogonal = 1e-12;  // enough for residuals of 1e-10

struct Data {
  PetscInt block = usual_block;
  BV W = nullptr;      // the block that comes next
  BV P = nullptr;      // M times it
  BV fixed = nullptr;  // what is deflated
  Mat M = nullptr;
};

Data* data_of(EPS eps) { return static_cast<Data*>(eps->data); }

// Makes W orthonormal, also to the active columns of V and to what is deflated; P = M W. W before = V ... + W R.
PetscErrorCode orthonormalise(EPS eps, Eigen::MatrixXd& R) {
  Data* data = data_of(eps);
  const PetscInt b = data->block;
  Eigen::MatrixXd G, H, D;

  PetscFunctionBegin;
  R.setIdentity(b, b);
  for (int pass = 0; pass < 8; ++pass) {
    bool replaced;
    PetscCall(BVMatMult(data->W, data->M, data->P));
    PetscCall(dot(data->P, data->W, G));
    PetscCheck(G.allFinite(), PetscObjectComm((PetscObject)eps), PETSC_ERR_FP, "A block of vectors is not finite");
    PetscCall(replace_zeros(data->W, G, R, &replaced));
    if (replaced) continue;
    PetscCall(dot(eps->V, data->P, H));
    if (data->fixed) PetscCall(dot(data->fixed, data->P, D));
    const auto greatest = [](const Eigen::MatrixXd& A) { return A.size() > 0 ? A.cwiseAbs().maxCoeff() : 0; };
    const double apart = greatest(G - Eigen::MatrixXd::Identity(b, b));
    const bool last = pass > 0 && std::max(greatest(H), greatest(D)) < orthogonal && apart < 1e-6;
    if (last && apart < orthogonal) break;
    if (H.size() > 0) PetscCall(add_product(data->W, -1, eps->V, H));
    if (D.size() > 0) PetscCall(add_product(data->W, -1, data->fixed, D));
    G -= H.transpose() * H;
    if (D.size() > 0) G -= D.transpose() * D;
    Normaliser by = normaliser(G);
    PetscCall(multiply(data->W, by.T));
    R = by.R * R;
    if (!last) continue;
    PetscCall(multiply(data->P, by.T));
    break;
  }
  PetscFunctionReturn(0);
}

// W = (K - s M)^-1 P
PetscErrorCode solve_block(EPS eps) {
  Data* data = data_of(eps);
  Mat P, W;
  KSP ksp;
  KSPConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(STGetKSP(eps->st, &ksp));
  PetscCall(BVGetMat(data->P, &P));
  PetscCall(BVGetMat(data->W, &W));
  PetscCall(KSPMatSolve(ksp, P, W));
  PetscCall(BVRestoreMat(data->W, &W));
  PetscCall(BVRestoreMat(data->P, &P));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCheck(reason >= 0, PetscObjectComm((PetscObject)eps), PETSC_ERR_NOT_CONVERGED, "Block solve: %s",
             KSPConvergedReasons[reason]);
  PetscFunctionReturn(0);
}

// The columns of W become those of V from `first` on.
PetscErrorCode append(EPS eps, PetscInt first) {
  Data* data = data_of(eps);

  PetscFunctionBegin;
  PetscCall(BVSetActiveColumns(eps->V, first, first + data->block));
  PetscCall(BVCopy(data->W, eps->V));
  PetscFunctionReturn(0);
}

// The columns of V from `locked` on, times S.
PetscErrorCode rotate(EPS eps, PetscInt locked, const Eigen::MatrixXd& S) {
  const PetscInt m = locked + static_cast<PetscInt>(S.rows()), end = locked + static_cast<PetscInt>(S.cols());
  Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(m, end);
  Q.bottomRightCorner(S.rows(), S.cols()) = S;

  PetscFunctionBegin;
  if (S.cols() == 0) PetscFunctionReturn(0);
  PetscCall(BVSetActiveColumns(eps->V, 0, m));
  PetscCall(multiply(eps->V, Q, locked));
  PetscFunctionReturn(0);
}

// The pairs of the projected matrix, greatest |theta| first.
struct Ritz {
  Eigen::VectorXd theta;
  Eigen::MatrixXd S;
};

Ritz ritz(const Eigen::MatrixXd& T) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> pairs(T);
  std::vector<Eigen::Index> order(T.cols());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) {
    return std::abs(pairs.eigenvalues()[i]) > std::abs(pairs.eigenvalues()[j]);
  });
  Ritz sorted{Eigen::VectorXd(T.cols()), Eigen::MatrixXd(T.rows(), T.cols())};
  for (Eigen::Index i = 0; i < T.cols(); ++i) {
    sorted.theta[i] = pairs.eigenvalues()[order[i]];
    sorted.S.col(i) = pairs.eigenvectors().col(order[i]);
  }
  return sorted;
}

// Error estimates of the pairs behind those that are locked; the first that have converged are counted.
PetscErrorCode count_converged(EPS eps, PetscInt locked, const Ritz& pairs, const Eigen::MatrixXd& R) {
  const Eigen::VectorXd residual = (R * pairs.S.bottomRows(R.cols())).colwise().norm();
  bool all = true;

  PetscFunctionBegin;
  eps->nconv = locked;
  for (PetscInt i = 0; i < pairs.theta.size(); ++i) {
    const PetscInt at = locked + i;
    eps->eigr[at] = pairs.theta[i], eps->eigi[at] = 0;
    PetscCall((*eps->converged)(eps, eps->eigr[at], 0, residual[i], &eps->errest[at], eps->convergedctx));
    all = all && eps->errest[at] < eps->tol;
    eps->nconv += all;
  }
  PetscFunctionReturn(0);
}

// V <- the first pairs' vectors; T accordingly. Those that have converged are locked: their coupling to what comes is
// below the tolerance and taken for nothing, else those of one frequency would mix with ones that have not.
PetscErrorCode restart(EPS eps, const Ritz& pairs, const Eigen::MatrixXd& R, Eigen::MatrixXd& T, PetscInt* locked,
                       PetscInt* kept) {
  const PetscInt b = data_of(eps)->block, m = static_cast<PetscInt>(pairs.theta.size()), done = eps->nconv - *locked;
  const PetscInt keep = std::min(done + (m - done) / 2, m - b), open = std::max<PetscInt>(keep - done, 0);

  PetscFunctionBegin;
  PetscCall(rotate(eps, *locked, pairs.S.leftCols(keep)));
  *kept = *locked + keep;
  *locked = *kept - open;
  T.setZero();
  T.block(*locked, *locked, open, open).diagonal() = pairs.theta.segment(keep - open, open);
  T.block(*kept, *locked, b, open) = R * pairs.S.block(m - b, keep - open, b, open);
  T.block(*locked, *kept, open, b) = T.block(*kept, *locked, b, open).transpose();
  PetscFunctionReturn(0);
}

// The first block: the initial space, and random vectors.
PetscErrorCode start(EPS eps) {
  Data* data = data_of(eps);
  Eigen::MatrixXd R;

  PetscFunctionBegin;
  for (PetscInt j = eps->nini; j < data->block; ++j) PetscCall(BVSetRandomColumn(eps->V, j));
  PetscCall(BVSetActiveColumns(eps->V, 0, data->block));
  PetscCall(BVCopy(eps->V, data->W));
  PetscCall(BVSetActiveColumns(eps->V, 0, 0));
  PetscCall(orthonormalise(eps, R));
  PetscCall(append(eps, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode iterate(EPS eps) {
  Data* data = data_of(eps);
  const PetscInt b = data->block;
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(eps->ncv + b, eps->ncv + b), A, R;
  Ritz pairs;
  PetscInt k = 0, locked = 0;

  PetscFunctionBegin;
  PetscCall(start(eps));
  while (true) {
    eps->its++;
    const PetscInt m = k + b;  // V: k columns and the block of b; P = M times the block
    PetscCall(solve_block(eps));
    PetscCall(dot(data->P, data->W, A));
    T.block(k, k, b, b) = (A + A.transpose()) / 2;
    Eigen::MatrixXd before = T.block(0, k, m, b);
    PetscCall(BVSetActiveColumns(eps->V, 0, m));
    PetscCall(add_product(data->W, -1, eps->V, before));
    PetscCall(orthonormalise(eps, R));
    pairs = ritz(T.block(locked, locked, m - locked, m - locked));
    PetscCall(count_converged(eps, locked, pairs, R));
    PetscCall(EPSMonitor(eps, eps->its, eps->nconv, eps->eigr, eps->eigi, eps->errest, std::min(eps->nconv + 1, m)));
    PetscCall((*eps->stopping)(eps, eps->its, eps->max_it, eps->nconv, eps->nev, &eps->reason, eps->stoppingctx));
    if (eps->reason != EPS_CONVERGED_ITERATING) break;
    k = m;
    if (m + b > eps->ncv) {
      PetscCall(restart(eps, pairs, R, T, &locked, &k));
    } else {
      T.block(m, m - b, b, b) = R;
      T.block(m - b, m, b, b) = R.transpose();
    }
    PetscCall(append(eps, k));
  }
  PetscCall(rotate(eps, locked, pairs.S.leftCols(eps->nconv - locked)));
  PetscCall(BVSetActiveColumns(eps->V, 0, eps->nconv));
  PetscFunctionReturn(0);
}

// The columns of V before the first, which EPSSetDeflationSpace has filled, in a BV of their own.
PetscErrorCode take_deflated(EPS eps) {
  Data* data = data_of(eps);

  PetscFunctionBegin;
  if (eps->nds <= 0) PetscFunctionReturn(0);
  PetscCall(BVDuplicateResize(eps->V, eps->nds, &data->fixed));
  PetscCall(BVSetMatrix(data->fixed, nullptr, PETSC_FALSE));
  for (PetscInt j = 0; j < eps->nds; ++j) {
    Vec column;
    PetscCall(BVGetColumn(eps->V, j - eps->nds, &column));
    PetscCall(BVInsertVec(data->fixed, j, column));
    PetscCall(BVRestoreColumn(eps->V, j - eps->nds, &column));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode reset(EPS eps) {
  Data* data = data_of(eps);

  PetscFunctionBegin;
  PetscCall(BVDestroy(&data->W));
  PetscCall(BVDestroy(&data->P));
  PetscCall(BVDestroy(&data->fixed));
  PetscCall(MatDestroy(&data->M));
  PetscFunctionReturn(0);
}

// Products of V are plain ones meanwhile: M is multiplied with each block here, once for all.
PetscErrorCode solve(EPS eps) {
  Data* data = data_of(eps);

  PetscFunctionBegin;
  PetscCall(STGetBilinearForm(eps->st, &data->M));
  PetscCall(BVSetMatrix(eps->V, nullptr, PETSC_FALSE));
  PetscCall(BVDuplicateResize(eps->V, data->block, &data->W));
  // MatMatMult of MATSEQSBAIJ with blocks of three is wrong in PETSc 3.18.5, and no faster with those of six.
  PetscCall(BVSetMatMultMethod(data->W, BV_MATMULT_VECS));
  PetscCall(BVDuplicateResize(eps->V, data->block, &data->P));
  PetscCall(take_deflated(eps));
  PetscCall(iterate(eps));
  PetscCall(BVSetMatrix(eps->V, data->M, PETSC_FALSE));
  PetscCall(reset(eps));
  PetscFunctionReturn(0);
}

PetscErrorCode set_up(EPS eps) {
  const PetscInt b = data_of(eps)->block;

  PetscFunctionBegin;
  EPSCheckHermitianDefinite(eps);
  EPSCheckSinvert(eps);
  EPSCheckUnsupported(eps, EPS_FEATURE_ARBITRARY | EPS_FEATURE_REGION | EPS_FEATURE_EXTRACTION | EPS_FEATURE_TWOSIDED);
  PetscCheck(eps->which == EPS_TARGET_MAGNITUDE || !eps->which, PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
             "block-lanczos computes the eigenvalues nearest the target only (-%seps_target_magnitude)",
             ((PetscObject)eps)->prefix ? ((PetscObject)eps)->prefix : "");
  eps->which = EPS_TARGET_MAGNITUDE;
  if (eps->ncv == PETSC_DEFAULT) eps->ncv = std::min(eps->n, block_lanczos_space(eps->nev));
  PetscCheck(eps->ncv >= eps->nev + 3 * b, PetscObjectComm((PetscObject)eps), PETSC_ERR_USER_INPUT,
             "block-lanczos needs room for three blocks beside the eigenvectors: -%seps_ncv %" PetscInt_FMT " or more",
             ((PetscObject)eps)->prefix ? ((PetscObject)eps)->prefix : "", eps->nev + 3 * b);
  if (eps->mpd == PETSC_DEFAULT) eps->mpd = eps->ncv;
  if (eps->max_it == PETSC_DEFAULT) eps->max_it = 500;
  PetscCall(EPSAllocateSolution(eps, 0));
  PetscCall(EPS_SetInnerProduct(eps));
  PetscFunctionReturn(0);
}

PetscErrorCode set_up_sort(EPS eps) {
  PetscFunctionBegin;
  eps->sc->comparison = SlepcCompareTargetMagnitude;
  eps->sc->comparisonctx = &eps->target;
  eps->sc->map = nullptr;
  eps->sc->mapobj = nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode set_from_options(EPS eps, PetscOptionItems* PetscOptionsObject) {
  PetscFunctionBegin;
  PetscOptionsHeadBegin(PetscOptionsObject, "EPS block Lanczos options");
  PetscCall(PetscOptionsRangeInt("-eps_block_lanczos_size", "Number of vectors per block", "", data_of(eps)->block,
                                 &data_of(eps)->block, nullptr, 1, 64));
  PetscOptionsHeadEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode back_transform(EPS eps) {
  PetscFunctionBegin;
  PetscCall(STBackTransform(eps->st, eps->nconv, eps->eigr, eps->eigi));
  PetscFunctionReturn(0);
}

PetscErrorCode compute_vectors(EPS) { return 0; }  // they are there

PetscErrorCode show(EPS eps, PetscViewer viewer) {
  PetscBool ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (ascii) PetscCall(PetscViewerASCIIPrintf(viewer, "  blocks of %" PetscInt_FMT " vectors\n", data_of(eps)->block));
  PetscFunctionReturn(0);
}

PetscErrorCode destroy(EPS eps) {
  PetscFunctionBegin;
  delete data_of(eps);
  eps->data = nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode create(EPS eps) {
  PetscFunctionBegin;
  eps->data = new Data;
  eps->useds = PETSC_FALSE;
  eps->categ = EPS_CATEGORY_KRYLOV;
  eps->ops->solve = solve;
  eps->ops->setup = set_up;
  eps->ops->setupsort = set_up_sort;
  eps->ops->setfromoptions = set_from_options;
  eps->ops->backtransform = back_transform;
  eps->ops->computevectors = compute_vectors;
  eps->ops->reset = reset;
  eps->ops->view = show;
  eps->ops->destroy = destroy;
  PetscFunctionReturn(0);
}

}  // namespace

PetscInt block_size(EPS eps) {
  PetscBool blocks = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)eps, block_lanczos, &blocks));
  return blocks ? data_of(eps)->block : 1;
}

void register_block_lanczos() { petsc::check(EPSRegister(block_lanczos, create)); }

PetscInt block_lanczos_space(PetscInt count) { return 2 * count + 10 * usual_block; }

void register_eigensolvers() { register_block_lanczos(); }

}  // namespace floe::reduction
