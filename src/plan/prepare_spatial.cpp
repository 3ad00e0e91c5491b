#include "floe/plan/prepare_spatial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "drilling_notes.h"
#include "floe/math/rotation.h"
#include "floe/plan/ground_axes.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/plan/reduced_place.h"
#include "floe/plan/shared_frames.h"
#include "floe/plan/spatial_start.h"
#include "floe/scene/file_places.h"
#include "interfaces.h"
#include "rims.h"

namespace floe::plan {
namespace {

const Body* body_of(const Scene& scene, const Place& place) {
  for (const Body& body : scene.bodies)
    if (body.name == place.body) return &body;
  return nullptr;
}

}  // namespace

bool holds_a_piece(const Joint& joint) {
  const bool to_ground = joint.first.ground() || joint.second.ground();
  return joint.edges == Joint::Edges::rigid && !(clamps(joint) && to_ground);
}

namespace {

/// The place of the body where the ground clamps it, moved or not, if any.
const Place* clamp_of(const Scene& scene, const Body& body) {
  for (const Joint& joint : scene.joints) {
    if (!clamps(joint)) continue;
    if (joint.first.ground() && joint.second.body == body.name) return &joint.second;
    if (joint.second.ground() && joint.first.body == body.name) return &joint.first;
  }
  return nullptr;
}

struct FrameChoice {
  fem::ReferenceFrame::Kind kind = fem::ReferenceFrame::Kind::mean_axis;
  PetscInt a = 0, b = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// x along the chord; y as near as can be to the mesh's y axis, or z where the chord is along y.
Eigen::Matrix3d chord_axes(const Eigen::Vector3d& chord) {
  Eigen::Matrix3d axes;
  axes.col(0) = chord.normalized();
  const Eigen::Vector3d near = std::abs(axes(1, 0)) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  axes.col(2) = axes.col(0).cross(near).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// The first that the ground holds, else the first that a body holds.
std::optional<PetscInt> independent_node_of_rim(const std::map<PetscInt, Rim>& rims) {
  for (const auto& [independent_node, rim] : rims)
    if (rim.holder == "ground") return independent_node;
  if (rims.empty()) return {};
  return rims.begin()->first;
}

FrameChoice choose_frame(const Scene& scene, const Body& body, const SpatialMesh& mesh) {
  FrameChoice choice;
  const auto find = [&](const Place& place) { return spatial_place(body, mesh.structure, mesh.places, place); };
  const auto clamped = [&](const Place& place) {
    const PetscInt node = find(place).node;
    choice = {fem::ReferenceFrame::Kind::clamped, node, node, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  };
  if (!body.frame.given) {
    if (const Place* clamp = clamp_of(scene, body)) {
      if (clamped_by_default(body)) clamped(*clamp);
    } else if (const auto rim = independent_node_of_rim(fixed_rims(scene, body, mesh.structure, mesh.places))) {
      choice = {fem::ReferenceFrame::Kind::clamped, *rim, *rim, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    }
  } else if (body.frame.kind == FrameSpec::Kind::clamped) {
    clamped(body.frame.at);
  } else if (body.frame.kind == FrameSpec::Kind::pinned) {
    const Anchor a = find(body.frame.from), b = find(body.frame.to);
    if (a.nodes.size() != 1 || b.nodes.size() != 1)
      throw InputError(fmt::format("{}: a pinned frame is defined by two nodes; expected places of one node each",
                                   body.frame.where.text()));
    if (a.node == b.node)
      throw InputError(
          fmt::format("{}: from and to are the same node; expected two different nodes", body.frame.where.text()));
    choice = {fem::ReferenceFrame::Kind::pinned, a.node, b.node, a.x, chord_axes(b.x - a.x)};
  }
  const bool pinned = choice.kind == fem::ReferenceFrame::Kind::pinned;
  if (!body.rigid) {
    std::vector<Eigen::Vector3d> directions = ground_axes(scene, body, mesh);
    if (const auto axis = axis_of_shape(mesh.structure.mesh)) directions.push_back(*axis);
    choice.axes = axes_along(choice.axes, pinned ? 0 : -1, directions);
  }
  if (choice.kind == fem::ReferenceFrame::Kind::clamped) {
    const fem::Mesh& m = mesh.structure.mesh;
    choice.origin.setZero();
    if (const PetscInt local = choice.a - m.first_node; local >= 0 && local < m.owned_nodes)
      choice.origin = m.positions[local];
    MPI_Allreduce(MPI_IN_PLACE, choice.origin.data(), 3, MPI_DOUBLE, MPI_SUM, m.comm);
  }
  if (choice.kind == fem::ReferenceFrame::Kind::mean_axis) choice.origin = fem::near_origin(mesh.structure.mesh);
  return choice;
}

bool has_mass(const fem::Section& section) {
  if (const auto* beam = std::get_if<fem::SpatialBeam>(&section)) return beam->section.rhoA > 0;
  if (const auto* shell = std::get_if<fem::ShellSection>(&section)) return shell->mass > 0;
  return !std::holds_alternative<fem::NodeSpring>(section);
}

/// The frame of a welded body: clamped at its joint's place, with the origin and the axes of the parent's.
FrameChoice frame_of_parent(const Scene& scene, const Body& body, const SpatialMesh& mesh, const SharedFrame& shared,
                            const PlannedBody& parent) {
  const Joint& joint = scene.joints[shared.joint];
  const Place& at = joint.first.body == body.name ? joint.first : joint.second;
  const auto vector = [](const Point& p) { return Eigen::Vector3d(p[0], p[1], p[2]); };
  const Eigen::Matrix3d rotated = math::rotation(vector(body.initial.rotation)).transpose();
  const PetscInt node = body.rigid ? 0 : spatial_place(body, mesh.structure, mesh.places, at).node;
  return {fem::ReferenceFrame::Kind::clamped, node, node, rotated * (parent.place - vector(body.initial.position)),
          rotated * parent.attitude};
}

/// Collective.
Anchor node_of_frame(const fem::Structure& structure, PetscInt node) {
  Anchor at{Anchor::elsewhere, node, Eigen::Vector3d::Zero(), {node}};
  const fem::Mesh& m = structure.mesh;
  if (const PetscInt local = node - m.first_node; local >= 0 && local < m.owned_nodes) at.x = m.positions[local];
  MPI_Allreduce(MPI_IN_PLACE, at.x.data(), 3, MPI_DOUBLE, MPI_SUM, m.comm);
  at.averaging_weights = {{node, 1, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()}};
  return at;
}

/// @param parent  body to which the welded one is fixed
PlannedBody prepare_body(const Scene& scene, const Body& spec, MPI_Comm comm, const SharedFrame& shared,
                         const PlannedBody* parent) {
  SpatialMesh mesh = spatial_mesh(scene, spec, comm);
  if (const auto& sections = mesh.structure.sections;
      !spec.rigid && std::none_of(sections.begin(), sections.end(), has_mass))
    throw InputError(
        fmt::format("{}: no part of body {} has mass; expected a material with rho > 0", spec.where.text(), spec.name));
  const FrameChoice choice =
      parent ? frame_of_parent(scene, spec, mesh, shared, *parent) : choose_frame(scene, spec, mesh);
  fem::express_in_frame(mesh.structure.mesh, choice.origin, choice.axes);
  for (fem::Section& section : mesh.structure.sections) section = fem::rotated(section, choice.axes);
  fem::ReferenceFrame frame;
  try {
    frame = fem::reference_frame(mesh.structure, choice.kind, choice.a, choice.b);
  } catch (const InputError& error) {
    throw InputError(spec.frame.where.text() + ": " + error.what());
  }
  PlannedBody body{spec, std::move(mesh.structure), std::move(frame), {}, 0, {}, {}, {}, {}, {}, {}};
  body.places = std::move(mesh.places);
  body.parts = std::move(mesh.parts);
  body.notices = std::move(mesh.notices);
  body.strains = std::move(mesh.strains);
  body.points = std::move(mesh.points);
  body.origin = choice.origin;
  body.axes = choice.axes;
  if (choice.kind != fem::ReferenceFrame::Kind::mean_axis)
    body.frame_places = {node_of_frame(body.structure, choice.a), node_of_frame(body.structure, choice.b)};
  if (parent) body.parent = shared.parent, body.parent_joint = shared.joint;
  for (const Place& place : spec.reduction.interface)
    body.interface.push_back(spatial_place(spec, body.structure, body.places, place, {choice.origin, choice.axes}));
  return body;
}

/// A place in the axes of the body's frame.
Anchor find(const Scene& scene, const std::vector<PlannedBody>& bodies, const Place& place) {
  Anchor found;
  if (place.ground()) {
    found.x = place.point ? Eigen::Vector3d((*place.point)[0], (*place.point)[1], (*place.point)[2])
                          : Eigen::Vector3d::Constant(std::nan(""));
    return found;
  }
  if (place.body.empty()) {
    found.body = Anchor::elsewhere;
    return found;
  }
  const Body* spec = body_of(scene, place);
  if (!spec) throw InputError(place.where.text() + ": no body \"" + place.body + "\"");
  const PlannedBody& body = bodies[spec - scene.bodies.data()];
  if (spec->reduced) {
    found = reduced_place(*spec, place, body.structure.mesh.comm);
    found.body = static_cast<int>(spec - scene.bodies.data());
    return found;
  }
  found = spatial_place(*spec, body.structure, body.places, place, {body.origin, body.axes});
  found.body = static_cast<int>(spec - scene.bodies.data());
  return found;
}

/// Parents first, for their welded bodies' meshes are expressed in their frames.
std::vector<PlannedBody> prepare_bodies(const Scene& scene, MPI_Comm comm) {
  const std::vector<SharedFrame> shared = shared_frames(scene);
  std::vector<std::optional<PlannedBody>> found(scene.bodies.size());
  for (const bool welded_bodies : {false, true})
    for (std::size_t b = 0; b < found.size(); ++b) {
      const Body& spec = scene.bodies[b];
      if (shared[b].shared() != welded_bodies) continue;
      found[b] = spec.reduced
                     ? prepare_reduced(spec, comm)
                     : prepare_body(scene, spec, comm, shared[b], welded_bodies ? &*found[shared[b].parent] : nullptr);
      start_spatial_body(*found[b]);
    }
  std::vector<PlannedBody> bodies;
  for (std::optional<PlannedBody>& body : found) bodies.push_back(std::move(*body));
  return bodies;
}

}  // namespace

Plan prepare_spatial(const Scene& scene, MPI_Comm comm) {
  Plan plan{scene, comm, {}, {}, {}, {}, 0};
  plan.bodies = prepare_bodies(scene, comm);
  const auto place = [&](const Place& p) { return find(scene, plan.bodies, p); };
  for (PlannedBody& body : plan.bodies)
    plan.extent = std::max(
        plan.extent, body.spec.reduced ? extent_of(*body.spec.reduced->file) : extent_of_mesh(body.structure.mesh));
  prepare_joints(plan, place);
  find_interfaces(plan);
  fix_frames(plan);
  check_pairs(plan);
  for (PlannedBody& body : plan.bodies) {
    if (body.spec.reduced) continue;
    const fem::Conditions dependent_nodes = fem::dependent_dofs(body.structure.mesh, body.structure.dofs_per_node);
    body.clamp.insert(body.clamp.end(), body.frame.conditions.begin(), body.frame.conditions.end());
    for (fem::Conditions* dofs : {&body.constrained, &body.clamp}) {
      dofs->insert(dofs->end(), dependent_nodes.begin(), dependent_nodes.end());
      std::sort(dofs->begin(), dofs->end());
      dofs->erase(std::unique(dofs->begin(), dofs->end()), dofs->end());
    }
  }
  for (const Load& load : scene.loads) {
    Anchor where;
    if (!load.spread()) where = place(load.at);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (load.spread() && scene.bodies[b].name == load.body) where.body = static_cast<int>(b);
    if (load.per != Load::Per::whole) {
      const PlannedBody& body = plan.bodies[where.body];
      if (body.spec.rigid || body.spec.reduced)
        throw InputError(fmt::format("{}: is per {}, and body {} has no elements there; expected the resultant",
                                     load.where.text(), load.per == Load::Per::length ? "length" : "area",
                                     body.spec.name));
      plan.load_parts[plan.loads.size()] = spread_load(load, body.structure, where, {body.origin, body.axes});
    }
    plan.loads.push_back(where);
  }
  note_drilling(plan);
  for (const Probe& probe : scene.probes) {
    std::array<Anchor, 2> places;
    places[0] = place(probe.at);
    if (const auto& other = probe.relative_to ? probe.relative_to : probe.toward) places[1] = place(*other);
    plan.probes.push_back(places);
    std::vector<Anchor>& frame = plan.probe_frames.emplace_back();
    for (const Place& one : probe.frame) frame.push_back(place(one));
  }
  return plan;
}

}  // namespace floe::plan
