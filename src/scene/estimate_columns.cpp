#include "estimate_columns.h"

#include <fmt/format.h>

namespace floe::scene {

using petsc::check;

reduction::Columns response_columns(const reduction::Statics& statics, const reduction::Columns& loads, int most) {
  const reduction::Columns u = statics.solve(loads);
  const Eigen::Index n = static_cast<Eigen::Index>(u.size());
  std::vector<Vec> bare;
  for (const auto& load : loads) bare.push_back(load);
  Eigen::MatrixXd work(n, n);
  for (Eigen::Index i = 0; i < n; ++i) check(VecMDot(u[i], static_cast<PetscInt>(n), bare.data(), work.col(i).data()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (work + work.transpose()));
  const double greatest = n > 0 ? eigen.eigenvalues()[n - 1] : 0;
  reduction::Columns columns;
  for (Eigen::Index i = n - 1; i >= 0 && std::ssize(columns) < most; --i) {
    if (!(eigen.eigenvalues()[i] > 1e-8 * greatest)) break;
    columns.push_back(reduction::copy(u[0]));
    check(VecSet(columns.back(), 0));
    for (Eigen::Index j = 0; j < n; ++j) check(VecAXPY(columns.back(), eigen.eigenvectors()(j, i), u[j]));
  }
  return columns;
}

ReducedBody with_columns(const PreparedBody& body, const ReducedBody& reduced, const reduction::Columns& W) {
  using reduction::ColumnOrigin;
  const int k = reduced.body.coordinates();
  reduction::Columns all;
  std::vector<ColumnOrigin> origins;
  for (int i = 0; i < k; ++i) {
    Vec column = nullptr;
    check(BVGetColumn(reduced.basis->V, i, &column));
    all.push_back(reduction::copy(column));
    check(BVRestoreColumn(reduced.basis->V, i, &column));
    origins.push_back({ColumnOrigin::Kind::mode, fmt::format("column {}", i + 1)});
  }
  for (std::size_t i = 0; i < W.size(); ++i) {
    all.push_back(reduction::copy(W[i]));
    origins.push_back({ColumnOrigin::Kind::attachment, fmt::format("response {}", i + 1)});
  }
  ReducedBody more;
  more.basis = std::make_shared<reduction::Basis>(
      reduction::orthonormal_basis(body.structure, all, std::move(origins), body.spec.reduction.drop_tolerance));
  more.body = reduction::project(body.structure, *more.basis);
  more.report = reduced.report;
  more.report.basis = more.basis;
  more.report.columns = more.basis->columns;
  if (reduced.damping.size() > 0) {
    const DampingSpec& spec = body.spec.damping;
    more.damping = spec.stiffness * more.body.elasticity.linear_stiffness();
    more.damping.diagonal().array() += spec.mass;
    more.damping.topLeftCorner(k, k) = reduced.damping;
  }
  return more;
}

}  // namespace floe::scene
