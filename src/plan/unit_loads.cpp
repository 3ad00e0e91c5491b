#include "unit_loads.h"

#include "floe/petsc/values.h"

namespace floe::plan {
namespace {

const char* component_name(int dofs_per_node, PetscInt component, bool load) {
  static const char* loads[2][6] = {{"fx", "fy", "moment"}, {"fx", "fy", "fz", "mx", "my", "mz"}};
  static const char* motions[2][6] = {{"x", "y", "rotation"}, {"x", "y", "z", "rx", "ry", "rz"}};
  return (load ? loads : motions)[dofs_per_node == 6][component];
}

}  // namespace

reduction::Attachment unit_load(const PlannedBody& body, const Anchor& place, int component, const std::string& where) {
  const int n = body.structure.dofs_per_node;
  reduction::Attachment attachment{where + "." + component_name(n, component, true), fem::field(body.structure), {}};
  petsc::Values values(attachment.load);
  for (const AveragingWeight& weight : place.moved_by()) {
    const PetscInt dof = n * weight.node;
    if (dof < values.first || dof >= values.end) continue;
    if (n < 6 || component < 3) values[dof + component] = weight.share;
    if (n < 6) continue;
    for (int i = 0; component >= 3 && i < 3; ++i) values[dof + i] = weight.turn(component - 3, i);
    const Eigen::Vector3d moment = component < 3 ? weight.arm.row(component) : weight.rotation.row(component - 3);
    for (int i = 0; i < 3; ++i) values[dof + 3 + i] = moment[i];
  }
  return attachment;
}

reduction::Attachment unit_displacement(const PlannedBody& body, PetscInt dof, const std::string& where) {
  const int n = body.structure.dofs_per_node;
  reduction::Attachment attachment{where + "." + component_name(n, dof % n, false), {}, fem::field(body.structure)};
  petsc::Values values(attachment.moved);
  if (dof >= values.first && dof < values.end) values[dof] = 1;
  return attachment;
}

reduction::Attachment rigid_displacement(const PlannedBody& body, const Anchor& place, int component,
                                         const std::string& where) {
  const int n = body.structure.dofs_per_node, d = body.structure.dimension();
  reduction::Attachment attachment{where + "." + component_name(n, component, false), {}, fem::field(body.structure)};
  petsc::Values values(attachment.moved);
  for (const AveragingWeight& weight : place.moved_by()) {
    const PetscInt node = weight.node;
    if (n * node < values.first || n * node >= values.end) continue;
    if (const fem::Mesh::Spin* spin = fem::spin_of(
            body.structure.mesh, static_cast<int>(node - body.structure.mesh.first_node))) {  // its own rotations alone
      for (int i = 0; component >= d && i < 3; ++i) values[n * node + 3 + i] = spin->own()(component - 3, i);
      continue;
    }
    values[n * node + component] = 1;
    if (component < d) continue;
    const Eigen::Vector3d axis =
                              d == 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(Eigen::Vector3d::Unit(component - 3)),
                          arm = body.structure.mesh.positions[node - body.structure.mesh.first_node] - place.x;
    const Eigen::Vector3d u = axis.cross(arm);
    for (int i = 0; i < d; ++i) values[n * node + i] = u[i];
  }
  return attachment;
}

}  // namespace floe::plan
