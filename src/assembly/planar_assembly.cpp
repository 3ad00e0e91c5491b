#include "planar_assembly.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/damping.h"
#include "floe/dynamics/floating_body.h"
#include "floe/petsc/values.h"
#include "floe/plan/mesh_copy.h"
#include "floe/plan/weight.h"
#include "floe/reference/corotational_beam.h"
#include "floe/solve/start.h"
#include "planar_redundant.h"

namespace floe::assembly {

using dynamics::Marker;

namespace {

std::vector<PetscInt> visited_nodes(const Plan& plan, int body) {
  std::vector<PetscInt> nodes;
  auto visit = [&](const Anchor& place) {
    if (place.body == body) nodes.push_back(place.node);
  };
  for (const auto& joint : plan.joints) visit(joint[0]), visit(joint[1]);
  for (std::size_t l = 0; l < plan.loads.size(); ++l)
    if (!plan.scene.loads[l].spread()) visit(plan.loads[l]);
  for (std::size_t p = 0; p < plan.probes.size(); ++p) {
    visit(plan.probes[p][0]), visit(plan.probes[p][1]);
    if (plan.scene.probes[p].quantity == Probe::Quantity::deflection && plan.probes[p][0].body == body)
      for (const Anchor& place : plan.bodies[body].frame_places) nodes.push_back(place.node);
    for (const Anchor& place : plan.probe_frames[p]) visit(place);
  }
  return nodes;
}

}  // namespace

Eigen::Vector2d undeformed_place(const PlannedBody& body, const Eigen::Vector3d& x) {
  return body.pose.head<2>() + rotation_matrix(body.pose[2]) * x.head<2>();
}

PlanarAssembly::PlanarAssembly(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced)
    : plan_(plan),
      formulation_(formulation),
      reduced_(reduced),
      owner_(last_rank(comm_of(plan, formulation))),
      sees_(owner_ || has_spread_state_loads(plan.scene)),
      coordinates_(comm_of(plan, formulation)),
      slots_(plan.bodies.size()),
      switches_(switches_of(plan.scene)) {}

bool PlanarAssembly::compact(int body) const {
  const Body& spec = plan_.bodies[body].spec;
  return is_reduced(formulation_) || spec.rigid || spec.reduced;
}

void PlanarAssembly::add_coordinates() {
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PlannedBody& body = plan_.bodies[b];
    Slot& slot = slots_[b];
    const int index = static_cast<int>(b);
    coordinates_.belongs_to("body " + body.spec.name);
    if (compact(index) || formulation_ != Formulation::cfr) {
      slot.frame = coordinates_.add_shared(3);
      coordinates_.add_angle(slot.frame + 2, true);
    }
    if (compact(index)) {
      slot.elastic = coordinates_.add_shared(reduced_[b].body.coordinates());
      continue;
    }
    slot.nodes = std::make_unique<reference::NodeCoordinates>(coordinates_, body.structure.mesh,
                                                              visited_nodes(plan_, index), 3, sees_);
    if (formulation_ == Formulation::cfr)
      for (PetscInt node = 0; node < body.structure.mesh.owned_nodes; ++node)
        coordinates_.add_angle(slot.nodes->first() + 3 * static_cast<int>(node) + 2, false);
    if (formulation_ != Formulation::cfr && body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
      slot.multipliers = coordinates_.add_shared(3, true);
    if (formulation_ == Formulation::cfr) continue;
    slot.damping = full_order_damping(plan_, index, body.frame.conditions, coordinates_);
    slot.modal = full_order_modal_damping(plan_, index, body.frame.conditions, coordinates_);
  }
  for (const WholeModes& modes : plan_.whole_modes)
    modal_wholes_.emplace_back(plan_, modes, !compact(modes.bodies.front()), coordinates_);
  add_damping_axes();
  add_body_axes();
  joint_rows_ = independent_rows(plan_, reduced_, switches_, undetermined_, notes_);
  for (std::size_t j = 0; j < joint_rows_.size(); ++j) {
    coordinates_.belongs_to("joint " + plan_.scene.joints[j].name);
    joint_multipliers_.push_back(coordinates_.add_shared(static_cast<int>(joint_rows_[j].size()), true));
  }
  for (auto& [joint, switches] : switches_) {
    if (!switches.lock) continue;
    switches.rows = 1;  // a hinge leaves an angle, a slide a distance
    switches.first_row = coordinates_.add_shared(switches.rows, true);
  }
  coordinates_.number();
}

void PlanarAssembly::add_body_terms(int b) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  const DampingSpec& damping = body.spec.damping;
  if (compact(b)) {
    std::vector<int> coordinates;
    const int k = reduced_[b].body.coordinates();
    for (int i = 0; i < 3; ++i) coordinates.push_back(slot.frame + i);
    for (int i = 0; i < k; ++i) coordinates.push_back(slot.elastic + i);
    auto dampers = damping_terms(plan_, b, reduced_[b], {coordinates.begin() + 3, coordinates.end()});
    if (!owner_) return;
    terms_.push_back(std::make_unique<dynamics::FloatingBody>(coordinates, body::planar(reduced_[b].body.inertia),
                                                              reduced_[b].body.elasticity));
    std::move(dampers.begin(), dampers.end(), std::back_inserter(terms_));
    return;
  }
  if (formulation_ != Formulation::cfr) {
    auto more = reference::full_order_terms(
        body.structure, body.frame, *slot.nodes, slot.frame, slot.multipliers,
        formulation_ == Formulation::lffr ? reference::ElasticForce::linear : reference::ElasticForce::von_karman,
        damping.stiffness);
    if (slot.damping)
      for (auto& term : reference::mass_damping_terms(body.structure, *slot.damping, *slot.nodes))
        more.push_back(std::move(term));
    if (slot.modal)
      for (auto& term : reference::modal_damping_terms(body.structure, *slot.modal, *slot.nodes))
        more.push_back(std::move(term));
    for (auto& term : more) terms_.push_back(std::move(term));
    return;
  }
  add_corotational(b);
}

