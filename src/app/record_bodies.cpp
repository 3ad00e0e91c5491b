#include "record_bodies.h"

#include <petscsys.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "floe/math/rotation.h"
#include "floe/petsc/values.h"
#include "floe/plan/body_mesh.h"

namespace floe::app {
namespace {

using petsc::check;

/// Column of motion/U of a local unknown; -1: there is none.
double column_of(const assembly::Model& model, int local) {
  return local < 0 ? -1 : static_cast<double>(model.system->coordinates().global()[local]);
}

/// Origin, then axes: the rows of [R'; A'].
void write_frame(output::ResultFile& file, const std::string& group, const assembly::BodyReport& body) {
  Eigen::Matrix<double, 4, 3, Eigen::RowMajor> rows;
  rows << body.place.transpose(), body.axes.transpose();
  file.write_array(group + "/frame_at_start", {4, 3}, {rows.data(), 12},
                   {"m, then 1", "of the floating frame in the world: its origin; its axes, a row each"});
}

void write_columns(output::ResultFile& file, const std::string& group, const assembly::Model& model,
                   const assembly::BodyReport& body) {
  const bool still = body.first_coordinate < 0 || (body.dimension == 3 && !body.attitude);
  const bool nodes = body.first_dof >= 0;  // full order
  const double where[2] = {still ? -1 : column_of(model, body.first_coordinate),
                           nodes || body.rigid ? -1 : column_of(model, body.first_elastic)};
  file.write_array(
      group + "/columns_of_motion", {2}, where,
      {"", body.dimension == 2
               ? "first columns of motion/U: of the frame (R_x, R_y, theta), of the reduced coordinates; -1: none"
               : "first columns of motion/U: of the frame (R; then three of its rotation in the step, see "
                 "motion/attitude), of the reduced coordinates; -1: fixed frame, none"});
}

/// Column j of a basis at this rank's nodes.
void copy_column(const assembly::BodyReport& body, const reduction::Basis& basis, int j, std::span<double> values) {
  Vec column = nullptr;
  check(BVGetColumn(basis.V, j, &column));
  {
    petsc::Values own(column);
    std::copy(own.begin(), own.begin() + values.size(), values.begin());
  }
  check(BVRestoreColumn(basis.V, j, &column));
  body.mesh->let_follow(values);
}

void write_mesh(output::ResultFile& file, const std::string& group, const assembly::BodyReport& body) {
  output::ReducedShapes shapes = body.mesh->shapes;
  shapes.column = [&](int j, std::span<double> values) { copy_column(body, *body.basis, j, values); };
  file.write_shapes(group + "/shapes", body.nodes, body.basis ? body.columns : 0, shapes,
                    {"",
                     "displacements, rotations at each node for a unit of each reduced coordinate, in the axes of "
                     "the floating frame"});
}

/// Of full order, the dofs of each node in the motion's states.
void write_nodes(output::ResultFile& file, const std::string& group, const assembly::Model& model,
                 const assembly::BodyReport& body) {
  const assembly::BodyMesh& mesh = *body.mesh;
  const bool in_world = model.formulation == scene::Formulation::cfr;
  std::vector<double> rows;
  for (std::size_t i = 0; i < mesh.shapes.nodes.size(); ++i) {
    const bool framed = in_world && mesh.rotates_apart(i);  // has a frame of its own
    const int dof = body.first_dof + mesh.shapes.dofs_per_node * static_cast<int>(framed ? i : mesh.mover(i));
    const Eigen::Vector3d arm = framed ? Eigen::Vector3d::Zero().eval() : mesh.arm(i);
    rows.insert(rows.end(), {column_of(model, dof), arm.x(), arm.y(), arm.z()});
  }
  file.write_of_nodes(
      group + "/nodes_of_motion", body.nodes, 4, mesh.shapes, rows,
      {"",
       (in_world && body.dimension == 3
            ? "first column of motion/U of the position and of the rotation vector from the undeformed body, in world "
              "axes"
            : std::string("first column of motion/U of the displacements and rotations, in ") +
                  (in_world ? "world axes" : "the axes of the floating frame")) +
           ", of which the node's displacement depends; offset of the node from the node that has them, not zero for a "
           "dependent node"});
}

/// Of full order, the rotations that nodes have of their own.
void write_spins(output::ResultFile& file, const std::string& group, const assembly::Model& model,
                 const assembly::BodyReport& body) {
  if (model.formulation == scene::Formulation::cfr) return;  // their dofs are those of frames of their own
  const assembly::BodyMesh& mesh = *body.mesh;
  const MPI_Comm comm = model.system->comm();
  std::vector<double> rows;
  for (const fem::Mesh::Spin& spin : mesh.spins) {
    if (spin.node >= static_cast<int>(mesh.shapes.nodes.size())) continue;
    const Eigen::Matrix3d own = spin.own();
    for (int i = 0; i < 3; ++i)
      if (!own.col(i).isZero(0))
        rows.insert(rows.end(),
                    {static_cast<double>(mesh.shapes.nodes[static_cast<std::size_t>(spin.node)]),
                     column_of(model, body.first_dof + 6 * spin.node + 3 + i), own(0, i), own(1, i), own(2, i)});
  }
  std::int64_t mine = std::ssize(rows) / 5, all = mine, first = 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT64_T, MPI_SUM, comm);
  MPI_Exscan(&mine, &first, 1, MPI_INT64_T, MPI_SUM, comm);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (all == 0) return;
  file.write_distributed_rows(group + "/spins_of_motion", all, 5, rank == 0 ? 0 : first, rows,
                              {"", "node; column of motion/U of a rotation of its own; axis"});
}

/// Whether local unknown x is a rotation of one of the body's own nodes.
bool rotates_node(const assembly::BodyReport& body, int x) {
  const int at = x - body.first_dof;
  return body.dimension == 3 && body.first_dof >= 0 && at >= 0 && at < 6 * static_cast<int>(body.positions.size() / 3);
}

}  // namespace

