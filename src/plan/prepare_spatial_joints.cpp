#include "floe/plan/prepare_spatial_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "floe/error.h"
#include "floe/fem/constrained_frame.h"
#include "floe/math/rotation.h"
#include "floe/plan/ground_axes.h"
#include "floe/plan/hold_by_joint.h"
#include "floe/plan/spatial_start.h"
#include "floe/scene/joint_events.h"
#include "rims.h"

namespace floe::plan {

bool clamps(const Joint& joint) {
  return joint.kind == Joint::Kind::fixed || joint.kind == Joint::Kind::driven ||
         joint.kind == Joint::Kind::driven_slide;
}

double extent_of_mesh(const fem::Mesh& mesh) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const Eigen::Vector3d& x : mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return (high - low).norm();
}

namespace {

/// The axis that the joint rotates about or slides along, in world axes at the start. @throws InputError  a hinge
/// without.
Eigen::Vector3d axis_of(const Plan& plan, const Joint& joint, const std::array<Anchor, 2>& places) {
  using Kind = Joint::Kind;
  if (joint.axis_given) return Eigen::Vector3d(joint.axis[0], joint.axis[1], joint.axis[2]).normalized();
  if (joint.kind != Kind::revolute && joint.kind != Kind::driven) return Eigen::Vector3d::UnitZ();
  for (const Anchor& place : places) {
    if (place.body < 0 || place.map) continue;
    const PlannedBody& body = plan.bodies[place.body];
    if (const auto line = line_of(body.structure.mesh, place)) return body.attitude * *line;
  }
  throw InputError(joint.where.text() +
                   ".axis: is missing, and the joint's places are not straight edges, which would define it; expected "
                   "three numbers [x, y, z]");
}

Eigen::Matrix3d joint_axes(const Plan& plan, const Joint& joint, const std::array<Anchor, 2>& places) {
  if (joint.kind == Joint::Kind::bushing || joint.kind == Joint::Kind::support) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d W;
  W.col(2) = axis_of(plan, joint, places);
  if (joint.kind == Joint::Kind::universal) {
    const Eigen::Vector3d second(joint.second_axis[0], joint.second_axis[1], joint.second_axis[2]);
    if (std::abs(second.normalized().dot(W.col(2))) > 1e-9)
      throw InputError(joint.where.text() +
                       ".second_axis: is not normal to axis; expected two axes that cross at 90 deg");
    W.col(0) = second.normalized();
  } else {
    W.col(0) = W.col(2).unitOrthogonal();
  }
  W.col(1) = W.col(2).cross(W.col(0));
  return W;
}

/// The joint's axis in those of the frame. An edge's own line, where they are one but for rounded numbers or a
/// deformation at the start.
Eigen::Vector3d axis_within(const Eigen::Matrix3d& W, const PlannedBody& body,
                            const std::optional<Eigen::Vector3d>& line) {
  const Point& r = body.spec.initial.rotation;
  const Eigen::Matrix3d undeformed = math::rotation({r[0], r[1], r[2]}) * body.axes;
  for (const Eigen::Matrix3d& frame : {body.attitude, undeformed})
    if (line && line->cross(frame.transpose() * W.col(2)).norm() < 1e-6) return *line;
  return body.attitude.transpose() * W.col(2);
}

/// At a node that follows another one but for rotations of its own: the dof of either that is the component.
/// @param along  axis of the frame. @throws InputError  no single dof is
void hold_apart(const Joint& joint, const Anchor& place, int component, Eigen::Index along,
                fem::Conditions& constrained) {
  const AveragingWeight& followed = place.averaging_weights.front();
  fem::Conditions dofs;
  if (component < 3 && followed.lead.isZero(0)) dofs.push_back(6 * followed.node + static_cast<PetscInt>(along));
  for (const AveragingWeight& weight : place.averaging_weights)
    for (int d = 0; component >= 3 && d < 3; ++d)
      if (std::abs(weight.rotation(along, d)) > 1e-12) dofs.push_back(6 * weight.node + 3 + d);
  if (dofs.size() != 1)
    throw InputError(joint.where.text() + ".hold: its node follows another one but for rotations of its own, by a " +
                     (component < 3 ? "link at an arm; expected rotations only, or a node without such a link"
                                    : "link whose axis is oblique to those of the mesh; expected displacements only, "
                                      "or a node without such a link"));
  constrained.push_back(dofs.front());
}

/// Of a support: each node by itself. @throws InputError  nodes that follow others; a frame oblique to the mesh
void hold_components(const Joint& joint, const PlannedBody& body, const Anchor& place, fem::Conditions& constrained) {
  if (body.spec.rigid)
    throw InputError(fmt::format("{}: body {} is rigid; expected a flexible body, or another type of joint",
                                 joint.where.text(), body.spec.name));
  const bool apart = place.rotates_apart();
  for (const AveragingWeight& weight : place.averaging_weights)
    if (!apart && (std::count(place.nodes.begin(), place.nodes.end(), weight.node) == 0 ||
                   place.averaging_weights.size() < place.nodes.size()))
      throw InputError(joint.where.text() +
                       ": its place has nodes of a rigid region or line hinge of a link or another joint; expected a "
                       "place without them");
  for (int component = 0; component < 6; ++component) {
    if (!joint.hold[component]) continue;
    Eigen::Index along = 0;
    if (body.axes.row(component % 3).cwiseAbs().maxCoeff(&along) < 1 - 1e-12)
      throw InputError(
          fmt::format("{}: the floating frame of body {} is oblique to the axes of its mesh; expected no "
                      "key frame, or a mesh along its own axes",
                      joint.where.text(), body.spec.name));
    if (apart) {
      hold_apart(joint, place, component, along, constrained);
      continue;
    }
    for (const PetscInt node : place.nodes)
      constrained.push_back(6 * node + 3 * (component / 3) + static_cast<PetscInt>(along));
  }
}

/// Dofs that a joint to the ground holds at its nodes, in frame axes, and whether they are all that it does. A clamp
/// holds all dofs of all nodes, a hinge that is no hinge line (edges: mean) the displacements of its edge's nodes; at
/// one node, and at the independent node of a hinge line, what lies along the axes of the frame. Collective.
bool hold_by_joint(const Joint& joint, const Eigen::Matrix3d& W, const PlannedBody& body, const Anchor& place,
                   fem::Conditions& constrained) {
  using Kind = Joint::Kind;
  const bool pinned = place.line && (joint.kind == Kind::revolute || joint.kind == Kind::cylindrical);
  const auto hold = [&](std::initializer_list<int> dofs) {
    for (const AveragingWeight& weight : place.averaging_weights)
      for (int dof : dofs)
        if (!pinned || weight.node == place.node) constrained.push_back(6 * weight.node + dof);
  };
  if (joint.kind == Kind::support) return hold_components(joint, body, place, constrained), true;
  if (place.rotates_apart()) return false;
  if (clamps(joint)) return hold({0, 1, 2, 3, 4, 5}), true;
  if (joint.kind == Kind::spring || joint.kind == Kind::bushing || joint.kind == Kind::distance) return false;
  const auto line = line_of(body.structure.mesh, place);
  const Eigen::Vector3d axis = axis_within(W, body, line);
  const Eigen::Matrix3d& arm = place.averaging_weights.front().arm;
  const auto follows = [&](const AveragingWeight& weight) {  // the arms of an edge's own nodes are those of its mean
    return place.nodes.size() == 1 ? !weight.arm.isZero(0)
                                   : std::count(place.nodes.begin(), place.nodes.end(), weight.node) == 0;
  };
  const bool carried = pinned
                           ? (arm * axis).norm() > 1e-9 * extent_of_mesh(body.structure.mesh)
                           : place.line || place.averaging_weights.size() < place.nodes.size() ||
                                 std::any_of(place.averaging_weights.begin(), place.averaging_weights.end(), follows);
  if (place.nodes.size() > 1 && !pinned) {
    if (joint.kind != Kind::revolute || !line || line->cross(axis).norm() > 1e-9 || place.averaging_weights.size() == 1)
      return false;
    if (carried)
      throw InputError(joint.where.text() +
                       ": its edge has nodes of a rigid region or line hinge of a link or another joint; expected "
                       "places without a node in common, or edges: mean at the other joint");
    return hold({0, 1, 2}), true;
  }
  if (carried) return false;
  if (joint.kind == Kind::spherical || joint.kind == Kind::universal)
    return hold({0, 1, 2}), joint.kind == Kind::spherical;
  Eigen::Index along = 0;
  const bool aligned = axis.cwiseAbs().maxCoeff(&along) > 1 - 1e-12;
  const int z = static_cast<int>(along), x = (z + 1) % 3, y = (z + 2) % 3;
  if (joint.kind == Kind::revolute) {
    hold({0, 1, 2});
    if (aligned) hold({3 + x, 3 + y});
    return aligned;
  }
  if (!aligned) return false;
  if (joint.kind == Kind::planar)
    hold({z, 3 + x, 3 + y});
  else
    hold({x, y, 3 + x, 3 + y});
  if (joint.kind == Kind::prismatic) hold({3 + z});
  return true;
}

/// Rims of the bodies that the ground fixes: of each joint the node that leads its rim; -1: none. Collective.
std::vector<PetscInt> ground_rims(const Plan& plan) {
  std::vector<PetscInt> independent_nodes(plan.scene.joints.size(), -1);
  for (const PlannedBody& body : plan.bodies) {
    if (body.spec.rigid || body.spec.reduced) continue;
    for (const auto& [independent_node, rim] :
         fixed_rims(plan.scene, body.spec, body.structure, body.places, {body.origin, body.axes}))
      for (int joint : rim.joints)
        if (rim.holder == "ground") independent_nodes[joint] = independent_node;
  }
  return independent_nodes;
}

}  // namespace

