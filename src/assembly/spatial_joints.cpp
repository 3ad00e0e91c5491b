#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "connections.h"
#include "drive.h"
#include "floe/dynamics/spatial_spring.h"
#include "floe/petsc/values.h"
#include "floe/plan/attachments.h"
#include "spatial_assembly.h"
#include "spatial_rows.h"
#include "start_shape.h"
#include "stops.h"

namespace floe::assembly {

using dynamics::SpatialConstraint;
using dynamics::SpatialMarker;
using dynamics::SpatialPose;
using Kind = Joint::Kind;

int spatial_rows(Kind kind) {
  switch (kind) {
    case Kind::fixed:
    case Kind::driven:
    case Kind::driven_slide:
      return 6;
    case Kind::revolute:
    case Kind::prismatic:
      return 5;
    case Kind::cylindrical:
    case Kind::universal:
      return 4;
    case Kind::spherical:
    case Kind::planar:
      return 3;
    case Kind::distance:
      return 1;
    default:
      return 0;
  }
}

namespace {

/// @param apart  from the first place to the second at the start, world axes
SpatialConstraint constraint_of(const Joint& joint, const Motion& motion, const Eigen::Vector3d& apart) {
  switch (joint.kind) {
    case Kind::fixed:
      return SpatialConstraint::fixed();
    case Kind::revolute:
      return SpatialConstraint::revolute();
    case Kind::prismatic:
      return SpatialConstraint::prismatic();
    case Kind::cylindrical:
      return SpatialConstraint::cylindrical();
    case Kind::spherical:
      return SpatialConstraint::spherical();
    case Kind::universal:
      return SpatialConstraint::universal();
    case Kind::planar:
      return SpatialConstraint::planar();
    case Kind::distance:
      if (apart.norm() == 0)
        throw InputError(joint.where.text() + ": its places coincide; expected a distance, or type spherical");
      return SpatialConstraint::distance(apart.norm());
    case Kind::driven:
      return SpatialConstraint::driven_revolute(drive_of(joint, motion));
    case Kind::driven_slide:
      return SpatialConstraint::driven_prismatic(drive_of(joint, motion));
    default:
      return {};
  }
}

/// Whether the joint's places are one point.
bool meets(Kind kind) {
  return kind == Kind::fixed || kind == Kind::revolute || kind == Kind::driven || kind == Kind::spherical ||
         kind == Kind::universal;
}

std::string point(const Eigen::Vector3d& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z()); }

}  // namespace

SpatialAssembly::PlacedJoint SpatialAssembly::place(int j, const std::array<Anchor, 2>& anchors) {
  const Joint& joint = plan_.scene.joints[j];
  const Eigen::Matrix3d& W = plan_.joint_axes[j];
  PlacedJoint placed{{marker(anchors[0]), marker(anchors[1])}, {}};
  if (!sees_) return placed;
  for (int i = 0; i < 2; ++i)  // a ground without a point follows the other place
    if (anchors[i].ground() && std::isnan(placed.places[i].x0.x()))
      placed.places[i].x0 = start_of(placed.places[1 - i]).p;
  for (SpatialMarker& place : placed.places) place.D0 = place.D0 * start_of(place).D.transpose() * W;
  const Eigen::Vector3d from = start_of(placed.places[0]).p, to = start_of(placed.places[1]).p;
  if (meets(joint.kind) && (to - from).norm() > 1e-6 * plan_.extent)
    throw InputError(
        fmt::format("{}: the two places of joint {} are {:.6g} apart at the start, at {} and {}; expected "
                    "{}",
                    joint.where.text(), joint.name, (to - from).norm(), point(from), point(to),
                    expected_to_meet(plan_, formulation_, j)));
  placed.constraint = constraint_of(joint, plan_.scene.motion, to - from);
  for (dynamics::SpatialRow& row : placed.constraint.rows)
    if (auto* along = std::get_if<dynamics::Along>(&row)) along->offset = W.col(along->axis).dot(to - from);
  return placed;
}

void SpatialAssembly::connect(int j, std::unique_ptr<dynamics::Connection> term) {
  connections_[static_cast<std::size_t>(j)].push_back(term.get());
  terms_.push_back(std::move(term));
}

