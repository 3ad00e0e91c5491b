#include "floe/plan/attachments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"
#include "floe/plan/fixed_frames.h"
#include "floe/plan/hold_at_frame.h"
#include "floe/plan/interface.h"
#include "floe/scene/joint_events.h"
#include "floe/scene/sensors.h"
#include "unit_loads.h"

namespace floe::plan {

using petsc::check;

bool of_frame(const PlannedBody& body) { return body.spec.reduction.modes.of == ModesSpec::Of::frame; }

bool modes_satisfy_joints(const PlannedBody& body) {
  const fem::Conditions& conditions = body.frame.conditions;
  return !of_frame(body) ||
         std::includes(conditions.begin(), conditions.end(), body.constrained.begin(), body.constrained.end());
}

bool modes_satisfy_place(const PlannedBody& body, const Anchor& place) {
  const fem::Conditions& conditions = body.frame.conditions;
  const PetscInt n = body.structure.dofs_per_node;
  return !of_frame(body) || std::all_of(body.constrained.begin(), body.constrained.end(), [&](PetscInt dof) {
    return !place.moved_by(dof / n) || std::binary_search(conditions.begin(), conditions.end(), dof);
  });
}

bool balanced_by_joints(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  if (body.structure.dimension() == 2 && body.frame.kind != fem::ReferenceFrame::Kind::mean_axis) return false;
  if (of_frame(body) || constrained_by_modes(plan, index).empty()) return false;
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if ((plan.joints[j][0].body == index || plan.joints[j][1].body == index) &&
        is_unlocked(plan.scene, plan.scene.joints[j].name))
      return false;
  return true;
}

namespace {

using Attachments = std::vector<reduction::Attachment>;

/// Whether the scene rotates the body by a moment at a place that one of its joints has nodes of: a hinge that is
/// driven.
bool at_a_joint(const Plan& plan, const Anchor& load) {
  for (const auto& places : plan.joints)
    for (const Anchor& place : places)
      if (place.body == load.body && share_a_node(place, load)) return true;
  return false;
}

bool contains(const fem::Conditions& dofs, PetscInt dof) {
  return std::find(dofs.begin(), dofs.end(), dof) != dofs.end();
}

int rigid_motions_left(const PlannedBody& body, fem::Conditions constrained) {
  std::sort(constrained.begin(), constrained.end());
  return static_cast<int>(fem::holding(body.structure, body.frame, std::move(constrained)).left.cols());
}

/// Constrained displacements that the frame's own conditions and constrained rotations determine already, if the frame
/// rotates.
fem::Conditions repeated_displacements(const PlannedBody& body) {
  const fem::Conditions& constrained = body.constrained;
  const PetscInt a = body.frame_places[0].node, b = body.frame_places[1].node;
  if (body.spec.frame.kind != FrameSpec::Kind::pinned || constrained.size() < 3) return {};
  if (contains(constrained, 3 * a + 1) && contains(constrained, 3 * b + 1)) return {};
  fem::Conditions ordered = constrained;
  const auto rank = [&](PetscInt dof) { return contains(body.frame.conditions, dof) ? 0 : dof % 3 == 2 ? 1 : 2; };
  std::stable_sort(ordered.begin(), ordered.end(), [&](PetscInt i, PetscInt j) { return rank(i) < rank(j); });
  fem::Conditions kept, repeated;
  for (PetscInt dof : ordered) {
    fem::Conditions more = kept;
    more.push_back(dof);
    if (rigid_motions_left(body, more) < rigid_motions_left(body, kept))
      kept = std::move(more);
    else if (dof % 3 != 2)
      repeated.push_back(dof);
  }
  return repeated;
}

/// Whether the rest holds the body as well as all.
bool rest_holds(const PlannedBody& body, PetscInt dof) {
  fem::Conditions rest = body.constrained;
  rest.erase(std::remove(rest.begin(), rest.end(), dof), rest.end());
  return rigid_motions_left(body, rest) == rigid_motions_left(body, body.constrained);
}

void add_constraint_modes(const Plan& plan, int index, Attachments& all) {
  const PlannedBody& body = plan.bodies[index];
  const fem::Conditions repeated = repeated_displacements(body);
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    const Joint& joint = plan.scene.joints[j];
    if (first.ground() == second.ground() || std::max(first.body, second.body) != index) continue;
    if (joint.kind == Joint::Kind::spring) continue;
    const PetscInt dof = 3 * (first.ground() ? second : first).node;
    for (PetscInt c = 0; c < 2; ++c)
      if (contains(repeated, dof + c)) all.push_back(unit_displacement(body, dof + c, joint.name));
    if (joint.kind == Joint::Kind::driven && rest_holds(body, dof + 2))
      all.push_back(unit_displacement(body, dof + 2, joint.name));
  }
}

/// What a joint to the ground holds of a body in space, as one rigid piece.
struct Support {
  int joint;
  const Anchor* place;
  std::vector<int> components;  // of its nodes that are constrained
  bool at_frame;                // the frame is clamped there
};

std::vector<Support> supports_of(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  std::vector<Support> all;
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    const Joint::Kind kind = plan.scene.joints[j].kind;
    if (first.ground() == second.ground() || kind == Joint::Kind::spring || kind == Joint::Kind::bushing) continue;
    const Anchor& place = first.ground() ? second : first;
    if (place.body != index || place.nodes.empty()) continue;
    Support support{static_cast<int>(j), &place, {}, false};
    for (int c = 0; c < 6; ++c)
      if (std::binary_search(body.constrained.begin(), body.constrained.end(),
                             6 * (place.line ? place.node : place.nodes.front()) + c))
        support.components.push_back(c);
    // nodes whose displacements are constrained also hold the rotations of their piece: about a line all but one
    if (place.nodes.size() > 1 && !place.line && support.components == std::vector<int>{0, 1, 2})
      support.components = {0, 1, 2, 3, 4};
    support.at_frame = body.frame.kind == fem::ReferenceFrame::Kind::clamped &&
                       std::count(place.nodes.begin(), place.nodes.end(), body.frame.conditions.front() / 6) > 0;
    if (!support.components.empty()) all.push_back(std::move(support));
  }
  return all;
}