petsc::VecHandle shown_state(const assembly::Model& model, Vec U) {
  if (model.formulation != scene::Formulation::cfr || !model.system->has_attitudes()) return {};
  petsc::VecHandle shown;
  Eigen::VectorXd q;
  model.system->gather(U, q);
  check(VecDuplicate(U, shown.out()));
  check(VecCopy(U, shown));
  petsc::Values values(shown);
  for (const auto& [x, attitude] : model.system->attitudes())
    for (const assembly::BodyReport& body : model.bodies) {
      if (!rotates_node(body, x)) continue;
      const Eigen::Matrix3d rotation = attitude->axes(q.segment<3>(x)) * body.axes.transpose();
      const Eigen::Vector3d vector = math::rotation_vector(Eigen::Quaterniond(rotation).normalized());
      for (int i = 0; i < 3; ++i) values[model.system->coordinates().global()[x + i]] = vector[i];
    }
  return shown;
}

namespace {

/// For pictures: motion/joints, JSON with name, kind and both ends of each joint: body (its number in the summary, from
/// 0; -1: ground; -2: ground where the other place is at the start) and place.
void write_joints(output::ResultFile& file, const assembly::Model& model) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const assembly::JointPlaces& joint : model.joint_places) {
    nlohmann::ordered_json ends;
    for (const auto& end : joint.ends) {
      const bool known = end.x.allFinite();
      const Eigen::Vector3d x = known ? end.x : Eigen::Vector3d::Zero();
      ends.push_back({{"body", known ? end.body : -2}, {"x", {x[0], x[1], x[2]}}});
    }
    all.push_back({{"name", joint.name}, {"kind", joint.kind}, {"ends", ends}});
  }
  if (!all.empty()) file.write_text("motion/joints", all.dump());
}

}  // namespace

void write_bodies(output::ResultFile& file, const assembly::Model& model) {
  const double dimension[1] = {model.bodies.empty() ? 0. : model.bodies.front().dimension};
  file.write_array("motion/dimension", {}, dimension, {"", "2: in the plane, 3: in space"});
  write_joints(file, model);
  for (const assembly::BodyReport& body : model.bodies) {
    const std::string group = "bodies/" + body.name;
    write_frame(file, group, body);
    write_columns(file, group, model, body);
    if (!body.file.empty()) file.write_text(group + "/reduced_file", body.file);
    if (body.shapes_in_file) file.write_link(group + "/shapes", body.file, "/shapes");
    if (!body.mesh) continue;
    write_mesh(file, group, body);
    if (body.first_dof < 0) continue;
    write_nodes(file, group, model, body);
    write_spins(file, group, model, body);
  }
}

void write_deviation(output::ResultFile& file, const assembly::Model& model, const assess::Estimate& estimate) {
  if (estimate.deviations.empty() || estimate.bases.size() != model.bodies.size()) return;
  const auto rows = static_cast<std::int64_t>(estimate.deviations.size());
  const auto width = static_cast<std::int64_t>(estimate.deviations.front().size());
  std::vector<double> all;
  for (const Eigen::VectorXd& d : estimate.deviations) all.insert(all.end(), d.data(), d.data() + d.size());
  file.write_array("estimate/deviation", {rows, width}, all,
                   {"", "estimated error of the reduced coordinates, on the basis and estimate_basis, body by body"});
  if (const Eigen::VectorXd& d = estimate.deviation_at_start; d.size() > 0)
    file.write_array("estimate/deviation_at_start", {width}, {d.data(), static_cast<std::size_t>(d.size())},
                     {"", "the same at the start of the motion, where it is not zero"});
  std::int64_t first = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const assembly::BodyReport& body = model.bodies[b];
    const auto& basis = estimate.bases[b];
    const std::int64_t columns = basis ? basis->columns : body.columns;
    const double at[1] = {static_cast<double>(first)};
    first += columns;
    if (columns == 0) continue;
    const std::string group = "bodies/" + body.name;
    file.write_array(group + "/estimate_columns", {1}, at, {"", "first column of estimate/deviation"});
    if (!body.mesh || !body.basis || !basis || columns == body.columns) continue;
    output::ReducedShapes shapes = body.mesh->shapes;
    shapes.column = [&](int j, std::span<double> values) { copy_column(body, *basis, body.columns + j, values); };
    file.write_vectors(group + "/estimate_basis", body.nodes, columns - body.columns, shapes,
                       {"", "further vectors of the error estimate, as shapes/basis"});
  }
}

}  // namespace floe::app
