#include "spatial_assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "drive.h"
#include "floe/assembly/body_stage.h"
#include "floe/assembly/damping.h"
#include "floe/dynamics/damping.h"
#include "floe/dynamics/fixed_frame_body.h"
#include "floe/fem/element_count.h"
#include "floe/math/rotation.h"
#include "floe/petsc/values.h"
#include "floe/plan/mesh_copy.h"
#include "floe/plan/reduced_place.h"
#include "floe/scene/file_places.h"
#include "floe/scene/joint_events.h"
#include "floe/solve/start.h"
#include "spatial_rows.h"
#include "start_shape.h"

namespace floe::assembly {

using petsc::check;

namespace {

Eigen::Matrix3d attitude_of_mesh(const Body& body) {
  const Point& r = body.initial.rotation;
  return math::rotation({r[0], r[1], r[2]});
}

/// Where a point of the undeformed mesh is at the start.
Eigen::Vector3d start_of_mesh(const Body& body, const Eigen::Vector3d& x) {
  const Point& p = body.initial.position;
  return Eigen::Vector3d(p[0], p[1], p[2]) + attitude_of_mesh(body) * x;
}

}  // namespace

SpatialAssembly::SpatialAssembly(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced,
                                 bool apart)
    : plan_(plan),
      formulation_(formulation),
      reduced_(reduced),
      owner_(last_rank(comm_of(plan, formulation))),
      sees_(owner_ || has_spread_state_loads(plan.scene)),
      apart_(apart),
      coordinates_(comm_of(plan, formulation)),
      slots_(plan.bodies.size()),
      switches_(switches_of(plan.scene)) {
  for (std::size_t b = 0; b < slots_.size(); ++b)
    slots_[b].still = !corotated(static_cast<int>(b)) && has_fixed_frame(plan, owner_of_frame(b));
}

int SpatialAssembly::owner_of_frame(std::size_t body) const {
  const int parent = plan_.bodies[body].parent;
  return parent >= 0 && !corotated(static_cast<int>(body)) ? parent : static_cast<int>(body);
}

bool SpatialAssembly::compact(int body) const {
  const Body& spec = plan_.bodies[body].spec;
  return is_reduced(formulation_) || spec.rigid || spec.reduced;
}

bool SpatialAssembly::corotated(int body) const { return formulation_ == Formulation::cfr && !compact(body); }

bool SpatialAssembly::stands(int j) const {
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    if (plan_.bodies[b].parent_joint == j && !corotated(static_cast<int>(b))) return true;
    if (slots_[b].still && clamp_of(plan_, static_cast<int>(b)) == j) return true;
  }
  const Joint& joint = plan_.scene.joints[j];
  const Anchor* place = constrained_place(plan_, j);
  if (!place || place->body < 0 || !slots_[place->body].still || !plan_.joint_constrained[j]) return false;
  if (is_reduced(formulation_) && !modes_satisfy_joints(plan_.bodies[place->body])) return false;
  return !is_drive(joint.kind) && !switches_.contains(joint.name);
}

const fem::Conditions& SpatialAssembly::constrained(int b) const {
  static const fem::Conditions none;
  if (slots_[b].released >= 0) return none;
  return slots_[b].still ? plan_.bodies[b].constrained : plan_.bodies[b].clamp;
}

