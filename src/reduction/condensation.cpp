#include "floe/reduction/condensation.h"

#include <algorithm>

#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "floe/reduction/products.h"
#include "floe/reduction/projection.h"
#include "tall_skinny.h"

namespace floe::reduction {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

namespace {

/// Whether any shell or beam of the body has strains of second order. Collective.
bool may_lock(const fem::Structure& structure) {
  int found = 0;
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const fem::Section& section = structure.sections[cell.part];
    const auto* shell = std::get_if<fem::ShellSection>(&section);
    const auto* beam = std::get_if<fem::SpatialBeam>(&section);
    if (shell && shell->strains == fem::Strains::second_order) found = 1;
    if (beam && beam->strain.strains == fem::Strains::second_order) found = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, structure.mesh.comm);
  return found != 0;
}

/// V q at the local dofs. Collective.
VectorXd lifted(const fem::Structure& structure, const Basis& basis, const VectorXd& q) {
  const petsc::VecHandle field = fem::field(structure);
  VectorXd coefficients = q;
  check(BVMultVec(basis.V, 1, 0, field, coefficients.data()));
  return structure.exchange.gather(field);
}

/// Two fields at the local dofs.
using FieldPair = std::pair<VectorXd, VectorXd>;

/// -sum_g w_g L'D e(u, v) of each pair. Collective.
Columns strain_loads(const fem::Structure& structure, const std::vector<FieldPair>& pairs) {
  std::vector<VectorXd> sums;
  for (const auto& pair : pairs) sums.push_back(VectorXd::Zero(pair.first.size()));
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const fem::ElementMaps maps = structure.maps(cell);
    const auto dofs = structure.cell_dofs(cell);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const VectorXd u = pairs[n].first(dofs), v = pairs[n].second(dofs);
      VectorXd f = VectorXd::Zero(u.size());
      for (const fem::StrainPoint& g : maps.membrane)
        f.noalias() -= g.weight * g.L.transpose() * (g.D * g.bilinear(g.G * u, g.G * v));
      sums[n](dofs) += f;
    }
  }
  Columns loads;
  for (const VectorXd& sum : sums) {
    loads.push_back(fem::field(structure));
    structure.exchange.add(sum, loads.back());
  }
  return loads;
}

/// An orthonormal basis Q of the columns of A without what they have in common with those of B: Q = A from_A + B
/// from_B.
struct Beyond {
  MatrixXd Q, from_A, from_B;
};

Beyond beyond(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::ColPivHouseholderQR<MatrixXd> known(B);
  MatrixXd rest = A;
  const MatrixXd Q = MatrixXd(known.householderQ()).leftCols(known.rank());
  for (int pass = 0; pass < 2; ++pass) rest -= Q * (Q.transpose() * rest).eval();
  VectorXd scale(rest.cols());
  for (Index j = 0; j < rest.cols(); ++j) {
    const double norm = rest.col(j).norm();
    scale[j] = norm > 1e-5 * A.col(j).norm() ? 1 / norm : 0;  // less is round-off of what the basis contains
  }
  rest *= scale.asDiagonal();
  const Eigen::BDCSVD<MatrixXd> main(rest, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& sizes = main.singularValues();
  const Index count = sizes.size() > 0 ? (sizes.array() > 1e-4 * sizes[0]).count() : 0;
  if (count == 0) return {MatrixXd(A.rows(), 0), MatrixXd(A.cols(), 0), MatrixXd(B.cols(), 0)};
  const MatrixXd from_A =
      scale.asDiagonal() * main.matrixV().leftCols(count) * sizes.head(count).cwiseInverse().asDiagonal();
  return {main.matrixU().leftCols(count), from_A,
          -Eigen::CompleteOrthogonalDecomposition<MatrixXd>(B).solve(A * from_A)};
}

}  // namespace

Columns relief(const fem::Structure& structure, const Basis& basis, const Statics& statics,
               const body::FlexibleBody& body, const std::vector<char>& follows) {
  const body::Elasticity& e = body.elasticity;
  const auto with_derivative = [&](const std::pair<int, int>& pair) {
    return follows[pair.first] || follows[pair.second];
  };
  Columns all;
  for (const petsc::VecHandle& field : basis.without_mass) all.push_back(copy(field));
  const PetscInt dofs = structure.dofs_per_node * structure.mesh.node_count;
  if (10 * body.coordinates() > 9 * dofs) return all;  // what little the basis lacks is as stiff as round-off is large
  if (!may_lock(structure) || std::none_of(e.pairs.begin(), e.pairs.end(), with_derivative)) return all;
  const std::vector<VectorXd> samples = sampled_deformations(body, follows);
  if (samples.empty()) return all;
  const petsc::Stage stage("condensation");
  std::vector<FieldPair> pairs;
  for (const VectorXd& q : samples) {
    VectorXd leads = q, others = q;
    for (Index i = 0; i < q.size(); ++i) (follows[static_cast<std::size_t>(i)] ? leads : others)[i] = 0;
    pairs.emplace_back(lifted(structure, basis, leads), lifted(structure, basis, others));
  }
  for (petsc::VecHandle& field : statics.solve(strain_loads(structure, pairs))) all.push_back(std::move(field));
  return all;
}

Columns relief(const fem::Structure& structure, const Basis& basis, const Statics& statics,
               const std::vector<VectorXd>& deformations, const Columns& fields) {
  const petsc::Stage stage("condensation");
  std::vector<FieldPair> pairs;
  for (const VectorXd& q : deformations) {
    const VectorXd u = lifted(structure, basis, q);
    for (const petsc::VecHandle& field : fields) pairs.emplace_back(u, structure.exchange.gather(field));
  }
  return statics.solve(strain_loads(structure, pairs));
}

body::Elasticity condensed(const fem::Structure& structure, const Basis& basis, const body::Elasticity& e,
                           Relief& relief) {
  if (!relief.W) return e;
  const petsc::Stage stage("condensation");
  const Index k = basis.columns, pairs = static_cast<Index>(e.pairs.size());
  const MatrixXd R = strain_factor(structure, basis, e.pairs, *relief.W);
  const Beyond free = beyond(R.rightCols(R.cols() - k - pairs), R.leftCols(k));
  body::Elasticity result{MatrixXd::Zero(k, k), {}, e.pairs};  // bending is among the squares
  MatrixXd F = R.leftCols(k + pairs);
  const MatrixXd relieved = free.Q.transpose() * F.rightCols(pairs);
  F.rightCols(pairs) -= free.Q * relieved;
  relief.pairs = e.pairs;
  relief.on_V = -free.from_B * relieved, relief.on_W = -free.from_A * relieved;
  result.F = triangle(std::move(F));
  return result;
}

void add_relief(const Basis& basis, const Relief& relief, const VectorXd& q, Vec field) {
  if (!relief.W || relief.pairs.empty()) return;
  VectorXd s(static_cast<Index>(relief.pairs.size()));
  for (Index p = 0; p < s.size(); ++p) {
    const auto& [a, b] = relief.pairs[static_cast<std::size_t>(p)];
    s[p] = (a == b ? 0.5 : 1) * q[a] * q[b];
  }
  VectorXd on_V = relief.on_V * s;
  const VectorXd on_W = relief.on_W * s;
  check(BVMultVec(basis.V, 1, 1, field, on_V.data()));
  const std::vector<Vec> W(relief.W->begin(), relief.W->end());
  check(VecMAXPY(field, static_cast<PetscInt>(W.size()), on_W.data(), const_cast<Vec*>(W.data())));
}

}  // namespace floe::reduction
