#include "held_reactions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "floe/assembly/body_stage.h"
#include "floe/dynamics/damping.h"
#include "floe/dynamics/fixed_frame_body.h"
#include "floe/dynamics/local_indices.h"
#include "floe/petsc/all_ranks.h"
#include "floe/petsc/values.h"
#include "floe/plan/hold_by_joint.h"
#include "floe/plan/prepare_spatial_joints.h"
#include "floe/reduction/statics.h"
#include "spatial_assembly.h"

namespace floe::assembly {

using dynamics::Wrench;
using petsc::check;

namespace {

Eigen::Vector3d position_of(const dynamics::SpatialMarker& marker, const Eigen::VectorXd& q) {
  Eigen::VectorXd own;
  dynamics::pick(marker.coordinates, q, own);
  dynamics::SpatialPose at;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(own.size());
  dynamics::pose(marker, own, none, none, at, dynamics::EvaluationLevel::position);
  return at.p;
}

/// The sum of what rows exert on nodes, about the mean of these.
Wrench on_nodes(const HeldReaction& reaction, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Wrench sum = Wrench::Zero();
  if (reaction.nodes.empty()) return sum;
  const Eigen::Vector3d centre = position_of(reaction.place, q);
  for (const HeldReaction::OnNode& on : reaction.nodes) {
    Wrench w = on.share * exerted({on.connection}, t, q, v);
    const Eigen::Vector3d f = w.head<3>();
    w.tail<3>() += (position_of(on.node, q) - centre).cross(f);
    sum += w;
  }
  return sum;
}

/// What a joint exerts on one side, about its place there: on the first the opposite force, on the same line.
Wrench on_side(const HeldReaction::Acting& acting, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Wrench w = exerted(acting.connections, t, q, v);
  if (acting.side == 1) return w;
  const Eigen::Vector3d f = w.head<3>();
  w.tail<3>() += (position_of(acting.second, q) - position_of(acting.first, q)).cross(f);
  return -w;
}

}  // namespace

Wrench held_by(const HeldReaction& reaction, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
               const Eigen::VectorXd& a) {
  Eigen::VectorXd all_q = Eigen::VectorXd::Zero(reaction.coordinates), all_v = all_q, all_a = all_q, sums = all_q;
  all_q.head(q.size()) = q, all_v.head(v.size()) = v, all_a.head(a.size()) = a;
  Eigen::VectorXd own, rate, second, r;
  const auto pick = [&](const std::vector<int>& coordinates) {
    dynamics::pick(coordinates, all_q, own), dynamics::pick(coordinates, all_v, rate);
    dynamics::pick(coordinates, all_a, second);
  };
  const auto add = [&](const std::vector<int>& coordinates, double factor) {
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      sums[coordinates[i]] += factor * r[static_cast<Eigen::Index>(i)];
  };
  for (const auto& term : reaction.terms) {
    pick(term->coordinates());
    r.setZero(own.size());
    term->residual({t, own, rate, second}, r);
    add(term->coordinates(), 1);
  }
  for (const HeldReaction::Acting& acting : reaction.others) {
    pick(acting.on_body.coordinates);
    dynamics::SpatialPose at;
    dynamics::pose(acting.on_body, own, rate, second, at);
    dynamics::pull_back(acting.on_body, at, on_side(acting, t, q, v), r);
    add(acting.on_body.coordinates, -1);
  }
  Wrench sum = Wrench::Zero();
  for (const HeldReaction::Row& row : reaction.rows) sum += sums[row.coordinate] * row.wrench;
  Wrench world;
  world << reaction.axes * sum.head<3>(), reaction.axes * sum.tail<3>();
  return reaction.sign * (world + on_nodes(reaction, t, q, v));
}

namespace {

/// A dof that a joint holds, and what a force or moment of size 1 on it is about the joint's place.
using HeldDofs = std::map<PetscInt, Wrench>;

fem::Conditions dofs_held_by(const Plan& plan, int j) {
  fem::Conditions dofs;
  hold_spatial_place_by_joint(plan, static_cast<std::size_t>(j), *constrained_place(plan, static_cast<std::size_t>(j)),
                              dofs);
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  return dofs;
}

std::vector<int> joints_holding(const Plan& plan, int body) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(plan.joints.size()); ++j)
    if (const Anchor* place = constrained_place(plan, static_cast<std::size_t>(j)); place && place->body == body)
      joints.push_back(j);
  return joints;
}