void SpatialAssembly::refuse() const {
  std::vector<std::string> faults;
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const Joint& joint = plan_.scene.joints[j];
    if (is_reduced(formulation_) || !plan_.joint_constrained[j]) continue;
    const Anchor& place = *constrained_place(plan_, j);
    if (compact(place.body) || corotated(place.body) || place.nodes.size() < 2 || place.line ||
        slots_[place.body].still)
      continue;
    const fem::Conditions& constrained = plan_.bodies[place.body].clamp;
    if (std::all_of(place.nodes.begin(), place.nodes.end(), [&](PetscInt node) {
          return std::binary_search(constrained.begin(), constrained.end(), 6 * node + 5);
        }))
      continue;
    faults.push_back(fmt::format(
        "{}: fixes {} nodes of body {}, which formulation {} supports only for a frame clamped to them; expected "
        "frame: {{type: clamped, at: ...}} at that place, or a place of one node",
        joint.where.text(), place.nodes.size(), plan_.bodies[place.body].spec.name, name_of(formulation_)));
  }
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PlannedBody& body = plan_.bodies[b];
    if (slots_[b].still && body.deformation &&
        ((body.place - start_of_mesh(body.spec, body.origin)).norm() > 1e-6 * plan_.extent ||
         (body.attitude - attitude_of_mesh(body.spec) * body.axes).norm() > 1e-6))
      faults.push_back(
          fmt::format("{}.deformation: displaces or rotates body {} where the ground clamps it; expected neither there",
                      body.spec.initial.where.text(), body.spec.name));
    double rates = 0;  // of the deformation at the start [m/s or rad/s]
    if (body.deformation_rate) check(VecNorm(body.deformation_rate, NORM_INFINITY, &rates));
    if (slots_[b].still && body.parent < 0 &&
        std::max(body.rate.norm(), plan_.extent * body.spin.norm()) > 1e-6 * rates)
      faults.push_back(fmt::format("{}: gives a velocity to body {}, which is clamped to the ground; expected none",
                                   body.spec.initial.where.text(), body.spec.name));
  }
  if (!faults.empty()) throw InputError(faults);
}

std::vector<PetscInt> SpatialAssembly::visited(int body) const {
  std::vector<PetscInt> nodes;
  const auto visit = [&](const Anchor& place) {
    for (const AveragingWeight& weight : place.averaging_weights)
      if (place.body == body) nodes.push_back(weight.node);
  };
  for (const auto& joint : plan_.joints) visit(joint[0]), visit(joint[1]);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l)
    if (!plan_.scene.loads[l].spread()) visit(plan_.loads[l]);
  for (const auto& probe : plan_.probes) visit(probe[0]), visit(probe[1]);
  for (std::size_t p = 0; p < plan_.probes.size(); ++p)
    for (const Anchor& place : places_of_frame(p)) visit(place);
  return nodes;
}

std::vector<Anchor> SpatialAssembly::places_of_frame(std::size_t probe) const {
  std::vector<Anchor> places = plan_.probe_frames[probe];
  const int b = plan_.probes[probe][0].body;
  if (!places.empty() || plan_.scene.probes[probe].quantity != Probe::Quantity::deflection || b < 0 || !corotated(b))
    return places;
  const PlannedBody& body = plan_.bodies[b];
  for (Anchor place : body.frame_places) {
    if (place.averaging_weights.empty()) return {};  // none, or a frame by dofs of several places
    place.body = b, places.push_back(place);
  }
  return places;
}

void SpatialAssembly::add_frame(int b) {
  Slot& slot = slots_[b];
  if (slot.still || slot.attitude) return;
  const PlannedBody& body = plan_.bodies[b];
  coordinates_.belongs_to("body " + body.spec.name);
  slot.frame = coordinates_.add_shared(6);
  slot.attitude = std::make_shared<dynamics::Attitude>();
  slot.attitude->base = Eigen::Quaterniond(body.attitude).normalized();
}

