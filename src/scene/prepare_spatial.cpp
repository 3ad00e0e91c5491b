#include "prepare_spatial.h"

#include <fmt/format.h>

#include <algorithm>

#include "prepare_reduced.h"

namespace floe::scene {
namespace {

const Body* body_of(const Scene& scene, const Place& place) {
  for (const Body& body : scene.bodies)
    if (body.name == place.body) return &body;
  return nullptr;
}

/// The place of the body where the ground clamps it, if any.
const Place* clamp_of(const Scene& scene, const Body& body) {
  for (const Joint& joint : scene.joints) {
    if (joint.kind != Joint::Kind::fixed) continue;
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

FrameChoice choose_frame(const Scene& scene, const Body& body, const SpatialMesh& mesh) {
  FrameChoice choice;
  const auto find = [&](const Place& place) { return spatial_place(body, mesh.structure, mesh.places, place); };
  const auto clamped = [&](const Place& place) {
    const PetscInt node = find(place).node;
    choice = {fem::ReferenceFrame::Kind::clamped, node, node, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  };
  if (!body.frame.given) {
    if (const Place* clamp = clamp_of(scene, body)) clamped(*clamp);
  } else if (body.frame.kind == FrameSpec::Kind::clamped) {
    clamped(body.frame.at);
  } else if (body.frame.kind == FrameSpec::Kind::pinned) {
    const PreparedPlace a = find(body.frame.from), b = find(body.frame.to);
    if (a.nodes.size() != 1 || b.nodes.size() != 1)
      throw InputError(fmt::format("{}: a pinned frame goes through two nodes; expected places of one node each",
                                   body.frame.where.text()));
    if (a.node == b.node)
      throw InputError(fmt::format("{}: from and to are one node; expected two", body.frame.where.text()));
    choice = {fem::ReferenceFrame::Kind::pinned, a.node, b.node, a.x, chord_axes(b.x - a.x)};
  }
  if (choice.kind == fem::ReferenceFrame::Kind::clamped) {
    const fem::Mesh& m = mesh.structure.mesh;
    choice.origin.setZero();
    if (const PetscInt local = choice.a - m.first_node; local >= 0 && local < m.owned_nodes)
      choice.origin = m.positions[local];
    MPI_Allreduce(MPI_IN_PLACE, choice.origin.data(), 3, MPI_DOUBLE, MPI_SUM, m.comm);
  }
  return choice;
}

PreparedBody prepare_body(const Scene& scene, const Body& spec, MPI_Comm comm) {
  SpatialMesh mesh = spatial_mesh(spec, comm);
  const FrameChoice choice = choose_frame(scene, spec, mesh);
  fem::express_in_frame(mesh.structure.mesh, choice.origin, choice.axes);
  for (fem::Section& section : mesh.structure.sections) section = fem::turned(section, choice.axes);
  fem::ReferenceFrame frame;
  try {
    frame = fem::reference_frame(mesh.structure, choice.kind, choice.a, choice.b);
  } catch (const InputError& error) {
    throw InputError(spec.frame.where.text() + ": " + error.what());
  }
  PreparedBody body{spec, std::move(mesh.structure), std::move(frame), {}, 0, {}, {}, {}, {}, {}, {}};
  body.places = std::move(mesh.places);
  body.parts = std::move(mesh.parts);
  body.notices = std::move(mesh.notices);
  body.origin = choice.origin;
  body.axes = choice.axes;
  for (const Place& place : spec.reduction.interface)
    body.interface.push_back(spatial_place(spec, body.structure, body.places, place, {choice.origin, choice.axes}));
  return body;
}

/// A place in the axes of the body's frame.
PreparedPlace find(const Scene& scene, const std::vector<PreparedBody>& bodies, const Place& place) {
  PreparedPlace found;
  if (place.ground()) {
    found.x = place.point ? Eigen::Vector3d((*place.point)[0], (*place.point)[1], (*place.point)[2])
                          : Eigen::Vector3d::Constant(std::nan(""));
    return found;
  }
  if (place.body.empty()) {
    found.body = PreparedPlace::elsewhere;
    return found;
  }
  const Body* spec = body_of(scene, place);
  if (!spec) throw InputError(place.where.text() + ": no body \"" + place.body + "\"");
  const PreparedBody& body = bodies[spec - scene.bodies.data()];
  if (spec->reduced) {
    found = reduced_place(*spec, place, body.structure.mesh.comm);
    found.body = static_cast<int>(spec - scene.bodies.data());
    return found;
  }
  found = spatial_place(*spec, body.structure, body.places, place, {body.origin, body.axes});
  found.body = static_cast<int>(spec - scene.bodies.data());
  return found;
}

/// Whether the nodes lie on one line, and are more than one point. Collective.
bool on_a_line(const fem::Mesh& mesh, const std::vector<PetscInt>& nodes, const Eigen::Vector3d& mean) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (PetscInt node : nodes) {
    const PetscInt local = node - mesh.first_node;
    if (local < 0 || local >= mesh.owned_nodes) continue;
    const Eigen::Vector3d d = mesh.positions[local] - mean;
    spread += d * d.transpose();
  }
  MPI_Allreduce(MPI_IN_PLACE, spread.data(), 9, MPI_DOUBLE, MPI_SUM, mesh.comm);
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return principal[2] > 0 && principal[1] <= 1e-12 * principal[2];
}

/// Dofs that a joint to the ground holds at its nodes, in frame axes: a clamp all of them, a hinge the displacements of
/// the nodes that lie on its line. @throws InputError  a hinge that has no line. Collective.
void hold_by_joint(const Joint& joint, const PreparedPlace& place, const fem::Mesh& mesh, fem::Conditions& held) {
  const bool all = joint.kind == Joint::Kind::fixed;
  if (!all && !on_a_line(mesh, place.nodes, place.x))
    throw InputError(joint.where.text() +
                     ": a hinge in space turns about the line of its nodes, and these lie on none; expected a place "
                     "that is an edge");
  for (PetscInt node : place.nodes)
    for (PetscInt dof = 0; dof < (all ? 6 : 3); ++dof) held.push_back(6 * node + dof);
}

}  // namespace

Prepared prepare_spatial(const Scene& scene, MPI_Comm comm) {
  Prepared prepared{scene, comm, {}, {}, {}, {}, 0};
  for (const Body& body : scene.bodies)
    prepared.bodies.push_back(body.reduced ? prepare_reduced(body, comm) : prepare_body(scene, body, comm));
  const auto place = [&](const Place& p) { return find(scene, prepared.bodies, p); };
  for (const Joint& joint : scene.joints) {
    prepared.joints.push_back({place(joint.first), place(joint.second)});
    const auto& [first, second] = prepared.joints.back();
    if (first.ground() == second.ground()) continue;
    const PreparedPlace& held = first.ground() ? second : first;
    if (held.map || held.body < 0) continue;
    PreparedBody& body = prepared.bodies[held.body];
    hold_by_joint(joint, held, body.structure.mesh, body.held);
  }
  for (PreparedBody& body : prepared.bodies) {
    if (body.spec.reduced) continue;
    const fem::Conditions followers = fem::follower_dofs(body.structure.mesh, body.structure.dofs_per_node);
    body.held.insert(body.held.end(), followers.begin(), followers.end());
    std::sort(body.held.begin(), body.held.end());
    body.held.erase(std::unique(body.held.begin(), body.held.end()), body.held.end());
  }
  for (const Load& load : scene.loads) {
    PreparedPlace where;
    if (load.kind != Load::Kind::distributed) where = place(load.at);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (load.kind == Load::Kind::distributed && scene.bodies[b].name == load.body) where.body = static_cast<int>(b);
    prepared.loads.push_back(where);
  }
  for (const Probe& probe : scene.probes) {
    std::array<PreparedPlace, 2> places;
    places[0] = place(probe.at);
    if (probe.relative_to) places[1] = place(*probe.relative_to);
    prepared.probes.push_back(places);
  }
  return prepared;
}

}  // namespace floe::scene
