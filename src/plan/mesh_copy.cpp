#include "floe/plan/mesh_copy.h"

#include <fmt/format.h>

namespace floe::plan {
namespace {

output::ReducedShapes::Kind vtk_kind(fem::CellKind kind) {
  using Kind = output::ReducedShapes::Kind;
  switch (kind) {
    case fem::CellKind::point:
      return Kind::vertex;
    case fem::CellKind::line:
      return Kind::line;
    case fem::CellKind::triangle:
      return Kind::triangle;
    default:
      return Kind::quadrilateral;
  }
}

}  // namespace

Eigen::Isometry3d frame_in_mesh(const PlannedBody& body) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  if (body.structure.dimension() == 3) {
    frame.linear() = body.axes, frame.translation() = body.origin;
  } else {
    frame.linear().topLeftCorner<2, 2>() = turn(body.frame_angle);
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
    output::ReducedShapes::Cell copy{vtk_kind(cell.kind), cell.part, {-1, -1, -1, -1}};
    for (std::size_t i = 0; i < cell.corners().size(); ++i) copy.nodes[i] = mesh.original_node(cell.corners()[i]);
    shapes.cells.push_back(copy);
  }
  shapes.parts = body.parts;
  if (shapes.parts.empty())
    for (std::size_t s = 0; s < body.structure.sections.size(); ++s)
      shapes.parts.push_back(fmt::format("part {}", s + 1));
  return shapes;
}

}  // namespace floe::plan
