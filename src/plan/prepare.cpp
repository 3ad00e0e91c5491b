#include "floe/plan/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/plan/hold_by_joint.h"
#include "floe/plan/planar_start.h"
#include "floe/plan/prepare_spatial.h"
#include "floe/plan/reduced_place.h"
#include "floe/scene/file_places.h"
#include "floe/scene/places.h"

namespace floe::plan {

const Anchor* constrained_place(const Plan& plan, std::size_t joint) {
  const auto& [first, second] = plan.joints[joint];
  if (first.ground() != second.ground()) return first.ground() ? &second : &first;
  for (const Anchor* place : {&first, &second})
    if (place->body >= 0 && plan.bodies[place->body].parent_joint == static_cast<int>(joint)) return place;
  return nullptr;
}

std::string name_of(fem::ReferenceFrame::Kind kind) {
  switch (kind) {
    case fem::ReferenceFrame::Kind::pinned:
      return "pinned";
    case fem::ReferenceFrame::Kind::clamped:
      return "clamped";
    default:
      return "mean-axis";
  }
}

MPI_Comm comm_of(const Plan& plan, Formulation formulation) {
  return is_reduced(formulation) ? PETSC_COMM_SELF : plan.comm;
}

bool last_rank(MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return rank == size - 1;
}

Eigen::Matrix2d rotation_matrix(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

namespace {

Eigen::Vector2d planar(const Point& p) { return {p[0], p[1]}; }
Eigen::Vector3d spatial(const Point& p) { return {p[0], p[1], p[2]}; }

fem::Segments segments_of(const MeshSpec& spec) {
  fem::Segments segments;
  for (const Point& p : spec.points) segments.points.push_back(spatial(p));
  segments.join = spec.segments;
  segments.elements.assign(spec.elements.begin(), spec.elements.end());
  return segments;
}

struct FrameNodes {
  PetscInt a = 0, b = 0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  // in mesh axes
  double angle = 0;
  double chord = 0;  // from a to b
};

FrameNodes frame_nodes(const Body& body, const fem::Mesh& mesh) {
  auto find = [&](const Place& place) { return fem::nearest_node(mesh, spatial(place_point(body.mesh, place))); };
  FrameNodes nodes;
  if (body.frame.kind == FrameSpec::Kind::pinned) {
    const fem::NearestNode a = find(body.frame.from), b = find(body.frame.to);
    const Eigen::Vector2d chord = (b.position - a.position).head<2>();
    nodes = {a.node, b.node, a.position.head<2>(), std::atan2(chord.y(), chord.x()), chord.norm()};
  } else if (body.frame.kind == FrameSpec::Kind::clamped) {
    const fem::NearestNode a = find(body.frame.at);
    nodes = {a.node, a.node, a.position.head<2>(), 0, 0};
  } else {
    nodes.origin = fem::near_origin(mesh).head<2>();
  }
  return nodes;
}

fem::ReferenceFrame::Kind kind_of(FrameSpec::Kind kind) {
  switch (kind) {
    case FrameSpec::Kind::pinned:
      return fem::ReferenceFrame::Kind::pinned;
    case FrameSpec::Kind::clamped:
      return fem::ReferenceFrame::Kind::clamped;
    default:
      return fem::ReferenceFrame::Kind::mean_axis;
  }
}

/// Dofs that a joint to the ground holds at a node, in the axes of the frame. @return  whether they hold all of it
bool hold_by_joint(const Joint& joint, PetscInt node, double frame_angle, fem::Conditions& constrained) {
  switch (joint.kind) {
    case Joint::Kind::fixed:
    case Joint::Kind::driven:
      constrained.insert(constrained.end(), {3 * node, 3 * node + 1, 3 * node + 2});
      return true;
    case Joint::Kind::revolute:
      constrained.insert(constrained.end(), {3 * node, 3 * node + 1});
      return true;
    case Joint::Kind::prismatic: {
      constrained.push_back(3 * node + 2);
      const Eigen::Vector2d axis = rotation_matrix(-frame_angle) * planar(joint.axis).normalized();
      if (std::abs(axis.y()) < 1e-9) constrained.push_back(3 * node + 1);
      if (std::abs(axis.x()) < 1e-9) constrained.push_back(3 * node);
      return axis.cwiseAbs().minCoeff() < 1e-9;
    }
    default:  // springs hold nothing; the other kinds are of space
      return false;
  }
}

PlannedBody prepare_body(const Body& spec, MPI_Comm comm) {
  fem::Mesh mesh = fem::mesh_of(comm, segments_of(spec.mesh));
  const FrameNodes nodes = frame_nodes(spec, mesh);
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = rotation_matrix(nodes.angle);
  fem::express_in_frame(mesh, Eigen::Vector3d(nodes.origin.x(), nodes.origin.y(), 0), rotation);
  fem::BeamSection section{spec.section.EA, spec.section.EI, spec.section.rhoA,
                           spec.rotary_inertia ? spec.section.rhoI : 0};
  if (spec.section.GA) section.GA = *spec.section.GA;
  fem::Structure structure = fem::planar_structure(
      std::move(mesh), std::vector<fem::BeamSection>(spec.mesh.segments.size(), section),
      spec.strain == Strain::averaged ? fem::MembraneStrain::averaged : fem::MembraneStrain::pointwise);
  fem::ReferenceFrame frame;
  try {
    frame = fem::reference_frame(structure, kind_of(spec.frame.kind), nodes.a, nodes.b);
  } catch (const InputError& error) {
    throw InputError(spec.frame.where.text() + ": " + error.what());
  }
  PlannedBody body{spec, std::move(structure), std::move(frame), nodes.origin, nodes.angle, {}, {}, {}, {}, {}, {}};
  body.frame_places = {Anchor{-1, nodes.a, Eigen::Vector3d::Zero()}, Anchor{-1, nodes.b, {nodes.chord, 0, 0}}};
  fem::StressPoints points;
  points.E = spec.section.E;
  if (spec.section.fibre > 0) points.fibres = {{spec.section.fibre, 0}, {-spec.section.fibre, 0}};
  body.points.assign(spec.mesh.segments.size(), points);
  for (const Place& place : spec.reduction.interface) {
    const Eigen::Vector2d x = rotation_matrix(-nodes.angle) * (planar(place_point(spec.mesh, place)) - nodes.origin);
    const fem::NearestNode nearest = fem::nearest_node(body.structure.mesh, {x.x(), x.y(), 0});
    body.interface.push_back({-1, nearest.node, nearest.position, {nearest.node}});
  }
  start_body(body);
  return body;
}

Anchor find(const std::vector<PlannedBody>& bodies, const Place& place) {
  Anchor found;
  if (place.ground()) {
    found.x = place.point ? spatial(*place.point) : Eigen::Vector3d::Constant(std::nan(""));
    return found;
  }
  if (place.body.empty()) {
    found.body = Anchor::elsewhere;
    return found;
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].spec.name != place.body) continue;
    if (bodies[b].spec.reduced) {
      found = reduced_place(bodies[b].spec, place, bodies[b].structure.mesh.comm);
      found.body = static_cast<int>(b);
      return found;
    }
    const Point p = place_point(bodies[b].spec, place);
    const Eigen::Vector2d x = rotation_matrix(-bodies[b].frame_angle) * (planar(p) - bodies[b].frame_origin);
    const fem::NearestNode nearest = fem::nearest_node(bodies[b].structure.mesh, {x.x(), x.y(), 0});
    if (bodies[b].spec.rigid) return {static_cast<int>(b), nearest.node, {x.x(), x.y(), 0}};
    return {static_cast<int>(b), nearest.node, nearest.position};
  }
  throw InputError(place.where.text() + ": no body \"" + place.body + "\"");
}

int body_index(const Scene& scene, const std::string& name) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].name == name) return static_cast<int>(b);
  return -1;
}

}  // namespace

