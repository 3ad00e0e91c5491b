#pragma once
#include <functional>
#include <vector>

#include "floe/fem/mesh.h"
#include "floe/fem/planar_beam.h"

namespace floe::fem {

/// Moves values between a distributed field (a few dofs a node) and this rank's local copy with foreign nodes.
class Exchange {
 public:
  Exchange() = default;
  Exchange(const Mesh& mesh, int dofs_per_node);
  /// Collective.
  Eigen::VectorXd gather(Vec field) const;
  /// field += local contributions of all ranks. Collective.
  void add(const Eigen::VectorXd& local, Vec field) const;

 private:
  petsc::ScatterHandle scatter_;
  petsc::VecHandle local_;
};

/// A body's finite elements: assembles and never solves. n = 3 x nodes dofs (u, v, rotation), numbered by node.
struct Structure {
  Mesh mesh;
  std::vector<BeamSection> sections;  ///< of each part
  MembraneStrain strain = MembraneStrain::averaged;
  Exchange exchange;
  static constexpr int dofs_per_node = 3;

  Structure(Mesh mesh, std::vector<BeamSection> sections, MembraneStrain strain);
  PetscInt dofs() const { return dofs_per_node * mesh.node_count; }
  /// Local dof numbers of a cell.
  std::vector<int> cell_dofs(const Mesh::Cell& cell) const;
  PetscInt global_dof(int local) const {
    return dofs_per_node * mesh.global_node(local / dofs_per_node) + local % dofs_per_node;
  }
  ElementMaps maps(const Mesh::Cell& cell) const;
  /// Samples of the cell with unit density per length.
  std::vector<body::MassPoint> line(const Mesh::Cell& cell) const;
};

/// Global dofs held at zero, ascending, the same on all ranks.
using Conditions = std::vector<PetscInt>;

/// A zero field on the structure's dofs. Collective.
petsc::VecHandle field(const Structure& structure);

/// Sum over cells of a matrix each, MATSBAIJ (blocks of a node). Rows and columns of `conditions` are empty but for
/// `diagonal` times the largest diagonal entry. Collective.
petsc::MatHandle assemble(const Structure& structure, const Conditions& conditions, double diagonal,
                          const std::function<Eigen::MatrixXd(const ElementMaps&)>& matrix);

/// K under conditions: K_b + sum w L'DL, with the conditions' diagonal positive. Collective.
petsc::MatHandle stiffness(const Structure& structure, const Conditions& conditions);
/// M under conditions; their diagonal is zero. Collective.
petsc::MatHandle mass(const Structure& structure, const Conditions& conditions);

/// f = (dK/deta_j) phi_i, exact, element by element; symmetric in i and j. Collective.
petsc::VecHandle stiffness_derivative(const Structure& structure, Vec phi_i, Vec phi_j);

/// The three rigid motions of the plane, linearised: (1, 0, 0), (0, 1, 0), (-y, x, 1) at each node. Collective.
std::vector<petsc::VecHandle> rigid_motions(const Structure& structure);

/// Sets the entries of `conditions` to zero. Collective.
void hold(Vec field, const Conditions& conditions);

}  // namespace floe::fem