/// Elements with their inertia and weight.
void PlanarAssembly::add_corotational(int b, const BodyPart* part) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  const fem::Structure& s = body.structure;
  const Weight weight(plan_.scene);
  const Eigen::Vector2d gravity = weight.constant() ? Eigen::Vector2d(weight(0).head<2>()) : Eigen::Vector2d::Zero();
  for (std::size_t c = 0; c < s.mesh.cells.size(); ++c) {
    if (part && !part->cells[c]) continue;
    const fem::Mesh::Cell& cell = s.mesh.cells[c];
    std::vector<int> coordinates;
    for (int node : cell.nodes())
      for (int d = 0; d < 3; ++d) coordinates.push_back(slot.nodes->of_local_node(node) + d);
    const fem::BeamSection& section = std::get<fem::BeamSection>(s.sections[cell.part]);
    auto beam = std::make_unique<reference::CorotationalBeam>(
        coordinates, undeformed_place(body, s.mesh.positions[cell.place[0]]),
        undeformed_place(body, s.mesh.positions[cell.place[1]]),
        reference::CorotationalBeam::Properties{section.EA, section.EI, section.rhoA, section.rhoI,
                                                body.spec.damping.stiffness, section.GA},
        gravity);
    if (!weight.constant())
      beam->changing_gravity = [weight](double t) -> Eigen::Vector2d { return weight(t).head<2>(); };
    terms_.push_back(std::move(beam));
  }
}

Marker PlanarAssembly::density(int b, const body::Inertia& inertia) {
  Marker marker;
  const body::PlanarInertia in = body::planar(inertia);
  marker.framed = true;
  for (int i = 0; i < 3; ++i) marker.coordinates.push_back(slots_[b].frame + i);
  for (Eigen::Index i = 0; i < in.S.cols(); ++i) marker.coordinates.push_back(slots_[b].elastic + static_cast<int>(i));
  marker.mass = in.m;
  marker.x = in.s0;
  marker.S = in.S, marker.Q = in.Q;
  marker.psi = Eigen::RowVectorXd::Zero(in.S.cols());
  return marker;
}

void PlanarAssembly::add_gravity(int b, const BodyPart* part) {
  const Weight weight(plan_.scene);
  if (weight.none()) return;
  const Slot& slot = slots_[b];
  std::vector<Marker> markers;
  if (compact(b)) {
    if (owner_) markers.push_back(density(b, part ? part->masses.mass : reduced_[b].body.inertia));
  } else if (formulation_ != Formulation::cfr) {
    markers = reference::density_markers(plan_.bodies[b].structure, plan_.bodies[b].frame.conditions, *slot.nodes,
                                         slot.frame, reference::Density::mass, part ? &part->cells : nullptr);
  }
  for (Marker& marker : markers) {
    auto force = std::make_unique<dynamics::Force>(
        std::move(marker), [weight](double t) { return weight(t); }, dynamics::Force::Axes::world);
    force->conservative = weight.constant();
    terms_.push_back(std::move(force));
  }
}