void SpatialAssembly::add_spring(int j, const PlacedJoint& placed) {
  const Joint& joint = plan_.scene.joints[j];
  if (joint.kind == Kind::bushing) {
    dynamics::BushingProperties bushing;
    for (int i = 0; i < 3; ++i) {
      bushing.stiffness[i] = joint.translation[i], bushing.stiffness[3 + i] = joint.rotation[i];
      bushing.viscosity[i] = joint.translation_viscosity[i], bushing.viscosity[3 + i] = joint.rotation_viscosity[i];
    }
    const SpatialPose from = start_of(placed.places[0]), to = start_of(placed.places[1]);
    bushing.rest = from.D.transpose() * (to.p - from.p);
    bushing.name = joint.name;
    connect(j, std::make_unique<dynamics::SpatialBushing>(placed.places[0], placed.places[1], bushing));
    return;
  }
  const double apart = (start_of(placed.places[1]).p - start_of(placed.places[0]).p).norm();
  if (joint.stiffness != 0 && joint.length.value_or(0) > 0 && apart <= 1e-12 * plan_.extent)
    throw InputError(
        fmt::format("{}: the places of spring {} coincide at the start, which leaves undefined the direction of its "
                    "force; expected length: 0, or places apart",
                    joint.where.text(), joint.name));
  connect(j, std::make_unique<dynamics::SpatialSpring>(
                 placed.places[0], placed.places[1],
                 dynamics::SpatialSpringProperties{
                     joint.stiffness, joint.viscosity, relaxed_length(joint, apart, plan_.extent),
                     joint.torsional_stiffness, joint.torsional_viscosity, 0, joint.rest_angle}));
}

void SpatialAssembly::add_joint(int j, const PlacedJoint& placed, int first, const std::vector<int>& independent) {
  const auto found = switches_.find(plan_.scene.joints[j].name);
  const JointSwitches switches = found == switches_.end() ? JointSwitches{} : found->second;
  connect(j, std::make_unique<dynamics::SpatialJoint>(placed.places[0], placed.places[1], placed.constraint, first,
                                                      independent, plan_.extent, switches.joint));
  if (switches.lock)
    connect(j, std::make_unique<dynamics::SpatialJoint>(placed.places[0], placed.places[1],
                                                        dynamics::lock_of(placed.constraint), switches.first_row,
                                                        switches.lock, true));
  for (int i = static_cast<int>(independent.size()); i < dynamics::rows(placed.constraint); ++i)
    terms_.push_back(std::make_unique<reference::ConstrainedDof>(first + i, 1));  // of a row that is left out
}

std::unique_ptr<dynamics::SpatialCoordinate> SpatialAssembly::coordinate_of(int j, Of of,
                                                                            const PlacedJoint& placed) const {
  const Eigen::Vector3d apart = start_of(placed.places[1]).p - start_of(placed.places[0]).p;
  const double start = of == Of::slide ? plan_.joint_axes[j].col(2).dot(apart) : 0;
  return std::make_unique<dynamics::SpatialCoordinate>(placed.places[0], placed.places[1], of, start);
}

void SpatialAssembly::add_stops(int j, const PlacedJoint& placed, std::vector<ModelStop>& stops) {
  const Joint& joint = plan_.scene.joints[j];
  const std::shared_ptr<const dynamics::ConstraintSwitch> active = own_switch(switches_, joint.name);
  const auto add = [&](const LimitsSpec& limits, Of of) {
    const dynamics::Stop* term = nullptr;
    if (owner_) {
      auto stop = std::make_unique<dynamics::Stop>(coordinate_of(j, of, placed),
                                                   law_of(limits, of == Of::rotation, plan_.extent), active);
      term = stop.get();
      connect(j, std::move(stop));
    }
    note_stops(joint, limits, term, stops);
  };
  const Of main = joint.kind == Kind::revolute ? Of::rotation : Of::slide;
  if (joint.friction && owner_)
    connect(j, std::make_unique<dynamics::JointForce>(coordinate_of(j, main, placed), law_of(*joint.friction), active));
  if (joint.rotation_friction && owner_)
    connect(j, std::make_unique<dynamics::JointForce>(coordinate_of(j, Of::rotation, placed),
                                                      law_of(*joint.rotation_friction), active));
  if (joint.limits) add(*joint.limits, main);
  if (joint.rotation_limits) add(*joint.rotation_limits, Of::rotation);
}

