#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "floe/error.h"
#include "floe/fem/shell.h"
#include "floe/math/rotation.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/reference/surface_pressure.h"
#include "floe/scene/joint_events.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::SpatialMarker;
using Eigen::Vector3d;

using Pieces = std::vector<std::vector<PetscInt>>;

namespace {

/// A node may move a place by its rotation alone: in the middle of an edge under an odd load.
bool has_weight(const AveragingWeight& weight) { return weight.share != 0 || !weight.arm.isZero(0); }

/// a of an averaging weight's arm, theta x a. In an edge of a shell, arm = c (1 + (alpha - 1) t t') (theta x s), the
/// greater one: where alpha > 1 the one of displacements in the plane, alpha c s, so that even tension is exact
/// ((1 + alpha) / 2 from the skew part of the matrix, (alpha - 1) / 2 from the symmetric one). Where alpha < 1, a
/// is c s.
Vector3d arm_of(const AveragingWeight& weight) {
  const Eigen::Matrix3d twice = weight.arm.transpose() - weight.arm;
  const Vector3d a = Vector3d(twice(2, 1), twice(0, 2), twice(1, 0)) / 2;
  if (a.isZero(0)) return a;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> symmetric(
      Eigen::Matrix3d(weight.arm + weight.arm.transpose()) / 2, Eigen::EigenvaluesOnly);
  return (1 + symmetric.eigenvalues().cwiseAbs().maxCoeff() / a.norm()) * a;
}

bool in(const std::vector<PetscInt>& piece, const Anchor& place) {
  return std::all_of(place.averaging_weights.begin(), place.averaging_weights.end(),
                     [&](const AveragingWeight& weight) {
                       return !has_weight(weight) || std::binary_search(piece.begin(), piece.end(), weight.node);
                     });
}

/// Whether the place is the mean of nodes that move by themselves, or, along the line of a hinge, rotate about it so.
bool is_mean(const Anchor& place, const Pieces& pieces) {
  return place.nodes.size() > 1 &&
         (place.line ||
          std::count_if(place.averaging_weights.begin(), place.averaging_weights.end(), has_weight) > 1) &&
         std::none_of(pieces.begin(), pieces.end(), [&](const auto& piece) { return in(piece, place); });
}

}  // namespace

/// Edges that joints clamp to what does not deform; those with nodes in common are one piece.
std::vector<std::vector<PetscInt>> SpatialAssembly::clamped_edges(int b) const {
  Pieces pieces;
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const Anchor* place = constrained_place(plan_, j);
    const Joint& joint = plan_.scene.joints[j];
    if (!place || place->body != b || !plan_.joint_constrained[j] || !clamps(joint)) continue;
    if (is_unlocked(plan_.scene, joint.name)) continue;  // its edge deforms when it is free
    if (place->nodes.size() < 2 ||
        std::count_if(place->averaging_weights.begin(), place->averaging_weights.end(), has_weight) < 2)
      continue;
    std::vector<PetscInt> piece;
    for (const AveragingWeight& weight : place->averaging_weights)
      if (has_weight(weight)) piece.push_back(weight.node);
    std::sort(piece.begin(), piece.end());
    for (std::size_t p = 0; p < pieces.size();) {
      std::vector<PetscInt> both;
      std::set_union(piece.begin(), piece.end(), pieces[p].begin(), pieces[p].end(), std::back_inserter(both));
      if (both.size() == piece.size() + pieces[p].size()) {
        ++p;
        continue;
      }
      piece = std::move(both);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(p));
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

bool SpatialAssembly::is_corotated_mean(const Anchor& place) const {
  return formulation_ == Formulation::cfr && place.body >= 0 && corotated(place.body) &&
         is_mean(place, clamped_edges(place.body));
}

std::vector<SpatialAssembly::ConstrainedNode> SpatialAssembly::nodes_constrained_by(std::size_t j,
                                                                                    bool released) const {
  std::vector<ConstrainedNode> nodes;
  const Anchor& place = *constrained_place(plan_, j);
  const Pieces pieces = clamped_edges(place.body);
  for (const AveragingWeight& weight : place.averaging_weights) {
    const PetscInt node = place.rotates_apart() ? place.nodes.front() : weight.node;
    const bool clamped = std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
      return std::binary_search(piece.begin(), piece.end(), node);
    });
    if (!has_weight(weight) || clamped) continue;
    ConstrainedNode one{node, {}, {}};
    for (int dof = 0; dof < 6; ++dof)
      if (released || plan_.scene.joints[j].hold[dof]) one.dofs.push_back(dof);
    nodes.push_back(std::move(one));
  }
  return nodes;
}

