#include "floe/fem/structure.h"

#include <algorithm>

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
  check(VecScatterBegin(scatter_, field, local_, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter_, field, local_, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt n = 0;
  const double* values = nullptr;
  check(VecGetLocalSize(local_, &n));
  check(VecGetArrayRead(local_, &values));
  Eigen::VectorXd copy = Eigen::Map<const Eigen::VectorXd>(values, n);
  check(VecRestoreArrayRead(local_, &values));
  return copy;
}

void Exchange::add(const Eigen::VectorXd& local, Vec field) const {
  double* values = nullptr;
  check(VecGetArrayWrite(local_, &values));
  Eigen::Map<Eigen::VectorXd>(values, local.size()) = local;
  check(VecRestoreArrayWrite(local_, &values));
  check(VecScatterBegin(scatter_, local_, field, ADD_VALUES, SCATTER_REVERSE));
  check(VecScatterEnd(scatter_, local_, field, ADD_VALUES, SCATTER_REVERSE));
}

Structure::Structure(Mesh m, std::vector<BeamSection> s, MembraneStrain e)
    : mesh(std::move(m)), sections(std::move(s)), strain(e), exchange(mesh, dofs_per_node) {}

std::vector<int> Structure::cell_dofs(const Mesh::Cell& cell) const {
  std::vector<int> dofs;
  for (int node : cell.nodes)
    for (int d = 0; d < dofs_per_node; ++d) dofs.push_back(dofs_per_node * node + d);
  return dofs;
}

ElementMaps Structure::maps(const Mesh::Cell& cell) const {
  return planar_beam(mesh.positions[cell.nodes[0]].head<2>(), mesh.positions[cell.nodes[1]].head<2>(),
                     sections[cell.part], strain);
}

std::vector<body::MassPoint> Structure::line(const Mesh::Cell& cell) const {
  return planar_beam_line(mesh.positions[cell.nodes[0]].head<2>(), mesh.positions[cell.nodes[1]].head<2>());
}

petsc::VecHandle field(const Structure& structure) {
  petsc::VecHandle vector;
  const PetscInt owned = Structure::dofs_per_node * structure.mesh.owned_nodes;
  check(VecCreate(structure.mesh.comm, vector.out()));
  check(VecSetSizes(vector, owned, structure.dofs()));
  check(VecSetBlockSize(vector, Structure::dofs_per_node));
  check(VecSetType(vector, VECSTANDARD));
  check(VecSet(vector, 0));
  return vector;
}

namespace {

/// The pattern of node couplings, counted by PETSc's preallocator.
petsc::MatHandle empty_matrix(const Structure& structure) {
  const PetscInt owned = Structure::dofs_per_node * structure.mesh.owned_nodes, n = structure.dofs();
  petsc::MatHandle matrices[2];
  const MatType types[2] = {MATPREALLOCATOR, MATSBAIJ};
  for (int i = 0; i < 2; ++i) {
    check(MatCreate(structure.mesh.comm, matrices[i].out()));
    check(MatSetSizes(matrices[i], owned, owned, n, n));
    check(MatSetBlockSize(matrices[i], Structure::dofs_per_node));
    check(MatSetType(matrices[i], types[i]));
  }
  check(MatSetUp(matrices[0]));
  const std::vector<double> zeros(36, 0.0);
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const PetscInt nodes[2] = {structure.mesh.global_node(cell.nodes[0]), structure.mesh.global_node(cell.nodes[1])};
    check(MatSetValuesBlocked(matrices[0], 2, nodes, 2, nodes, zeros.data(), ADD_VALUES));
  }
  check(MatAssemblyBegin(matrices[0], MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrices[0], MAT_FINAL_ASSEMBLY));
  check(MatPreallocatorPreallocate(matrices[0], PETSC_FALSE, matrices[1]));
  check(MatSetOption(matrices[1], MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE));
  check(MatSetOption(matrices[1], MAT_SYMMETRIC, PETSC_TRUE));
  check(MatSetOption(matrices[1], MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return std::move(matrices[1]);
}

bool held(const Conditions& conditions, PetscInt dof) {
  return std::binary_search(conditions.begin(), conditions.end(), dof);
}

}  // namespace

petsc::MatHandle assemble(const Structure& structure, const Conditions& conditions, double diagonal,
                          const std::function<Eigen::MatrixXd(const ElementMaps&)>& matrix) {
  petsc::MatHandle A = empty_matrix(structure);
  double largest = 0;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    Eigen::MatrixXd Ae = matrix(structure.maps(cell));
    largest = std::max(largest, Ae.diagonal().cwiseAbs().maxCoeff());
    const std::vector<int> dofs = structure.cell_dofs(cell);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (held(conditions, structure.global_dof(dofs[i]))) Ae.row(i).setZero(), Ae.col(i).setZero();
    const PetscInt nodes[2] = {structure.mesh.global_node(cell.nodes[0]), structure.mesh.global_node(cell.nodes[1])};
    check(MatSetValuesBlocked(A, 2, nodes, 2, nodes, Ae.data(), ADD_VALUES));  // symmetric: row or column major
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(A, &first, &end));
  for (PetscInt dof : conditions)
    if (dof >= first && dof < end) check(MatSetValue(A, dof, dof, diagonal * largest, ADD_VALUES));
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

petsc::MatHandle stiffness(const Structure& structure, const Conditions& conditions) {
  petsc::MatHandle K = assemble(structure, conditions, 1, [](const ElementMaps& maps) { return maps.stiffness(); });
  check(MatSetOption(K, MAT_SPD, PETSC_TRUE));
  return K;
}

petsc::MatHandle mass(const Structure& structure, const Conditions& conditions) {
  return assemble(structure, conditions, 0, [](const ElementMaps& maps) { return maps.mass_matrix(); });
}

petsc::VecHandle stiffness_derivative(const Structure& structure, Vec phi_i, Vec phi_j) {
  const Eigen::VectorXd a = structure.exchange.gather(phi_i), b = structure.exchange.gather(phi_j);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(a.size());
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    const std::vector<int> dofs = structure.cell_dofs(cell);
    sum(dofs) += stiffness_derivative(structure.maps(cell), a(dofs), b(dofs));
  }
  petsc::VecHandle f = field(structure);
  structure.exchange.add(sum, f);
  return f;
}

std::vector<petsc::VecHandle> rigid_motions(const Structure& structure) {
  std::vector<petsc::VecHandle> motions;
  for (int motion = 0; motion < 3; ++motion) {
    motions.push_back(field(structure));
    double* values = nullptr;
    check(VecGetArrayWrite(motions.back(), &values));
    for (PetscInt node = 0; node < structure.mesh.owned_nodes; ++node) {
      const Eigen::Vector3d& x = structure.mesh.positions[node];
      const double turn[3] = {-x.y(), x.x(), 1};
      for (int d = 0; d < 3; ++d) values[3 * node + d] = motion == 2 ? turn[d] : (d == motion ? 1 : 0);
    }
    check(VecRestoreArrayWrite(motions.back(), &values));
  }
  return motions;
}

void hold(Vec field, const Conditions& conditions) {
  PetscInt first = 0, end = 0;
  check(VecGetOwnershipRange(field, &first, &end));
  double* values = nullptr;
  check(VecGetArray(field, &values));
  for (PetscInt dof : conditions)
    if (dof >= first && dof < end) values[dof - first] = 0;
  check(VecRestoreArray(field, &values));
}

}  // namespace floe::fem
