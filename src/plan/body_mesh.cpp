#include "floe/plan/body_mesh.h"

#include <algorithm>

#include "floe/fem/transform.h"
#include "floe/plan/mesh_copy.h"

namespace floe::plan {

std::size_t BodyMesh::mover(std::size_t node) const {
  const auto found = std::lower_bound(dependent_nodes.begin(), dependent_nodes.end(), static_cast<int>(node),
                                      [](const fem::Mesh::DependentNode& f, int wanted) { return f.node < wanted; });
  const bool follows = found != dependent_nodes.end() && found->node == static_cast<int>(node);
  return follows ? static_cast<std::size_t>(found->independent_node) : node;
}

bool BodyMesh::rotates_apart(std::size_t node) const {
  return std::any_of(spins.begin(), spins.end(), [&](const auto& spin) { return spin.node == static_cast<int>(node); });
}

Eigen::Vector3d BodyMesh::arm(std::size_t node) const { return shapes.positions[node] - shapes.positions[mover(node)]; }

void BodyMesh::let_follow(std::span<double> values) const {
  const Eigen::Index n = shapes.dofs_per_node;
  const auto dofs = [&](int node) { return Eigen::Map<Eigen::VectorXd>(values.data() + n * node, n); };
  for (const fem::Mesh::DependentNode& f : dependent_nodes) {
    const Eigen::Vector3d from = arm(f.node);
    if (n == 3) {
      dofs(f.node) = fem::rigid_arm(Eigen::Vector2d(from.head<2>())) * dofs(f.independent_node);
    } else {
      const auto spin = std::find_if(spins.begin(), spins.end(), [&](const auto& s) { return s.node == f.node; });
      if (spin == spins.end()) {
        dofs(f.node) = fem::rigid_arm(from) * dofs(f.independent_node);
        continue;
      }
      const Eigen::Vector3d own = spin->own() * Eigen::Vector3d(dofs(f.node).tail<3>());
      dofs(f.node) = fem::spin_arm(from, spin->own()) * dofs(f.independent_node);
      dofs(f.node).tail<3>() += own;
    }
  }
}

std::shared_ptr<const BodyMesh> body_mesh(const PlannedBody& body) {
  if (body.spec.reduced) return nullptr;
  const fem::Mesh& mesh = body.structure.mesh;
  return std::make_shared<const BodyMesh>(BodyMesh{mesh_copy(body), mesh.dependent_nodes, mesh.spins});
}

}  // namespace floe::plan
