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

/// -sum_g w_g L'D e(u, v) for each sample. Collective.
Columns strain_loads(const fem::Structure& structure, const Basis& basis, const std::vector<char>& follows,
                     const std::vector<VectorXd>& samples) {
  std::vector<VectorXd> of_modes, of_derivatives, sums;
  for (const VectorXd& q : samples) {
    VectorXd leads = q, others = q;
    for (Index i = 0; i < q.size(); ++i) (follows[static_cast<std::size_t>(i)] ? leads : others)[i] = 0;
    of_modes.push_back(lifted(structure, basis, leads)), of_derivatives.push_back(lifted(structure, basis, others));
    sums.push_back(VectorXd::Zero(of_modes.back().size()));
  }
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const fem::ElementMaps maps = structure.maps(cell);
    const auto dofs = structure.cell_dofs(cell);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const VectorXd u = of_modes[n](dofs), v = of_derivatives[n](dofs);
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

/// An orthonormal basis of the columns of A without what they have in common with those of B.
MatrixXd beyond(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::ColPivHouseholderQR<MatrixXd> known(B);
  MatrixXd rest = A;
  const MatrixXd Q = MatrixXd(known.householderQ()).leftCols(known.rank());
  for (int pass = 0; pass < 2; ++pass) rest -= Q * (Q.transpose() * rest).eval();
  for (Index j = 0; j < rest.cols(); ++j) {
    const double norm = rest.col(j).norm();
    rest.col(j) *= norm > 1e-5 * A.col(j).norm() ? 1 / norm : 0;  // less is round-off of what the basis contains
  }
  const Eigen::BDCSVD<MatrixXd> main(rest, Eigen::ComputeThinU);
  const double least = 1e-4 * (main.singularValues().size() > 0 ? main.singularValues()[0] : 0);
  return main.matrixU().leftCols((main.singularValues().array() > least).count());
}

}  // namespace

body::Elasticity condensed(const fem::Structure& structure, const Basis& basis, const Statics& statics,
                           const body::FlexibleBody& body, const std::vector<char>& follows) {
  const body::Elasticity& e = body.elasticity;
  const Index k = body.coordinates(), pairs = static_cast<Index>(e.pairs.size());
  const auto with_derivative = [&](const std::pair<int, int>& pair) {
    return follows[pair.first] || follows[pair.second];
  };
  const PetscInt dofs = structure.dofs_per_node * structure.mesh.node_count;
  if (2 * k > dofs) return e;  // what little the basis lacks is as stiff as round-off is large
  if (!may_lock(structure) || std::none_of(e.pairs.begin(), e.pairs.end(), with_derivative)) return e;
  const std::vector<VectorXd> samples = sampled_deformations(body, follows);
  if (samples.empty()) return e;
  const petsc::Stage stage("condensation");
  const Columns W = statics.solve(strain_loads(structure, basis, follows, samples));
  const MatrixXd R = strain_factor(structure, basis, e.pairs, W);
  const MatrixXd free = beyond(R.rightCols(R.cols() - k - pairs), R.leftCols(k));
  body::Elasticity result{MatrixXd::Zero(k, k), {}, e.pairs};  // bending is among the squares
  MatrixXd F = R.leftCols(k + pairs);
  F.rightCols(pairs) -= free * (free.transpose() * F.rightCols(pairs)).eval();
  result.F = triangle(std::move(F));
  return result;
}

}  // namespace floe::reduction