/// Without what is not constrained: constraint modes displace constrained dofs alone.
/// @param small  displacements of no more are none: a line's nodes, rotated about it
void keep_constrained(const PlannedBody& body, Vec moved, double small) {
  petsc::Values values(moved);
  for (PetscInt dof = values.first; dof < values.end; ++dof)
    if (!std::binary_search(body.constrained.begin(), body.constrained.end(), dof) ||
        (dof % 6 < 3 && std::abs(values[dof]) <= small))
      values[dof] = 0;
}

void add_spatial_constraint_modes(const Plan& plan, int index, Attachments& all) {
  const PlannedBody& body = plan.bodies[index];
  const bool still = has_fixed_frame(plan, index);
  const std::vector<Support> supports = supports_of(plan, index);
  fem::Conditions by_all = held_at_frame(plan, index);  // by modes of a frame that is clamped elsewhere, too
  std::size_t constrained = by_all.size();
  for (const Support& support : supports) constrained += support.components.size();
  by_all.insert(by_all.end(), body.constrained.begin(), body.constrained.end());
  const int holds = 6 - rigid_motions_left(body, by_all);
  for (const Support& support : supports) {
    const Joint& joint = plan.scene.joints[support.joint];
    const bool driven = joint.kind == Joint::Kind::driven || joint.kind == Joint::Kind::driven_slide;
    if (support.at_frame || (still ? !driven : static_cast<int>(constrained) <= holds)) continue;
    const bool rotations = support.place->nodes.size() > 1;
    for (int c = 0; c < 6; ++c) {
      const bool holds_it = std::count(support.components.begin(), support.components.end(), c) > 0;
      if (!holds_it && !(rotations && c >= 3)) continue;
      all.push_back(rigid_displacement(body, *support.place, c, joint.name));
      keep_constrained(body, all.back().moved, c < 3 ? 0 : 1e-12 * plan.extent);
    }
  }
}

/// What acts along the motions that a joint leaves free: end stops, friction, and what locks it.
struct AlongFreedom {
  bool force = false, moment = false;
};