/// Dofs that several joints hold count for each of them in equal parts; what a clamp holds, for clamps alone.
/// Collective.
HeldDofs held_dofs(const Plan& plan, int j) {
  const Anchor& place = *constrained_place(plan, static_cast<std::size_t>(j));
  const auto clamp = [&](int joint) { return clamps(plan.scene.joints[static_cast<std::size_t>(joint)]); };
  std::map<PetscInt, int> uses, clamped;
  for (const int other : joints_holding(plan, place.body))
    for (const PetscInt dof : dofs_held_by(plan, other)) ++(clamp(other) ? clamped : uses)[dof];
  fem::Conditions dofs = dofs_held_by(plan, j);
  if (clamp(j))
    uses = std::move(clamped);
  else
    std::erase_if(dofs, [&](PetscInt dof) { return clamped.contains(dof); });
  std::vector<PetscInt> nodes;
  for (const PetscInt dof : dofs) nodes.push_back(dof / 6);
  const std::vector<Eigen::Vector3d> x = fem::positions_of(plan.bodies[place.body].structure.mesh, nodes);
  HeldDofs held;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(dofs[i] % 3);
    Wrench w = Wrench::Zero();
    if (dofs[i] % 6 < 3)
      w << e, (x[i] - place.x).cross(e);
    else
      w.tail<3>() = e;
    held[dofs[i]] = w / uses.at(dofs[i]);
  }
  return held;
}

/// The body on its basis and the static fields of the six motions of a joint's place, with the stresses of its elastic
/// force: condensed over the same displacements. These and the basis vanish where joints hold the body, so that the
/// fields are orthogonal to them in K and change nothing of the condensation. Collective.
ReducedBody with_fields(const PlannedBody& body, const ReducedBody& reduced, const HeldDofs& held) {
  const fem::Structure& structure = body.structure;
  reduction::Columns moved;
  for (int c = 0; c < 6; ++c) {
    moved.push_back(fem::field(structure));
    petsc::Values own(moved.back());
    for (const auto& [dof, wrench] : held)
      if (dof >= own.first && dof < own.end) own[dof] = wrench[c];
  }
  const reduction::Statics statics(structure, body.frame, fem::holding(structure, body.frame, body.constrained));
  const reduction::Columns fields = statics.displaced(moved);
  auto basis = std::make_shared<reduction::Basis>();
  const int k = reduced.body.coordinates();
  basis->columns = k + 6;
  check(BVCreate(structure.mesh.comm, basis->V.out()));
  check(BVSetSizesFromVec(basis->V, fields.front(), k + 6));
  check(BVSetFromOptions(basis->V));
  for (int i = 0; i < k; ++i) {
    Vec column = nullptr;
    check(BVGetColumn(reduced.basis->V, i, &column));
    check(BVInsertVec(basis->V, i, column));
    check(BVRestoreColumn(reduced.basis->V, i, &column));
  }
  for (int c = 0; c < 6; ++c) check(BVInsertVec(basis->V, k + c, fields[static_cast<std::size_t>(c)]));
  ReducedBody all;
  all.body = reduction::project(structure, *basis);
  all.basis = std::move(basis);
  all.relief.W = reduced.relief.W;
  if (body.spec.reduction.linear)
    all.body.elasticity = body::linearised(all.body.elasticity);
  else
    condense(body, all);
  return all;
}

/// Whether cells have one of the dofs.
std::vector<char> cells_at(const fem::Mesh& mesh, const HeldDofs& held) {
  std::vector<char> found;
  for (const fem::Mesh::Cell& cell : mesh.cells) {
    const auto nodes = cell.nodes();
    found.push_back(std::any_of(nodes.begin(), nodes.end(), [&](int node) {
      const auto first = held.lower_bound(6 * mesh.global_node(node));
      return first != held.end() && first->first < 6 * mesh.global_node(node) + 6;
    }));
  }
  return found;
}

/// Hinged edges that meet hold one rim together.
void refuse_rims(const Plan& plan, int j) {
  const Anchor& place = *constrained_place(plan, static_cast<std::size_t>(j));
  for (const int other : joints_holding(plan, place.body))
    if (const Anchor& there = *constrained_place(plan, static_cast<std::size_t>(other));
        other != j && place.line && there.line && there.node == place.node)
      throw InputError(
          fmt::format("{}: joints {} and {} hinge edges that meet, whose reactions are those of one rim; "
                      "expected supports (type: support) in place of the hinges whose reactions are measured",
                      plan.scene.joints[j].where.text(), plan.scene.joints[j].name, plan.scene.joints[other].name));
}

}  // namespace

/// Inertia, strains and their viscosity; weight and loads. Of full-order bodies on `part` alone.
void SpatialAssembly::add_body_and_loads(int b, const BodyPart* part) {
  const PlannedBody& body = plan_.bodies[b];
  const double beta = body.spec.damping.stiffness;
  if (compact(b)) {
    const std::vector<int> coordinates = coordinates_of(b);
    const body::FlexibleBody& reduced = reduced_[b].body;
    const auto& M = reduced.inertia.M;
    if (owner_) {
      terms_.push_back(
          std::make_unique<dynamics::FixedFrameBody>(coordinates, M[0][0] + M[1][1] + M[2][2], reduced.elasticity));
      if (beta != 0)
        terms_.push_back(std::make_unique<dynamics::StrainRateDamping>(coordinates, reduced.elasticity, beta));
    }
  } else {
    const auto force =
        formulation_ == Formulation::lffr ? reference::ElasticForce::linear : reference::ElasticForce::von_karman;
    const reference::SpatialElements elements(body.structure, body.frame, constrained(b), *slots_[b].nodes, frame_of(b),
                                              force, beta);
    double stiffest = 0;
    for (std::size_t c = 0; c < elements.count(); ++c)
      if (part->cells[c]) std::ranges::move(elements.terms(c, stiffest), std::back_inserter(terms_));
  }
  add_gravity(b, part);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l)
    if (plan_.loads[l].body == b && plan_.scene.loads[l].joint.empty()) add_load(l, part);
}

