#include "floe/fem/structure.h"

#include <algorithm>

#include "cells.h"
#include "floe/fem/transform.h"
#include "kept.h"
#include "node_graph.h"

namespace floe::fem {

using petsc::check;

Exchange::Exchange(const Mesh& mesh, int dofs) {
  std::vector<PetscInt> blocks;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) blocks.push_back(mesh.global_node(static_cast<int>(i)));
  petsc::IsHandle from;
  petsc::VecHandle global;
  check(ISCreateBlock(mesh.comm, dofs, static_cast<PetscInt>(blocks.size()), blocks.data(), PETSC_COPY_VALUES,
                      from.out()));
  check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(dofs * blocks.size()), local_.out()));
  check(VecCreateMPI(mesh.comm, dofs * mesh.owned_nodes, dofs * mesh.node_count, global.out()));
  check(VecScatterCreate(global, from, local_, nullptr, scatter_.out()));
}

Eigen::VectorXd Exchange::gather(Vec field) const {
  PetscInt n = 0;
  check(VecGetLocalSize(local_, &n));
  Eigen::VectorXd local(n);
  gather(field, local.data());
  return local;
}

void Exchange::gather(Vec field, double* local) const {
  check(VecPlaceArray(local_, local));
  check(VecScatterBegin(scatter_, field, local_, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter_, field, local_, INSERT_VALUES, SCATTER_FORWARD));
  check(VecResetArray(local_));
}

void Exchange::add(const double* local, Vec field) const {
  check(VecPlaceArray(local_, const_cast<double*>(local)));
  check(VecScatterBegin(scatter_, local_, field, ADD_VALUES, SCATTER_REVERSE));
  check(VecScatterEnd(scatter_, local_, field, ADD_VALUES, SCATTER_REVERSE));
  check(VecResetArray(local_));
}

Structure::Structure(Mesh m, std::vector<Section> s, MembraneStrain e)
    : mesh(std::move(m)),
      sections(std::move(s)),
      strain(e),
      dofs_per_node(mesh.dimension == 2 ? 3 : 6),
      exchange(mesh, dofs_per_node),
      graph(std::make_shared<const NodeGraph>(node_graph(mesh))),
      kept(std::make_shared<Kept>()) {
  check_cells(*this);
}

Structure planar_structure(Mesh mesh, const std::vector<BeamSection>& sections, MembraneStrain strain) {
  return Structure(std::move(mesh), std::vector<Section>(sections.begin(), sections.end()), strain);
}

std::vector<int> Structure::cell_dofs(const Mesh::Cell& cell) const {
  std::vector<int> dofs;
  for (int node : cell.nodes())
    for (int d = 0; d < dofs_per_node; ++d) dofs.push_back(dofs_per_node * node + d);
  return dofs;
}

Eigen::VectorXd nodal_motion(const Structure& structure, const double* owned, int node) {
  const int n = structure.dofs_per_node;
  const std::vector<Mesh::DependentNode>& all = structure.mesh.dependent_nodes;
  const auto found = std::lower_bound(all.begin(), all.end(), node,
                                      [](const Mesh::DependentNode& f, int wanted) { return f.node < wanted; });
  const bool follows = found != all.end() && found->node == node;
  Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(
      owned + static_cast<std::ptrdiff_t>(n) * (follows ? found->independent_node : node), n);
  if (!follows) return q;
  const Eigen::Vector3d arm = structure.mesh.positions[node] - structure.mesh.positions[found->independent_node];
  if (n == 3) return rigid_arm(Eigen::Vector2d(arm.head<2>())) * q;
  const Mesh::Spin* spin = spin_of(structure.mesh, node);
  if (!spin) return rigid_arm(arm) * q;
  Eigen::VectorXd moved = spin_arm(arm, spin->own()) * q;
  moved.tail<3>() += spin->own() * Eigen::Map<const Eigen::Vector3d>(owned + static_cast<std::ptrdiff_t>(6) * node + 3);
  return moved;
}

petsc::VecHandle field(const Structure& structure) {
  petsc::VecHandle vector;
  check(VecCreate(structure.mesh.comm, vector.out()));
  check(VecSetSizes(vector, structure.owned_dofs(), structure.dofs()));
  check(VecSetBlockSize(vector, structure.dofs_per_node));
  check(VecSetType(vector, VECSTANDARD));
  check(VecSet(vector, 0));
  return vector;
}

double extent(const Structure& structure) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const Eigen::Vector3d& x : structure.mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  return (high - low).norm();
}

std::vector<petsc::VecHandle> rigid_motions(const Structure& structure) {
  const int d = structure.dimension(), per_node = structure.dofs_per_node;
  std::vector<petsc::VecHandle> motions;
  for (int motion = 0; motion < structure.rigid_motion_count(); ++motion) {
    motions.push_back(field(structure));
    double* values = nullptr;
    check(VecGetArray(motions.back(), &values));
    const Eigen::Vector3d axis = d == 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(Eigen::Vector3d::Unit(motion % 3));
    for (PetscInt node = 0; node < structure.mesh.owned_nodes; ++node) {
      double* at = values + static_cast<std::ptrdiff_t>(per_node) * node;
      if (motion < d) {
        at[motion] = 1;
        continue;
      }
      const Eigen::Vector3d u = axis.cross(structure.mesh.positions[node]);
      for (int i = 0; i < d; ++i) at[i] = u[i];
      at[motion] = 1;
    }
    for (const Mesh::DependentNode& dependent_node : structure.mesh.dependent_nodes) {
      double* at = values + static_cast<std::ptrdiff_t>(per_node) * dependent_node.node;
      std::fill_n(at, per_node, 0.0);
      if (const Mesh::Spin* spin = spin_of(structure.mesh, dependent_node.node); spin && motion >= d)
        Eigen::Vector3d::Map(at + 3) = spin->own().transpose() * axis;
    }
    check(VecRestoreArray(motions.back(), &values));
  }
  return motions;
}

}  // namespace floe::fem