/// A support has no constraint rows: it holds dofs of a body that does not move as a whole.
void SpatialAssembly::refuse_loose_supports() const {
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const Joint& joint = plan_.scene.joints[j];
    if (joint.kind != Kind::support || constrained_nodes_.contains(static_cast<int>(j)) || stands(static_cast<int>(j)))
      continue;
    const Anchor& place = plan_.joints[j][joint.first.ground() ? 1 : 0];
    const Body& body = plan_.bodies[place.body].spec;
    if (body.reduced)
      throw InputError(
          fmt::format("{}: supports hold bodies with a mesh, and body {} comes from a file; expected other joints, or "
                      "the body's mesh",
                      joint.where.text(), body.name));
    if (body.frame.given)
      throw InputError(
          fmt::format("{}: body {} has a frame of its own, and supports hold bodies without one; expected "
                      "no frame in the body, or joints instead of supports",
                      body.frame.where.text(), body.name));
    if (is_reduced(formulation_) && !modes_satisfy_joints(plan_.bodies[place.body]))
      throw InputError(
          fmt::format("{}: of is frame, but body {} has a support, which its modes have to satisfy; "
                      "expected of: joints",
                      body.reduction.modes.where.text(), body.name));
    throw InputError(
        fmt::format("{}: its body can still move as a whole; expected supports and other joints to the ground that "
                    "leave body {} no rigid motion, without events of these",
                    joint.where.text(), body.name));
  }
}

/// Of a frame that does not move: modes of the frame satisfy its conditions alone, those of one node for instance, and
/// constraint equations of a joint on several nodes hold their mean, not each.
void SpatialAssembly::refuse_unsatisfied_edges() const {
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const Joint& joint = plan_.scene.joints[j];
    const Anchor* place = constrained_place(plan_, j);
    if (!is_reduced(formulation_) || !place || place->body < 0 || !slots_[place->body].still ||
        !plan_.joint_constrained[j] || place->line || place->moved_by().size() <= 1 ||
        modes_satisfy_place(plan_.bodies[place->body], *place))
      continue;
    const Body& body = plan_.bodies[place->body].spec;
    throw InputError(
        fmt::format("{}: of is frame, but joint {} fixes {} nodes of body {}, each of which its modes have to satisfy; "
                    "expected of: joints",
                    body.reduction.modes.where.text(), joint.name, place->nodes.size(), body.name));
  }
}

void SpatialAssembly::add_joints(Model& model) {
  struct Piece {  // with rows
    int joint;
    PlacedJoint placed;
    int first;   // of its multipliers
    bool apart;  // its rows are independent
  };
  std::vector<int> all;  // finding places is collective, what follows is rank-local
  std::vector<Piece> pieces;
  std::string notes;
  refuse_loose_supports();
  refuse_unsatisfied_edges();
  const auto find = [&] {
    count_uses();
    for (int j = 0; j < static_cast<int>(plan_.joints.size()); ++j) {
      std::vector<PlacedJoint> placed = place_all(j);
      placed_.push_back(placed.empty() ? PlacedJoint{} : placed.front());
      if (stands(j)) continue;
      all.push_back(j);
      int first = multipliers_[j];
      for (std::size_t i = 0; i < placed.size() && owner_; ++i) {
        const int rows = dynamics::rows(placed[i].constraint);
        if (rows > 0) pieces.push_back({j, std::move(placed[i]), first, stands_apart(j, i)});
        first += rows;
      }
    }
  };
  const auto add = [&] {
    if (!owner_) {
      for (const int j : all) add_stops(j, placed_[j], model.stops);
      return;
    }
    SpatialRows rows(plan_, start_);
    for (const Piece& piece : pieces)
      if (!piece.apart) rows.add(piece.joint, piece.placed.places, piece.placed.constraint);
    const std::vector<std::vector<int>> independent = rows.independent(notes, undetermined_);
    std::size_t next = 0;
    for (const int j : all)
      if (placed_[j].constraint.rows.empty() && !constrained_nodes_.contains(j)) add_spring(j, placed_[j]);
    for (const Piece& piece : pieces) {
      std::vector<int> every(piece.placed.constraint.rows.size());
      std::iota(every.begin(), every.end(), 0);
      add_joint(piece.joint, piece.placed, piece.first, piece.apart ? every : independent[next++]);
    }
    for (const int j : all) add_stops(j, placed_[j], model.stops);
  };
  if (is_reduced(formulation_)) {
    find();
    add();
  } else {
    petsc::agree(plan_.comm, find);
    petsc::agree(plan_.comm, add);
    int length = static_cast<int>(notes.size()), size = 1;
    MPI_Comm_size(plan_.comm, &size);
    MPI_Bcast(&length, 1, MPI_INT, size - 1, plan_.comm);
    notes.resize(length);
    MPI_Bcast(notes.data(), length, MPI_CHAR, size - 1, plan_.comm);
  }
  for (std::size_t begin = 0; begin < notes.size();) {
    const std::size_t end = notes.find('\n', begin);
    model.warnings.push_back(notes.substr(begin, end - begin));
    begin = end + 1;
  }
}

}  // namespace floe::assembly