std::shared_ptr<const HeldReaction> SpatialAssembly::reaction_of_nodes(int j) {
  auto reaction = std::make_shared<HeldReaction>();
  reaction->sign = plan_.scene.joints[j].second.ground() ? -1 : 1;
  reaction->coordinates = coordinates_.local_size();
  reaction->place = marker(*constrained_place(plan_, static_cast<std::size_t>(j)));
  for (const auto& [other, nodes] : constrained_nodes_) {
    const std::vector<PlacedJoint> pieces = place_constrained_nodes(other);
    const auto found = connections_.find(static_cast<std::size_t>(other));
    if (found == connections_.end() || nodes.empty()) continue;
    const std::size_t each = found->second.size() / nodes.size();  // rows, and what locks them again
    for (std::size_t i = 0; i < found->second.size(); ++i) {
      const ConstrainedNode& one = nodes[i / each];
      if (std::find(one.joints.begin(), one.joints.end(), j) == one.joints.end()) continue;
      reaction->nodes.push_back(
          {found->second[i], pieces[i / each].places[1], 1. / static_cast<double>(one.joints.size())});
    }
  }
  return reaction;
}

std::shared_ptr<const HeldReaction> SpatialAssembly::held_reaction(int j) {
  if (constrained_nodes_.contains(j)) return reaction_of_nodes(j);
  const Anchor* place = constrained_place(plan_, static_cast<std::size_t>(j));
  if (!place || place->body < 0 || !slots_[place->body].still || !is_meshed(plan_.bodies[place->body].spec))
    return nullptr;
  const int b = place->body;
  const PlannedBody& body = plan_.bodies[b];
  refuse_rims(plan_, j);
  const HeldDofs held = held_dofs(plan_, j);
  auto reaction = std::make_shared<HeldReaction>();
  reaction->axes = body.attitude;
  reaction->sign = plan_.scene.joints[j].second.ground() ? -1 : 1;
  reaction->coordinates = coordinates_.local_size() + (compact(b) ? 6 : 0);

  Slot& slot = slots_[b];
  const std::span<const ReducedBody> own = reduced_;
  std::vector<ReducedBody> released;
  BodyPart part;
  slot.released = coordinates_.local_size();
  if (compact(b)) {
    released.assign(own.begin(), own.end());
    released[b] = with_fields(body, own[b], held);
    slot.kept = own[b].body.coordinates();
    reduced_ = released;
    for (int c = 0; c < 6 && owner_; ++c) reaction->rows.push_back({slot.released + c, Wrench::Unit(c)});
  } else {
    part.cells = cells_at(body.structure.mesh, held);
    for (const auto& [dof, wrench] : held)
      if (slot.nodes->sees(dof / 6))
        reaction->rows.push_back({slot.nodes->of_node(dof / 6) + static_cast<int>(dof % 6), wrench});
  }
  auto terms = std::exchange(terms_, {});
  const auto loads = load_terms_;
  add_body_and_loads(b, compact(b) ? nullptr : &part);
  load_terms_ = loads;
  std::swap(terms, terms_);
  std::ranges::move(terms, std::back_inserter(reaction->terms));
  for (const auto& [other, connections] : connections_)
    for (const int side : {0, 1})
      if (plan_.joints[other][side].body == b)
        reaction->others.push_back(
            {connections, side, placed_[other].places[0], placed_[other].places[1], marker(plan_.joints[other][side])});
  slot.released = -1;
  reduced_ = own;
  return reaction;
}

void SpatialAssembly::add_held_reactions(Model& model) {
  std::map<int, std::shared_ptr<const HeldReaction>> found;  // force and moment of a joint have one
  for (std::size_t p = 0; p < plan_.probes.size(); ++p) {
    const Probe& probe = plan_.scene.probes[p];
    if (probe.quantity != Probe::Quantity::force && probe.quantity != Probe::Quantity::moment) continue;
    const int j = static_cast<int>(joint_index(plan_.scene, probe.joint));
    const auto [at, first] = found.try_emplace(j);
    if (first) at->second = held_reaction(j);
    const auto& held = model.probes[p].held = at->second;
    if (!held) continue;
    if (!held->nodes.empty()) model.probes[p].connections.clear();
    const Anchor* place = constrained_place(plan_, static_cast<std::size_t>(j));
    const DampingSpec& damping = plan_.bodies[place->body].spec.damping;
    if (first && !constrained_nodes_.contains(j) && (damping.mass != 0 || !damping.modal.empty()))
      model.warnings.push_back(
          fmt::format("joint {}: its reaction is without the forces of damping.mass and "
                      "damping.modal of body {}",
                      probe.joint, plan_.bodies[place->body].spec.name));
  }
}

}  // namespace floe::assembly