bool hold_place_by_joint(const Plan& plan, std::size_t joint, const Anchor& place, fem::Conditions& constrained) {
  const PlannedBody& body = plan.bodies[place.body];
  if (body.structure.dimension() == 3) return hold_spatial_place_by_joint(plan, joint, place, constrained);
  return hold_by_joint(plan.scene.joints[joint], place.node, body.spec.initial.angle + body.frame_angle, constrained);
}

Plan prepare(const Scene& scene, MPI_Comm comm) {
  if (scene.dimension == 3) return prepare_spatial(scene, comm);
  Plan plan{scene, comm, {}, {}, {}, {}, 0};
  for (const Body& body : scene.bodies) {
    plan.bodies.push_back(body.reduced ? prepare_reduced(body, comm) : prepare_body(body, comm));
    if (body.reduced) plan.extent = std::max(plan.extent, extent_of(*body.reduced->file));
    for (const Point& p : body.mesh.points)
      for (const Point& q : body.mesh.points) plan.extent = std::max(plan.extent, (spatial(p) - spatial(q)).norm());
  }
  for (const Joint& joint : scene.joints) {
    plan.joints.push_back({find(plan.bodies, joint.first), find(plan.bodies, joint.second)});
    const auto& [first, second] = plan.joints.back();
    if (first.ground() == second.ground()) continue;
    const Anchor& place = first.ground() ? second : first;
    if (place.map || place.body < 0) continue;
    PlannedBody& body = plan.bodies[place.body];
    hold_by_joint(joint, place.node, body.spec.initial.angle + body.frame_angle, body.constrained);  // undeformed
  }
  for (PlannedBody& body : plan.bodies) {
    std::sort(body.constrained.begin(), body.constrained.end());
    body.constrained.erase(std::unique(body.constrained.begin(), body.constrained.end()), body.constrained.end());
  }
  for (const Load& load : scene.loads) {
    Anchor place;
    if (load.spread())
      place.body = body_index(scene, load.body);
    else
      place = find(plan.bodies, load.at);
    plan.loads.push_back(place);
  }
  for (const Probe& probe : scene.probes) {
    std::array<Anchor, 2> places;
    places[0] = find(plan.bodies, probe.at);
    if (const auto& other = probe.relative_to ? probe.relative_to : probe.toward) places[1] = find(plan.bodies, *other);
    plan.probes.push_back(places);
    std::vector<Anchor>& frame = plan.probe_frames.emplace_back();
    for (const Place& place : probe.frame) frame.push_back(find(plan.bodies, place));
  }
  return plan;
}

}  // namespace floe::plan
