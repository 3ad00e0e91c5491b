#include "drilling_notes.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "floe/fem/pressure.h"

namespace floe::plan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Of flat shells at a node that nothing else has, in the structure's axes. Collective.
std::optional<Vector3d> normal_at(const fem::Structure& structure, PetscInt node) {
  constexpr double flat = 0.98;  // of n n', by area
  const fem::Mesh& mesh = structure.mesh;
  Eigen::Matrix<double, 3, 4> sums = Eigen::Matrix<double, 3, 4>::Zero();  // of n n'; area, other elements and links
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    const auto places = cell.places();
    if (std::none_of(places.begin(), places.end(), [&](int one) { return mesh.global_node(one) == node; })) continue;
    if (!fem::is_shell(cell)) {
      sums(1, 3) += cell.corners().size() > 1 ? 1 : 0;  // masses do not resist
      continue;
    }
    const auto corners = cell.corners();
    const auto at = [&](std::size_t i) -> const Vector3d& { return mesh.positions[corners[i]]; };
    const Vector3d n = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(n.norm() > 0)) continue;
    sums.leftCols<3>() += n * n.transpose() / n.norm();
    sums(0, 3) += n.norm();
  }
  for (const auto& link : mesh.dependent_nodes)
    if (mesh.global_node(link.node) == node || mesh.global_node(link.independent_node) == node) sums(1, 3) += 1;
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (!(sums(0, 3) > 0) || sums(1, 3) > 0) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> normals(Matrix3d(sums.leftCols<3>() / sums(0, 3)));
  if (normals.eigenvalues()[2] < flat) return std::nullopt;
  return normals.eigenvectors().col(2);
}

/// Directions of the relative rotations that a joint holds or resists, world axes at the start.
Matrix3d resisted(const Joint& joint, const Matrix3d& axes, const Matrix3d& mesh_axes) {
  using Kind = Joint::Kind;
  const auto about = [](const Matrix3d& W, bool x, bool y, bool z) {
    return Matrix3d(W * Vector3d(x, y, z).asDiagonal() * W.transpose());
  };
  const bool about_axis = joint.rotation_limits || joint.rotation_friction ||
                          (joint.kind == Kind::revolute && (joint.limits || joint.friction));
  switch (joint.kind) {
    case Kind::fixed:
    case Kind::prismatic:
    case Kind::driven:
    case Kind::driven_slide:
      return Matrix3d::Identity();
    case Kind::revolute:
    case Kind::cylindrical:
    case Kind::planar:
      return about(axes, true, true, about_axis);
    case Kind::universal:
      return about(axes, false, true, false);
    case Kind::support:
      return about(mesh_axes, joint.hold[3], joint.hold[4], joint.hold[5]);
    case Kind::spring:
      return about(axes, false, false, joint.torsional_stiffness > 0);
    case Kind::bushing:
      return about(Matrix3d::Identity(), joint.rotation[0] > 0, joint.rotation[1] > 0, joint.rotation[2] > 0);
    case Kind::spherical:
    case Kind::distance:
      break;
  }
  return Matrix3d::Zero();
}

/// Whether a third joint resists rotations of the two bodies by forces.
bool alone(const Plan& plan, std::size_t j) {
  const auto pair = [&](std::size_t i) { return std::minmax({plan.joints[i][0].body, plan.joints[i][1].body}); };
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (i != j && pair(i) == pair(j)) return false;
  return true;
}

}  // namespace

void note_drilling(Plan& plan) {
  constexpr double small = 1e-3;
  const auto normal = [&](const Anchor& at) -> std::optional<Vector3d> {
    if (at.body < 0 || at.map || at.nodes.size() != 1) return std::nullopt;
    const PlannedBody& body = plan.bodies[at.body];
    if (body.spec.rigid || body.spec.reduced) return std::nullopt;
    const std::optional<Vector3d> found = normal_at(body.structure, at.nodes.front());
    return found ? std::optional<Vector3d>(body.attitude * *found) : std::nullopt;
  };
  const auto note = [&](const std::string& what, const Anchor& at) {
    PlannedBody& body = plan.bodies[at.body];
    const Vector3d x = body.origin + body.axes * at.x;
    body.notices.push_back(fmt::format(
        "{} about the normal of the shells at one node, ({:.6g}, {:.6g}, {:.6g}): this rotation of a node follows the "
        "shells by a small stiffness only, and the result depends on the mesh; expected an edge or an area as the "
        "place, or rigid links there",
        what, x.x(), x.y(), x.z()));
  };
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint& joint = plan.scene.joints[j];
    for (const Anchor& at : plan.joints[j]) {
      const std::optional<Vector3d> n = normal(at);
      if (!n || !alone(plan, j)) continue;
      const PlannedBody& body = plan.bodies[at.body];
      const Matrix3d held = resisted(joint, plan.joint_axes[j], body.attitude * body.axes.transpose());
      if ((held * *n).norm() > small) note(fmt::format("joint {}: holds or resists rotation", joint.name), at);
    }
  }
  for (std::size_t l = 0; l < plan.loads.size(); ++l) {
    const Load& load = plan.scene.loads[l];
    if (load.kind != Load::Kind::moment || !load.joint.empty()) continue;
    const std::optional<Vector3d> n = normal(plan.loads[l]);
    if (!n) continue;
    const PlannedBody& body = plan.bodies[plan.loads[l].body];
    const Vector3d in_axes = load.axes == Load::Axes::world ? *n : Vector3d(body.axes * body.attitude.transpose() * *n);
    for (int c = 0; c < 3; ++c)
      if (const math::Formula& m = load.moment[static_cast<std::size_t>(c)];
          std::abs(in_axes[c]) > small && !(m.constant() && m(0) == 0)) {
        note(fmt::format("load {}: acts", load.name), plan.loads[l]);
        break;
      }
  }
}

}  // namespace floe::plan