void SpatialAssembly::add_coordinates() {
  find_constrained_nodes();
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PlannedBody& body = plan_.bodies[b];
    Slot& slot = slots_[b];
    const int index = static_cast<int>(b);
    if (corotated(index)) {
      add_corotated(index);
      continue;
    }
    add_frame(owner_of_frame(b));
    slot.frame = slots_[owner_of_frame(b)].frame, slot.attitude = slots_[owner_of_frame(b)].attitude;
    coordinates_.belongs_to("body " + body.spec.name);
    if (compact(index)) {
      slot.elastic = coordinates_.add_shared(reduced_[b].body.coordinates());
      continue;
    }
    slot.nodes =
        std::make_unique<reference::NodeCoordinates>(coordinates_, body.structure.mesh, visited(index), 6, sees_);
    if (!slot.still && body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
      slot.multipliers = coordinates_.add_shared(6, true);
    slot.damping = full_order_damping(plan_, index, constrained(index), coordinates_);
    slot.modal = full_order_modal_damping(plan_, index, constrained(index), coordinates_);
  }
  for (const WholeModes& modes : plan_.whole_modes)
    modal_wholes_.emplace_back(plan_, modes, !compact(modes.bodies.front()), coordinates_);
  add_damping_axes();
  add_corotated_axes();
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    coordinates_.belongs_to("joint " + plan_.scene.joints[j].name);
    const int rows = row_count(static_cast<int>(j));
    multipliers_.push_back(coordinates_.add_shared(rows, true));
    const auto switches = switches_.find(plan_.scene.joints[j].name);
    if (switches == switches_.end() || !switches->second.lock) continue;
    switches->second.rows = 6 - rows;
    switches->second.first_row = coordinates_.add_shared(6 - rows, true);
  }
  coordinates_.number();
}

std::vector<int> SpatialAssembly::coordinates_of(int b) const {
  std::vector<int> all;
  for (int i = 0; i < 6 && !slots_[b].still; ++i) all.push_back(slots_[b].frame + i);
  const Slot& slot = slots_[b];
  const int k = reduced_[b].body.coordinates(), own = slot.released < 0 ? k : slot.kept;
  for (int i = 0; i < k; ++i) all.push_back(i < own ? slot.elastic + i : slot.released + i - own);
  return all;
}

reference::SpatialFrame SpatialAssembly::frame_of(int b) const {
  return {slots_[b].frame, slots_[b].multipliers, slots_[b].attitude};
}

void SpatialAssembly::add_body(int b) {
  const PlannedBody& body = plan_.bodies[b];
  const Slot& slot = slots_[b];
  if (compact(b)) {
    const ReducedBody& reduced = reduced_[b];
    const std::vector<int> coordinates = coordinates_of(b);
    auto damping =
        damping_terms(plan_, b, reduced, {coordinates.end() - reduced.body.coordinates(), coordinates.end()});
    if (!owner_) return;
    body::SpatialInertia inertia = body::spatial(reduced.body.inertia);
    inertia.Q.factor();
    if (slot.still && reduced.body.coordinates() > 0)
      terms_.push_back(std::make_unique<dynamics::FixedFrameBody>(coordinates, inertia.M, reduced.body.elasticity));
    if (!slot.still)
      terms_.push_back(std::make_unique<dynamics::SpatialBody>(coordinates, slot.attitude, std::move(inertia),
                                                               reduced.body.elasticity));
    std::move(damping.begin(), damping.end(), std::back_inserter(terms_));
    return;
  }
  if (slot.corotated) {
    for (auto& term : slot.corotated->terms(body.spec.damping.stiffness)) terms_.push_back(std::move(term));
    return;
  }
  if (slot.damping)
    for (auto& term : reference::mass_damping_terms(body.structure, *slot.damping, *slot.nodes))
      terms_.push_back(std::move(term));
  if (slot.modal)
    for (auto& term : reference::modal_damping_terms(body.structure, *slot.modal, *slot.nodes))
      terms_.push_back(std::move(term));
  const auto force =
      formulation_ == Formulation::lffr ? reference::ElasticForce::linear : reference::ElasticForce::von_karman;
  const auto elements = std::make_shared<reference::SpatialElements>(
      body.structure, body.frame, constrained(b), *slot.nodes, frame_of(b), force, body.spec.damping.stiffness);
  for (auto& term : apart_ ? elements->constraints(1) : elements->all()) terms_.push_back(std::move(term));
  if (apart_) elements_.push_back(elements);
}