AlongFreedom along_freedom(const Scene& scene, const Joint& joint) {
  using Kind = Joint::Kind;
  const bool first = joint.limits || joint.friction || is_switched(scene, joint.name),
             rotation = joint.rotation_limits || joint.rotation_friction || is_switched(scene, joint.name);
  switch (joint.kind) {
    case Kind::revolute:
      return {false, first || rotation};
    case Kind::prismatic:
      return {first, false};
    case Kind::cylindrical:
      return {first, rotation};
    default:
      return {};
  }
}

bool carries_moment(const Scene& scene, const Joint& joint) {
  using Kind = Joint::Kind;
  switch (joint.kind) {
    case Kind::spring:
      return joint.torsional_stiffness != 0 || joint.torsional_viscosity != 0;
    case Kind::bushing: {
      const auto acts = [](double value) { return value != 0; };
      return std::any_of(joint.rotation.begin(), joint.rotation.end(), acts) ||
             std::any_of(joint.rotation_viscosity.begin(), joint.rotation_viscosity.end(), acts);
    }
    case Kind::revolute:
      return scene.dimension == 3 || along_freedom(scene, joint).moment;
    case Kind::spherical:
    case Kind::distance:
      return false;
    default:
      return true;
  }
}

/// Forces and moments on a side of a cut that its interface vectors distribute, besides the first one.
/// @param across  the joint's x, world
void add_interface(const PlannedBody& body, const Interface& cut, const Eigen::Vector3d& across, int side,
                   const std::string& name, Attachments& all) {
  const Eigen::Vector3d normal = body.attitude.transpose() * cut.normal, along = body.attitude.transpose() * across;
  for (Eigen::Index vector = cut.whole(); vector < cut.factors.cols(); ++vector) {
    reduction::Attachment sum{fmt::format("{}/{}.across", name, vector + 1), fem::field(body.structure), {}, true};
    for (int c = 0; c < 3; ++c)
      check(VecAXPY(sum.load, along[c], unit_load(body, cut.sum(side, vector), c, name).load));
    all.push_back(std::move(sum));
  }
  for (Eigen::Index vector = 1; vector < cut.whole(); ++vector)
    for (int c = 0; c < 6; ++c) {
      if (c >= 3 && std::abs(normal[c - 3]) > 1 - 1e-9) continue;
      all.push_back(unit_load(body, cut.sum(side, vector), c, fmt::format("{}/{}", name, vector + 1)));
      all.back().of_higher_vector = true;
    }
}

void add_joints(const Plan& plan, int index, Attachments& all) {
  const PlannedBody& body = plan.bodies[index];
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const Joint& joint = plan.scene.joints[j];
    const Anchor* constrained_there = constrained_place(plan, j);
    const bool constrained =
        body.structure.dimension() == 2 ? joint.kind != Joint::Kind::spring : plan.joint_constrained[j] != 0;
    const int d = body.structure.dimension(), n = body.structure.dofs_per_node;
    if (constrained_there && constrained_there->body == index && constrained && !of_frame(body)) {
      const AlongFreedom along = along_freedom(plan.scene, joint);
      for (int c = along.force ? 0 : d; c < (along.moment ? n : d); ++c)
        all.push_back(unit_load(body, *constrained_there, c, joint.name));
      continue;
    }
    const bool moment = carries_moment(plan.scene, joint);
    for (const int side : {0, 1})
      if (!plan.interfaces.empty() && plan.joints[j][side].body == index)
        add_interface(body, plan.interfaces[j], plan.joint_axes[j].col(0), side, joint.name, all);
    for (const Anchor& place : plan.joints[j])
      for (int c = 0; place.body == index && c < (moment ? n : d); ++c)
        all.push_back(unit_load(body, place, c, joint.name));
  }
  if (body.structure.dimension() == 2)
    add_constraint_modes(plan, index, all);
  else if (!of_frame(body))
    add_spatial_constraint_modes(plan, index, all);
}

/// Where a load acts: its place, or both of its joint.
std::vector<Anchor> places_of_load(const Plan& plan, std::size_t l) {
  const std::string& joint = plan.scene.loads[l].joint;
  if (joint.empty()) {
    std::vector<Anchor> places;
    for (const LoadPart& part : parts_of_load(plan, l)) places.push_back(part.at);
    return places;
  }
  const auto& [first, second] = plan.joints[joint_index(plan.scene, joint)];
  return {first, second};
}