void prepare_joints(Plan& plan, const std::function<Anchor(const Place&)>& place) {
  const std::vector<PetscInt> rims = ground_rims(plan);
  for (const Joint& joint : plan.scene.joints) {
    const PetscInt rim = rims[plan.joints.size()];
    plan.joints.push_back({place(joint.first), place(joint.second)});
    plan.joint_axes.push_back(joint_axes(plan, joint, plan.joints.back()));
    plan.joint_constrained.push_back(0);
    const Anchor* constrained = constrained_place(plan, plan.joints.size() - 1);
    if (!constrained || constrained->map || constrained->body < 0) continue;
    const Anchor& at = *constrained;
    PlannedBody& body = plan.bodies[at.body];
    const std::size_t before = body.constrained.size();
    if (rim >= 0) {
      for (int dof = 0; dof < 6; ++dof) body.constrained.push_back(6 * rim + dof);
      plan.joint_constrained.back() = 1;
    } else {
      plan.joint_constrained.back() = hold_by_joint(joint, plan.joint_axes.back(), body, at, body.constrained);
    }
    const bool holds = joint.kind != Joint::Kind::spring && joint.kind != Joint::Kind::bushing;
    if (at.line && holds && !plan.joint_constrained.back() && (joint.first.ground() || joint.second.ground()))
      body.notices.push_back(
          fmt::format("joint {}: its edge is oblique to the other joints of body {}, whose modes are computed with the "
                      "position of the edge fixed but its direction free; attachment modes at the joint (attachment: "
                      "joints) compensate for this",
                      joint.name, body.spec.name));
    const bool here =
        body.frame.kind == fem::ReferenceFrame::Kind::clamped && at.moved_by(body.frame.conditions.front() / 6);
    if ((clamps(joint) || rim >= 0) && here && !is_unlocked(plan.scene, joint.name))
      body.clamp.insert(body.clamp.end(), body.constrained.begin() + static_cast<long>(before), body.constrained.end());
  }
}