/// What the body's deformation at the start makes of its elastic coordinates; those that are constrained stay zero.
void SpatialAssembly::set_deformation(int b, Vec shape, Vec into) const {
  if (!shape) return;
  const PlannedBody& body = plan_.bodies[b];
  const auto set = [&](PetscInt row, double value) { check(VecSetValue(into, row, value, INSERT_VALUES)); };
  if (compact(b)) {
    Eigen::VectorXd eta = Eigen::VectorXd::Zero(reduced_[b].body.coordinates());
    if (shape == body.deformation.get())
      eta = start_shape(plan_, b, reduced_[b], shape);
    else if (eta.size() > 0)
      check(BVDotVec(reduced_[b].basis->V, shape, eta.data()));
    for (Eigen::Index i = 0; i < eta.size() && owner_; ++i)
      set(coordinates_.global()[slots_[b].elastic + static_cast<int>(i)], eta[i]);
    return;
  }
  petsc::Values own(shape);
  const fem::Mesh& mesh = body.structure.mesh;
  for (PetscInt dof = own.first; dof < own.end; ++dof) {
    if (std::binary_search(constrained(b).begin(), constrained(b).end(), dof)) continue;
    const int local = static_cast<int>(dof - 6 * mesh.first_node);
    set(coordinates_.global()[slots_[b].nodes->of_local_node(local / 6) + local % 6], own[dof]);
  }
}

void SpatialAssembly::set_start(Model& model) {
  const dynamics::System layout(coordinates_, {});
  model.U = layout.create_vector();
  model.V = layout.create_vector();
  for (const WholeDamping& whole : modal_wholes_) whole.set_start(coordinates_, owner_, model.U, model.V);
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PlannedBody& body = plan_.bodies[b];
    if (slots_[b].corotated) {
      slots_[b].corotated->set_start(coordinates_.global(), model.U, model.V);
      continue;
    }
    set_deformation(static_cast<int>(b), body.deformation, model.U);
    set_deformation(static_cast<int>(b), body.deformation_rate, model.V);
    if (slots_[b].modal) set_modal_coordinates(*slots_[b].modal, body, coordinates_, owner_, model.U, model.V);
    if (slots_[b].damping) set_rigid_part(*slots_[b].damping, body, coordinates_, owner_, model.U, model.V);
  }
  for (std::size_t b = 0; b < slots_.size() && owner_; ++b) {
    const PlannedBody& body = plan_.bodies[b];
    if (slots_[b].still || slots_[b].corotated || body.parent >= 0) continue;
    for (int i = 0; i < 3; ++i) {
      const PetscInt row = coordinates_.global()[slots_[b].frame + i],
                     rotation = coordinates_.global()[slots_[b].frame + 3 + i];
      check(VecSetValue(model.U, row, body.place[i], INSERT_VALUES));
      check(VecSetValue(model.V, row, body.rate[i], INSERT_VALUES));
      check(VecSetValue(model.V, rotation, body.spin[i], INSERT_VALUES));
    }
  }
  for (const DampedWhole& whole : damped_)
    for (int i = 0; i < 3 && owner_ && !whole.fixed; ++i)
      check(VecSetValue(model.U, coordinates_.global()[whole.f.position + i],
                        plan_.bodies[whole.bodies.front()].spec.initial.position[i], INSERT_VALUES));
  for (const auto& [b, axes] : body_axes_)
    for (int i = 0; i < 3 && owner_; ++i)
      check(VecSetValue(model.U, coordinates_.global()[axes.f.position + i], mesh_axes_at_start(plan_.bodies[b]).R[i],
                        INSERT_VALUES));
  for (Vec v : {model.U.get(), model.V.get()}) {
    check(VecAssemblyBegin(v));
    check(VecAssemblyEnd(v));
  }
  layout.gather(model.U, start_);
}

