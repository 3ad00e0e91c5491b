#include "floe/assembly/enrichment.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "floe/assembly/combination.h"

namespace floe::assembly {

using petsc::check;

namespace {

/// The greatest of the deformations, and up to `most` in all of which at least this part of it is in none before.
std::vector<std::size_t> unlike(const std::vector<ResidualLoad>& loads, int most, double part = 0.5) {
  if (loads[0].eta.size() == 0) return {};
  Eigen::MatrixXd left(loads[0].eta.size(), static_cast<Eigen::Index>(loads.size()));
  for (std::size_t i = 0; i < loads.size(); ++i) left.col(static_cast<Eigen::Index>(i)) = loads[i].eta;
  std::vector<std::size_t> chosen;
  double greatest = 0;
  while (static_cast<int>(chosen.size()) < most) {
    Eigen::Index at = 0;
    const double size = left.colwise().norm().maxCoeff(&at);
    greatest = std::max(greatest, size);
    if (!chosen.empty() && !(size > part * greatest)) break;
    if (!(size > 0)) break;
    chosen.push_back(static_cast<std::size_t>(at));
    const Eigen::VectorXd direction = left.col(at) / size;
    left -= direction * (direction.transpose() * left).eval();
  }
  return chosen;
}

/// Deformations whose products with new columns are relieved: how many, and what part of the greatest counts.
constexpr int most_relieved = 8;
constexpr double least_relieved = 0.01;

/// Of the largest deformation, in the norm of M: responses below are round-off of the residuals, and directions that
/// the basis has already or that its frame excludes.
constexpr double round_off = 1e-8;

}  // namespace

reduction::Columns responses(const PlannedBody& body, const ReducedBody& reduced,
                             const std::vector<ResidualLoad>& loads, int tangents, std::vector<std::string>& notes) {
  if (loads.empty()) return {};
  std::vector<Eigen::VectorXd> tangents_at = {Eigen::VectorXd::Zero(loads[0].eta.size())};
  for (const std::size_t i : unlike(loads, tangents)) tangents_at.push_back(loads[i].eta);
  std::vector<reduction::Columns> met(tangents_at.size());
  for (const ResidualLoad& one : loads) {
    const auto nearest = std::min_element(tangents_at.begin(), tangents_at.end(), [&](const auto& a, const auto& b) {
      return (one.eta - a).norm() < (one.eta - b).norm();
    });
    met[static_cast<std::size_t>(nearest - tangents_at.begin())].push_back(reduction::copy(one.load));
  }
  reduction::Columns all;
  bool unbent = false;
  for (std::size_t i = 0; i < met.size(); ++i) {
    reduction::Columns u;
    if (i > 0) {
      const petsc::VecHandle q = fem::field(body.structure);
      combine(*reduced.basis, tangents_at[i], q);
      u = reduced.statics->solve_bent(q, met[i]);
      unbent = unbent || (u.empty() && !met[i].empty());
    }
    if (u.empty()) u = reduced.statics->solve(met[i]);
    std::move(u.begin(), u.end(), std::back_inserter(all));
  }
  double largest = 0;
  for (const ResidualLoad& one : loads) largest = std::max(largest, one.eta.norm());
  const petsc::MatHandle M = fem::mass(body.structure, {});
  const petsc::VecHandle product = fem::field(body.structure);
  std::erase_if(all, [&](const petsc::VecHandle& u) {
    double square = 0;
    check(MatMult(M, u, product));
    check(VecDot(u, product, &square));
    return !(std::sqrt(std::max(square, 0.)) > round_off * largest);
  });
  if (unbent)
    notes.push_back(fmt::format(
        "body {}: the tangent stiffness of the deformed body was not factored; that of the undeformed body is used",
        body.spec.name));
  return all;
}

reduction::Columns main_columns(const fem::Structure& structure, const reduction::Columns& u, int most) {
  const Eigen::Index n = static_cast<Eigen::Index>(u.size());
  if (n == 0) return {};
  std::vector<Vec> bare(u.begin(), u.end());
  Eigen::MatrixXd products(n, n);
  const petsc::MatHandle M = fem::mass(structure, {});
  const petsc::VecHandle force = fem::field(structure);
  for (Eigen::Index i = 0; i < n; ++i) {
    check(MatMult(M, u[i], force));
    check(VecMDot(force, static_cast<PetscInt>(n), bare.data(), products.col(i).data()));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (products + products.transpose()));
  const double greatest = eigen.eigenvalues()[n - 1];
  reduction::Columns columns;
  for (Eigen::Index i = n - 1; i >= 0 && std::ssize(columns) < most; --i) {
    if (!(eigen.eigenvalues()[i] > 1e-8 * greatest)) break;
    columns.push_back(reduction::copy(u[0]));
    check(VecSet(columns.back(), 0));
    for (Eigen::Index j = 0; j < n; ++j) check(VecAXPY(columns.back(), eigen.eigenvectors()(j, i), u[j]));
  }
  return columns;
}

void relieve(const PlannedBody& body, const std::vector<ResidualLoad>& loads, const reduction::Columns& W,
             const ReducedBody& reduced, ReducedBody& more) {
  if (!reduced.relief.W || loads.empty()) return;
  std::vector<Eigen::VectorXd> deformations;
  for (const std::size_t i : unlike(loads, most_relieved, least_relieved)) deformations.push_back(loads[i].eta);
  reduction::Columns all = reduction::relief(body.structure, *reduced.basis, *reduced.statics, deformations, W);
  for (const petsc::VecHandle& w : *reduced.relief.W) all.push_back(reduction::copy(w));
  more.relief.W = std::make_shared<const reduction::Columns>(std::move(all));
}

ReducedBody with_columns(const PlannedBody& body, const ReducedBody& reduced, const reduction::Columns& W) {
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
  more.relief.W = reduced.relief.W;
  more.report = reduced.report;
  more.report.basis = more.basis;
  more.report.columns = more.basis->columns;
  if (reduced.damping.size() > 0) {
    more.damping.setZero(more.body.coordinates(), more.body.coordinates());
    more.damping.topLeftCorner(k, k) = reduced.damping;
  }
  return more;
}

}  // namespace floe::assembly
