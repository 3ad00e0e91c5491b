#include <fmt/format.h>

#include <algorithm>

#include "floe/assembly/reduce_bodies.h"
#include "floe/output/claim.h"
#include "floe/output/shape_file.h"
#include "floe/petsc/values.h"
#include "floe/plan/mesh_copy.h"

namespace floe::assembly {
namespace {

std::string label_of(const reduction::ColumnOrigin& origin) {
  if (origin.kind != reduction::ColumnOrigin::Kind::mode) return origin.label;
  return fmt::format("{} ({:.4g} Hz)", origin.label, origin.omega / (2 * M_PI));
}

/// Displacement and rotation vector of a node from its dofs.
Eigen::Matrix<double, 6, 1> motion(const double* dofs, int dimension, const Eigen::Matrix3d& axes) {
  Eigen::Matrix<double, 6, 1> all = Eigen::Matrix<double, 6, 1>::Zero();
  if (dimension == 3)
    all = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(dofs);
  else
    all << dofs[0], dofs[1], 0, 0, 0, dofs[2];
  all << axes * all.head<3>().eval(), axes * all.tail<3>().eval();
  return all;
}

output::ShapeGrid grid_of(const PlannedBody& body, const BodyFields& fields) {
  output::ShapeGrid grid;
  grid.name = body.spec.name;
  grid.nodes = body.structure.mesh.node_count;
  for (const reduction::ColumnOrigin& origin : fields.origins) grid.fields.push_back(label_of(origin));
  grid.shapes = mesh_copy(body);
  grid.cells = static_cast<std::int64_t>(grid.shapes.cells.size());
  MPI_Allreduce(MPI_IN_PLACE, &grid.cells, 1, MPI_INT64_T, MPI_SUM, body.structure.mesh.comm);
  grid.shapes.dofs_per_node = 6;
  const Eigen::Isometry3d frame = frame_in_mesh(body);
  for (Eigen::Vector3d& x : grid.shapes.positions) x = frame * x;
  grid.shapes.column = [&fields, &structure = body.structure, axes = frame.linear().eval()](int j,
                                                                                            std::span<double> values) {
    petsc::Values own(fields.columns[j]);
    for (std::size_t node = 0; 6 * node < values.size(); ++node) {
      const Eigen::VectorXd dofs = fem::nodal_motion(structure, own.begin(), static_cast<int>(node));
      const auto moved = motion(dofs.data(), structure.dimension(), axes);
      std::copy(moved.begin(), moved.end(), values.begin() + static_cast<std::ptrdiff_t>(6 * node));
    }
  };
  return grid;
}

}  // namespace

std::vector<BodyReport> write_modes(const Scene& whole, MPI_Comm comm, const std::filesystem::path& path,
                                    bool overwrite) {
  const output::Claim claim = output::claim_file(comm, path);
  output::check_shapes_path(comm, path, overwrite);
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  std::vector<BodyFields> fields(plan.bodies.size());
  std::vector<BodyReport> reports;
  std::vector<output::ShapeGrid> grids;
  for (std::size_t b = 0; b < fields.size(); ++b) {
    const PlannedBody& body = plan.bodies[b];
    if (body.spec.rigid) continue;
    if (body.spec.reduced) {
      reports.push_back(from_file(body, Formulation::vm_md).report);
      continue;
    }
    fields[b] = fields_of_body(plan, static_cast<int>(b));
    fields[b].report.name = body.spec.name;
    fields[b].report.notices = body.notices;
    reports.push_back(fields[b].report);
    grids.push_back(grid_of(body, fields[b]));
  }
  if (grids.empty())
    throw InputError(
        fmt::format("{}: no body is flexible and has a mesh; expected one whose shapes can be written", scene.file));
  output::write_shapes(comm, path, grids);
  return reports;
}

}  // namespace floe::assembly