/// In which a load acts: its axes, and besides its own directions at five times of the motion, as an oblique body may
/// be soft along every axis and stiff between them.
std::vector<Eigen::Vector3d> directions(const std::array<math::Formula, 3>& values, double end) {
  std::vector<Eigen::Vector3d> all;
  for (int c = 0; c < 3; ++c)
    if (!values[c].constant() || values[c]() != 0) all.push_back(Eigen::Vector3d::Unit(c));
  if (std::any_of(values.begin(), values.end(), [](const math::Formula& value) { return value.has_sensors(); }))
    return all;
  for (int k = 0; k <= 4; ++k) {
    const double t = (end > 0 ? end : 1) * k / 4;
    const Eigen::Vector3d value(values[0](t), values[1](t), values[2](t));
    if (value.stableNorm() == 0) continue;
    const Eigen::Vector3d direction = value.stableNormalized();
    if (std::all_of(all.begin(), all.end(),
                    [&](const Eigen::Vector3d& each) { return each.cross(direction).norm() > 1e-9; }))
      all.push_back(direction);
  }
  return all;
}

}  // namespace

Attachments attachments(const Plan& plan, int index) {
  using Choice = ReductionSpec::Attachment;
  const PlannedBody& body = plan.bodies[index];
  const Choice choice = body.spec.reduction.attachment;
  Attachments all;
  for (std::size_t i = 0; i < body.interface.size(); ++i) {
    const Place& place = body.spec.reduction.interface[i];
    const std::string name = place.point ? fmt::format("interface {}", i + 1) : place.name;
    for (int c = 0; c < body.structure.dofs_per_node; ++c)
      all.push_back(rigid_displacement(body, body.interface[i], c, name));
  }
  if (choice == Choice::joints || choice == Choice::all) add_joints(plan, index, all);
  for (std::size_t l = 0; l < plan.loads.size(); ++l) {
    const Load& load = plan.scene.loads[l];
    if (load.spread()) continue;
    const bool moment = load.kind == Load::Kind::moment;
    const int d = body.structure.dimension();
    const std::vector<Anchor> places = places_of_load(plan, l);
    for (const Anchor& place : places) {
      const bool negative = load.joint.empty() && &place != &places.front();  // where a load's shape is negative
      const bool of_joint = choice == Choice::joints && (!load.joint.empty() || (moment && at_a_joint(plan, place)));
      if (place.body != index || (choice != Choice::loads && choice != Choice::all && !of_joint)) continue;
      for (int c = moment ? d : 0; c < (moment ? body.structure.dofs_per_node : d); ++c)
        all.push_back(unit_load(body, place, c, negative ? load.name + "-" : load.name));
    }
  }
  return all;
}

std::vector<reduction::Attachment> loads_on(const Plan& plan, int index) {
  const PlannedBody& body = plan.bodies[index];
  Attachments all;
  for (std::size_t l = 0; l < plan.loads.size(); ++l) {
    const Load& load = plan.scene.loads[l];
    if (load.spread() || !load.joint.empty()) continue;  // to joints all directions belong anyway
    const Anchor& place = plan.loads[l];
    if (place.body != index) continue;
    const bool moment = load.kind == Load::Kind::moment;
    const Eigen::Matrix3d to_frame = load.axes == Load::Axes::world ? body.attitude.transpose() : body.axes.transpose();
    const auto& values = moment ? load.moment : load.force;
    for (const Eigen::Vector3d& direction : directions(values, plan.scene.motion.end)) {
      const Eigen::Vector3d in_frame = to_frame * direction;
      reduction::Attachment along{load.name, fem::field(body.structure), {}};
      for (const LoadPart& part : parts_of_load(plan, l))
        for (int i = 0; i < 3; ++i)
          check(VecAXPY(along.load, part.size * in_frame[i],
                        unit_load(body, part.at, (moment ? 3 : 0) + i, load.name).load));
      all.push_back(std::move(along));
    }
  }
  return all;
}

}  // namespace floe::plan