void SpatialAssembly::find_constrained_nodes() {
  if (formulation_ != Formulation::cfr) return;
  using Dof = std::array<PetscInt, 3>;
  std::map<Dof, std::vector<int>> joints_of;
  for (const bool released : {false, true})
    for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
      const Joint& joint = plan_.scene.joints[j];
      const Anchor* place = constrained_place(plan_, j);
      if (!place || place->body < 0 || !corotated(place->body)) continue;
      if (released !=
          (clamps(joint) && is_unlocked(plan_.scene, joint.name) && !place->line && is_corotated_mean(*place)))
        continue;
      if (!released && joint.kind != Joint::Kind::support) continue;
      for (const Probe& probe : plan_.scene.probes)
        if (probe.joint == joint.name && probe.quantity == Probe::Quantity::power)
          throw InputError(
              fmt::format("{}: measures the power of joint {}, which in formulation cfr constrains each node "
                          "of its place; expected quantity: force or moment",
                          probe.where.text(), joint.name));
      constrained_nodes_[static_cast<int>(j)] = nodes_constrained_by(j, released);
      for (const ConstrainedNode& one : constrained_nodes_[static_cast<int>(j)])
        for (const int dof : one.dofs)  // what a support holds too does not count for a clamp that is released
          if (std::vector<int>& joints = joints_of[{place->body, one.node, dof}];
              joints.empty() || released == clamps(plan_.scene.joints[static_cast<std::size_t>(joints.front())]))
            joints.push_back(static_cast<int>(j));
    }
  for (auto& [j, nodes] : constrained_nodes_) {
    std::vector<ConstrainedNode> own;
    for (const ConstrainedNode& one : nodes)
      for (const int dof : one.dofs) {
        const std::vector<int>& joints = joints_of.at({constrained_place(plan_, j)->body, one.node, dof});
        if (joints.front() != j) continue;
        if (own.empty() || own.back().node != one.node || own.back().joints != joints)
          own.push_back({one.node, {}, joints});
        own.back().dofs.push_back(dof);
      }
    nodes = std::move(own);
  }
}

/// A component of the displacement along the constrained body's axes at the start; the rotation about such an axis by
/// the two others: y of the other place stays normal to x of the node, and so on.
std::vector<SpatialAssembly::PlacedJoint> SpatialAssembly::place_constrained_nodes(int j) {
  const Anchor& place = *constrained_place(plan_, j);
  const bool first = &place == &plan_.joints[j][0];
  const PlannedBody& body = plan_.bodies[place.body];
  const Eigen::Matrix3d W = body.attitude * body.axes.transpose();
  std::vector<PlacedJoint> all;
  for (const ConstrainedNode& one : constrained_nodes_.at(j)) {
    PlacedJoint piece;
    for (const int dof : one.dofs)
      if (dof < 3)
        piece.constraint.rows.emplace_back(std::in_place_type<dynamics::Along>, dynamics::Along{dof});
      else
        piece.constraint.rows.emplace_back(std::in_place_type<dynamics::Product>,
                                           dynamics::Product{(dof + 2) % 3, (dof + 1) % 3});
    if (owner_) {
      SpatialMarker node = slots_[place.body].corotated->place(one.node),
                    other = marker(plan_.joints[j][first ? 1 : 0]);
      if (std::isnan(other.x0.x())) other.x0.setZero();  // the ground
      const dynamics::SpatialPose at = start_of(node), from = start_of(other);
      other.x0 += from.A.transpose() * (at.p - from.p);
      node.D0 = node.D0 * at.D.transpose() * W, other.D0 = other.D0 * from.D.transpose() * W;
      piece.places = {std::move(other), std::move(node)};
    }
    all.push_back(std::move(piece));
  }
  return all;
}

void SpatialAssembly::add_corotated(int b) {
  const PlannedBody& body = plan_.bodies[b];
  coordinates_.belongs_to("body " + body.spec.name);
  slots_[b].corotated = std::make_unique<reference::CorotationalBody>(
      coordinates_, body.structure, visited(b), clamped_edges(b),
      reference::CorotationalStart{body.place, body.attitude, body.rate, body.spin, body.deformation,
                                   body.deformation_rate},
      sees_);
}

std::vector<std::pair<SpatialMarker, double>> SpatialAssembly::corotated_parts(const Anchor& place) const {
  const reference::CorotationalBody& body = *slots_[place.body].corotated;
  const bool by_arm =
      std::any_of(place.averaging_weights.begin(), place.averaging_weights.end(),
                  [](const AveragingWeight& weight) { return !(weight.arm + math::skew(weight.lead)).isZero(0); });
  if (place.nodes.size() == 1 && body.has_frame(place.nodes.front()) && !by_arm)
    return {{body.place(place.nodes.front()), 1.}};
  std::vector<std::pair<SpatialMarker, double>> parts;
  int piece = -1;
  bool one = place.nodes.size() > 1;
  for (const AveragingWeight& weight : place.averaging_weights) {
    if (!has_weight(weight) && weight.apart == 0) continue;
    const int other = body.piece_of(weight.node);
    one = one && other >= 0 && (parts.empty() || other == piece);
    piece = other;
    SpatialMarker at = body.place(weight.node);
    at.mass = weight.share;
    at.x0 = weight.share * at.x0 + arm_of(weight);
    parts.emplace_back(std::move(at), weight.share + weight.apart);
  }
  if (one) return {{body.place_on_piece(piece, place.x), 1.}};
  return parts;
}

std::unique_ptr<dynamics::Term> SpatialAssembly::corotated_pressure(const Load& load, int b,
                                                                    const std::function<double(double)>& value,
                                                                    const fem::Mesh::Cell& cell) const {
  const PlannedBody& body = plan_.bodies[b];
  std::vector<Vector3d> undeformed;  // world axes
  if (!load.follower)
    for (const int place : cell.places()) undeformed.emplace_back(body.attitude * body.structure.mesh.positions[place]);
  return std::make_unique<reference::SurfacePressure>(slots_[b].corotated->places(cell), fem::surface_shapes(cell.kind),
                                                      value, undeformed);
}

}  // namespace floe::assembly