Marker PlanarAssembly::marker(const Anchor& place) {
  if (place.body < 0) return Marker::ground(place.x.head<2>());
  const PlannedBody& body = plan_.bodies[place.body];
  const Slot& slot = slots_[place.body];
  if (compact(place.body)) {
    const body::PlaceMap map = place_map(plan_, reduced_[place.body], place);
    Marker at;
    at.framed = true;
    for (int i = 0; i < 3; ++i) at.coordinates.push_back(slot.frame + i);
    for (Eigen::Index i = 0; i < map.S.cols(); ++i) at.coordinates.push_back(slot.elastic + static_cast<int>(i));
    at.x = map.x.head<2>();
    if (body.spec.rigid) at.x = place.x.head<2>();
    at.S = map.S;
    at.psi = map.psi;
    return at;
  }
  if (!sees_) return Marker::ground(Eigen::Vector2d::Zero());  // its term lives on the last rank
  const bool corotational = formulation_ == Formulation::cfr;
  Marker at = reference::node_marker(corotational ? fem::Conditions{} : body.frame.conditions, *slot.nodes, slot.frame,
                                     place.node, place.x);
  if (corotational) {
    at.framed = false;
    at.coordinates.erase(at.coordinates.begin(), at.coordinates.begin() + 3);
    at.x = undeformed_place(body, place.x);
    at.angle0 = body.pose[2];
  }
  return at;
}

Eigen::Vector3d PlanarAssembly::pose_at(const Marker& marker, const Eigen::VectorXd& q) const {
  Eigen::VectorXd own(static_cast<Eigen::Index>(marker.coordinates.size()));
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = q[marker.coordinates[i]];
  dynamics::Pose at;
  dynamics::pose(marker, own, Eigen::VectorXd::Zero(own.size()), Eigen::VectorXd::Zero(own.size()), at);
  return at.y;
}

Model PlanarAssembly::model() {
  Model model;
  model.formulation = formulation_;
  if (plan_.extent > 0) model.extent = plan_.extent;
  add_coordinates();
  model.warnings = notes_;
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const std::size_t before = terms_.size();
    add_body_terms(static_cast<int>(b));
    auto& own = body_terms_.emplace_back();
    for (std::size_t i = before; i < terms_.size(); ++i) own.push_back(terms_[i].get());
    add_gravity(static_cast<int>(b));
    BodyReport report = reduced_[b].report;
    const fem::Mesh& mesh = plan_.bodies[b].structure.mesh;
    report.name = plan_.bodies[b].spec.name, report.whole = whole_name(plan_.bodies[b].spec);
    report.rigid = plan_.bodies[b].spec.rigid;
    if (!plan_.bodies[b].spec.reduced) {
      report.nodes = mesh.node_count, report.elements = mesh.cell_count;
      report.dofs = plan_.bodies[b].structure.dofs();
    }
    report.first_coordinate = slots_[b].frame, report.first_elastic = slots_[b].elastic;
    report.frame = name_of(plan_.bodies[b].frame.kind);
    if (slots_[b].nodes) report.first_dof = slots_[b].nodes->first();
    report.first_node = mesh.first_node;
    report.mesh = body_mesh(plan_.bodies[b]);
    report.place << plan_.bodies[b].pose.head<2>(), 0;
    report.axes.topLeftCorner<2, 2>() = rotation_matrix(plan_.bodies[b].pose[2]);
    for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
      report.positions.insert(report.positions.end(), {mesh.positions[i].x(), mesh.positions[i].y()});
    model.bodies.push_back(std::move(report));
  }
  set_start(model);
  start_body_axes(model);
  for (const DampedWhole& whole : damped_) add_damping(whole, model);
  for (const WholeDamping& whole : modal_wholes_)
    std::ranges::move(whole.terms(
                          [&](int b) {
                            return PieceUnknowns{compact(b) ? &reduced_[b] : nullptr, slots_[b].elastic,
                                                 slots_[b].nodes.get(), &plan_.bodies[b].frame.conditions};
                          },
                          owner_),
                      std::back_inserter(terms_));
  Eigen::VectorXd q;
  {
    const dynamics::System layout(coordinates_, {});
    layout.gather(model.U, q);
  }
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) add_load(l);
  add_joints(model, q);
  add_probes(model, q);
  add_state_loads(model, q);
  for (std::size_t p = 0; p < plan_.probes.size(); ++p)
    if (plan_.scene.probes[p].of_section()) model.probes[p].sections = sections(p, model);
  for (std::size_t j = 0; j < joint_rows_.size(); ++j) model.joints.push_back({joint_multipliers_[j], joint_rows_[j]});
  for (const DampedWhole& whole : damped_)
    if (!whole.fixed) model.joints.push_back(unknowns_of(whole));
  for (const auto& [b, axes] : body_axes_) model.joints.push_back(unknowns_of(axes));
  model.switches = switches_;
  model.multipliers = coordinates_.multiplier_count();
  model.coordinates = coordinates_.global_size() - model.multipliers;
  model.system = std::make_unique<dynamics::System>(std::move(coordinates_), std::move(terms_));
  return model;
}

}  // namespace floe::assembly