Model SpatialAssembly::model() {
  refuse();
  Model model;
  model.formulation = formulation_;
  if (plan_.extent > 0) model.extent = plan_.extent;
  add_coordinates();
  set_start(model);
  start_corotated_axes(model);
  for (const DampedWhole& whole : damped_) add_damping(whole, model);
  for (const WholeDamping& whole : modal_wholes_)
    std::ranges::move(whole.terms(
                          [&](int b) {
                            return PieceUnknowns{compact(b) ? &reduced_[b] : nullptr, slots_[b].elastic,
                                                 slots_[b].nodes.get(), &constrained(b)};
                          },
                          owner_),
                      std::back_inserter(terms_));
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const int index = static_cast<int>(b);
    const PlannedBody& body = plan_.bodies[b];
    const std::size_t before = terms_.size();
    add_body(index);
    auto& own = body_terms_.emplace_back();
    for (std::size_t i = before; i < terms_.size(); ++i) own.push_back(terms_[i].get());
    add_gravity(index);
    BodyReport report = reduced_[b].report;
    const fem::Mesh& mesh = body.structure.mesh;
    report.name = body.spec.name, report.whole = whole_name(body.spec);
    report.rigid = body.spec.rigid;
    if (!body.spec.reduced)
      report.nodes = mesh.node_count, report.elements = fem::element_count(mesh), report.dofs = body.structure.dofs();
    report.dimension = 3;
    if (is_meshed(body.spec)) report.strains = body.strains;
    report.first_coordinate = slots_[b].frame, report.first_elastic = slots_[b].elastic;
    report.frame = name_of(plan_.bodies[b].frame.kind);
    if (slots_[b].nodes) report.first_dof = slots_[b].nodes->first();
    if (slots_[b].corotated) {
      report.first_dof = slots_[b].corotated->nodes().first();
      report.frame = "of every element";
    }
    report.attitude = slots_[b].attitude;
    report.mesh = body_mesh(body);
    report.place = plan_.bodies[owner_of_frame(index)].place;
    report.axes = plan_.bodies[owner_of_frame(index)].attitude;
    report.first_node = mesh.first_node;
    for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
      report.positions.insert(report.positions.end(), mesh.positions[i].data(), mesh.positions[i].data() + 3);
    model.bodies.push_back(std::move(report));
    model.warnings.insert(model.warnings.end(), body.notices.begin(), body.notices.end());
  }
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) add_load(l);
  add_joints(model);
  add_probes(model);
  add_state_loads(model);
  for (std::size_t p = 0; p < plan_.probes.size(); ++p)
    if (plan_.scene.probes[p].of_section()) model.probes[p].sections = sections(p, model);
  add_held_reactions(model);
  dynamics::Attitudes attitudes;
  for (std::size_t b = 0; b < slots_.size(); ++b)
    if (slots_[b].corotated)
      slots_[b].corotated->add_attitudes(attitudes);
    else if (slots_[b].attitude && plan_.bodies[b].parent < 0)
      attitudes.emplace_back(slots_[b].frame + 3, slots_[b].attitude);
  attitudes.insert(attitudes.end(), axes_attitudes_.begin(), axes_attitudes_.end());
  for (std::size_t j = 0; j < multipliers_.size(); ++j) model.joints.push_back(multipliers_of(static_cast<int>(j)));
  for (const DampedWhole& whole : damped_)
    if (!whole.fixed) model.joints.push_back(unknowns_of(whole));
  for (const auto& [b, axes] : body_axes_) model.joints.push_back(unknowns_of(axes));
  for (const MeanAxes& mean : means_) model.joints.push_back(unknowns_of(mean.axes));
  model.switches = switches_;
  model.multipliers = coordinates_.multiplier_count();
  model.coordinates = coordinates_.global_size() - model.multipliers;
  model.system = std::make_unique<dynamics::System>(std::move(coordinates_), std::move(terms_), std::move(attitudes));
  model.elements = std::move(elements_);
  return model;
}

}  // namespace floe::assembly
