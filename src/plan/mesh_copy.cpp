#include "floe/plan/mesh_copy.h"

#include <fmt/format.h>

#include <array>
#include <numeric>

namespace floe::plan {

std::vector<std::vector<int>> pictured(fem::CellKind kind) {
  switch (kind) {
    case fem::CellKind::spring:
      return {};  // no piece of material
    case fem::CellKind::line3:
      return {{0, 2}, {2, 1}};
    case fem::CellKind::triangle6:
      return {{0, 3, 5}, {1, 4, 3}, {2, 5, 4}, {3, 4, 5}};
    case fem::CellKind::quadrilateral8:
      return {{0, 4, 7}, {1, 5, 4}, {2, 6, 5}, {3, 7, 6}, {4, 5, 6, 7}};
    default:
      std::vector<int> all(static_cast<std::size_t>(mesh::node_count(kind)));
      std::iota(all.begin(), all.end(), 0);
      return {all};
  }
}

namespace {

output::ReducedShapes::Kind vtk_kind(std::size_t nodes) {
  using Kind = output::ReducedShapes::Kind;
  constexpr std::array<Kind, 4> kinds{Kind::vertex, Kind::line, Kind::triangle, Kind::quadrilateral};
  return kinds[nodes - 1];
}

}  // namespace

Eigen::Isometry3d frame_in_mesh(const PlannedBody& body) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  if (body.structure.dimension() == 3) {
    frame.linear() = body.axes, frame.translation() = body.origin;
  } else {
    frame.linear().topLeftCorner<2, 2>() = rotation_matrix(body.frame_angle);
    frame.translation().head<2>() = body.frame_origin;
  }
  return frame;
}

output::ReducedShapes mesh_copy(const PlannedBody& body) {
  const fem::Mesh& mesh = body.structure.mesh;
  output::ReducedShapes shapes;
  shapes.dofs_per_node = body.structure.dofs_per_node;
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    shapes.nodes.push_back(mesh.original_node(static_cast<int>(i)));
    shapes.positions.push_back(mesh.positions[i]);
  }
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    for (const std::vector<int>& nodes : pictured(cell.kind)) {
      output::ReducedShapes::Cell copy{vtk_kind(nodes.size()), cell.part, {-1, -1, -1, -1}};
      for (std::size_t i = 0; i < nodes.size(); ++i) copy.nodes[i] = mesh.original_node(cell.place[nodes[i]]);
      shapes.cells.push_back(copy);
    }
  }
  shapes.parts = body.parts;
  if (shapes.parts.empty())
    for (std::size_t s = 0; s < body.structure.sections.size(); ++s)
      shapes.parts.push_back(fmt::format("part {}", s + 1));
  return shapes;
}

}  // namespace floe::plan