namespace {

/// Diagonal of the box about nodes. Collective.
double spread_of(const fem::Mesh& mesh, const std::vector<PetscInt>& nodes) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (PetscInt node : nodes)
    if (const PetscInt local = node - mesh.first_node; local >= 0 && local < mesh.owned_nodes)
      low = low.cwiseMin(mesh.positions[local]), high = high.cwiseMax(mesh.positions[local]);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return nodes.empty() ? 0 : (high - low).norm();
}

}  // namespace

void fix_frames(Plan& plan) {
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    PlannedBody& body = plan.bodies[b];
    if (body.spec.rigid || body.spec.reduced || body.spec.frame.given || body.parent >= 0 ||
        body.frame.kind != fem::ReferenceFrame::Kind::mean_axis)
      continue;
    fem::Conditions firm = body.constrained;
    std::sort(firm.begin(), firm.end());
    std::vector<PetscInt> nodes;
    bool by_nodes = false, moved = false;
    for (std::size_t j = 0; j < plan.joints.size(); ++j) {
      const Joint& joint = plan.scene.joints[j];
      const Anchor* place = constrained_place(plan, j);
      if (!place || place->body != static_cast<int>(b)) continue;
      moved = moved || clamps(joint) || is_switched(plan.scene, joint.name);
      if (!plan.joint_constrained[j]) {
        const auto here = [&](PetscInt dof) { return place->moved_by(dof / 6); };
        firm.erase(std::remove_if(firm.begin(), firm.end(), here), firm.end());
        continue;
      }
      by_nodes =
          by_nodes || joint.kind == Joint::Kind::support || (!place->line && place->averaging_weights.size() > 1);
      nodes.insert(nodes.end(), place->nodes.begin(), place->nodes.end());
    }
    if (moved || !(by_nodes || spread_of(body.structure.mesh, nodes) > 0.5 * fem::extent(body.structure))) continue;
    if (!fem::determine_rigid_motions(body.structure, firm)) continue;
    body.frame = fem::constrained_frame(body.structure, firm);
    start_spatial_body(body);
  }
}

bool hold_spatial_place_by_joint(const Plan& plan, std::size_t joint, const Anchor& place,
                                 fem::Conditions& constrained) {
  try {
    return hold_by_joint(plan.scene.joints[joint], plan.joint_axes[joint], plan.bodies[place.body], place, constrained);
  } catch (const InputError&) {  // a hinge that dofs cannot hold
    return false;
  }
}

}  // namespace floe::plan
