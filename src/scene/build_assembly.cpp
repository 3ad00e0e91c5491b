#include "build_assembly.h"

#include <fmt/format.h>

#include <cmath>

#include "build_redundant.h"
#include "floe/dynamics/floating_body.h"
#include "floe/dynamics/start.h"
#include "floe/petsc/values.h"
#include "floe/reference/corotational_beam.h"

namespace floe::scene {

using dynamics::Marker;
using petsc::check;

namespace {

MPI_Comm comm_of(const Prepared& prepared, Formulation formulation) {
  return is_reduced(formulation) ? PETSC_COMM_SELF : prepared.comm;
}

bool last_rank(MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return rank == size - 1;
}

std::vector<PetscInt> visited_nodes(const Prepared& prepared, int body) {
  std::vector<PetscInt> nodes;
  auto visit = [&](const PreparedPlace& place) {
    if (place.body == body) nodes.push_back(place.node);
  };
  for (const auto& joint : prepared.joints) visit(joint[0]), visit(joint[1]);
  for (std::size_t l = 0; l < prepared.loads.size(); ++l)
    if (prepared.scene.loads[l].kind != Load::Kind::distributed) visit(prepared.loads[l]);
  for (std::size_t p = 0; p < prepared.probes.size(); ++p) {
    visit(prepared.probes[p][0]), visit(prepared.probes[p][1]);
    if (prepared.scene.probes[p].quantity == Probe::Quantity::deflection && prepared.probes[p][0].body == body)
      for (const PreparedPlace& place : prepared.bodies[body].frame_places) nodes.push_back(place.node);
  }
  return nodes;
}

/// World position of a node of a corotational body at rest.
Eigen::Vector2d world(const PreparedBody& body, const Eigen::Vector3d& x) {
  return body.pose.head<2>() + turn(body.pose[2]) * x.head<2>();
}

}  // namespace

Assembly::Assembly(const Prepared& prepared, Formulation formulation, const std::vector<ReducedBody>& reduced)
    : prepared_(prepared),
      formulation_(formulation),
      reduced_(reduced),
      owner_(last_rank(comm_of(prepared, formulation))),
      coordinates_(comm_of(prepared, formulation)),
      slots_(prepared.bodies.size()) {}

bool Assembly::compact(int body) const { return is_reduced(formulation_) || prepared_.bodies[body].spec.rigid; }

void Assembly::add_coordinates() {
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PreparedBody& body = prepared_.bodies[b];
    Slot& slot = slots_[b];
    const int index = static_cast<int>(b);
    if (compact(index) || formulation_ != Formulation::cfr) slot.frame = coordinates_.add_shared(3);
    if (compact(index)) {
      slot.elastic = coordinates_.add_shared(reduced_[b].body.coordinates());
      continue;
    }
    slot.nodes = std::make_unique<reference::NodeCoordinates>(coordinates_, body.structure.mesh,
                                                              visited_nodes(prepared_, index));
    if (formulation_ != Formulation::cfr && body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
      slot.multipliers = coordinates_.add_shared(3, true);
  }
  joint_rows_ = standing_rows(prepared_, reduced_);
  for (const auto& rows : joint_rows_)
    joint_multipliers_.push_back(coordinates_.add_shared(static_cast<int>(rows.size()), true));
  coordinates_.number();
}

void Assembly::add_body_terms(int b) {
  const PreparedBody& body = prepared_.bodies[b];
  const Slot& slot = slots_[b];
  const DampingSpec& damping = body.spec.damping;
  if (compact(b)) {
    std::vector<int> coordinates;
    const int k = reduced_[b].body.coordinates();
    for (int i = 0; i < 3; ++i) coordinates.push_back(slot.frame + i);
    for (int i = 0; i < k; ++i) coordinates.push_back(slot.elastic + i);
    if (owner_)
      terms_.push_back(std::make_unique<dynamics::FloatingBody>(coordinates, body::planar(reduced_[b].body.inertia),
                                                                reduced_[b].body.elasticity, reduced_[b].damping));
    return;
  }
  if (!damping.modal.empty())
    throw InputError(fmt::format("{}: modal damping needs a reduced formulation (vm, vm+md); {} is of full order",
                                 damping.where.text(), name_of(formulation_)));
  if (formulation_ != Formulation::cfr) {
    auto more = reference::full_order_terms(
        body.structure, body.frame, *slot.nodes, slot.frame, slot.multipliers,
        formulation_ == Formulation::lffr ? reference::ElasticForce::linear : reference::ElasticForce::von_karman,
        {damping.mass, damping.stiffness});
    for (auto& term : more) terms_.push_back(std::move(term));
    return;
  }
  if (damping.mass != 0 || damping.stiffness != 0)
    throw InputError(damping.where.text() + ": formulation cfr has no Rayleigh damping (it would damp rigid motion)");
  const fem::Structure& s = body.structure;
  const Eigen::Vector2d gravity(prepared_.scene.gravity[0], prepared_.scene.gravity[1]);
  for (const auto& cell : s.mesh.cells) {
    std::vector<int> coordinates;
    for (int node : cell.nodes)
      for (int d = 0; d < 3; ++d) coordinates.push_back(slot.nodes->of_local_node(node) + d);
    const fem::BeamSection& section = s.sections[cell.part];
    terms_.push_back(std::make_unique<reference::CorotationalBeam>(
        coordinates, world(body, s.mesh.positions[cell.nodes[0]]), world(body, s.mesh.positions[cell.nodes[1]]),
        reference::CorotationalBeam::Properties{section.EA, section.EI, section.rhoA, section.rhoI}, gravity));
  }
}

Marker Assembly::density(int b, const body::Inertia& inertia) {
  Marker marker;
  const body::PlanarInertia in = body::planar(inertia);
  marker.framed = true;
  for (int i = 0; i < 3; ++i) marker.coordinates.push_back(slots_[b].frame + i);
  for (Eigen::Index i = 0; i < in.S.cols(); ++i) marker.coordinates.push_back(slots_[b].elastic + static_cast<int>(i));
  marker.mass = in.m;
  marker.x = in.s0;
  marker.S = in.S;
  marker.psi = Eigen::RowVectorXd::Zero(in.S.cols());
  return marker;
}

void Assembly::add_gravity(int b) {
  const Point g = prepared_.scene.gravity;
  if (g[0] == 0 && g[1] == 0) return;
  const Slot& slot = slots_[b];
  std::vector<Marker> markers;
  if (compact(b)) {
    if (owner_) markers.push_back(density(b, reduced_[b].body.inertia));
  } else if (formulation_ != Formulation::cfr) {
    markers = reference::density_markers(prepared_.bodies[b].structure, prepared_.bodies[b].frame.conditions,
                                         *slot.nodes, slot.frame, reference::Density::mass);
  }
  for (Marker& marker : markers) {
    auto force = std::make_unique<dynamics::Force>(
        std::move(marker), [g](double) { return Eigen::Vector3d(g[0], g[1], 0); }, dynamics::Force::Axes::world);
    force->conservative = true;
    terms_.push_back(std::move(force));
  }
}

void Assembly::add_loads() {
  using dynamics::Force;
  for (std::size_t l = 0; l < prepared_.loads.size(); ++l) {
    const Load& load = prepared_.scene.loads[l];
    const PreparedPlace& place = prepared_.loads[l];
    const bool moment = load.kind == Load::Kind::moment;
    const auto value = [load, moment](double t) {
      return moment ? Eigen::Vector3d(0, 0, load.moment(t)) : Eigen::Vector3d(load.force[0](t), load.force[1](t), 0);
    };
    const Force::Axes axes = load.axes == Load::Axes::body ? Force::Axes::body : Force::Axes::world;
    std::vector<Marker> markers;
    if (load.kind != Load::Kind::distributed) {
      Marker at = marker(place);
      if (axes == Force::Axes::body && formulation_ == Formulation::cfr && !compact(place.body))
        throw InputError(load.where.text() +
                         ": axes: body turn with the floating frame, which formulation cfr does not have");
      if (owner_) markers.push_back(std::move(at));
    } else if (compact(place.body)) {
      if (owner_) markers.push_back(density(place.body, reduced_[place.body].body.line));
    } else if (formulation_ != Formulation::cfr) {
      markers = reference::density_markers(prepared_.bodies[place.body].structure,
                                           prepared_.bodies[place.body].frame.conditions, *slots_[place.body].nodes,
                                           slots_[place.body].frame, reference::Density::line);
    } else {
      if (axes == Force::Axes::body)
        throw InputError(load.where.text() +
                         ": axes: body turn with the floating frame, which formulation cfr does not have");
      markers = reference::corotational_line_markers(prepared_.bodies[place.body].structure, *slots_[place.body].nodes);
    }
    for (Marker& at : markers) {
      // Forces of body axes are given in the axes of the mesh.
      const double tilt = axes == Force::Axes::body ? -prepared_.bodies[place.body].frame_angle : 0;
      const Eigen::Matrix2d A = turn(tilt);
      terms_.push_back(std::make_unique<Force>(
          std::move(at),
          [value, A](double t) {
            Eigen::Vector3d f = value(t);
            f.head<2>() = (A * f.head<2>()).eval();
            return f;
          },
          axes));
    }
  }
}

Marker Assembly::marker(const PreparedPlace& place) {
  if (place.body < 0) return Marker::ground(place.x.head<2>());
  const PreparedBody& body = prepared_.bodies[place.body];
  const Slot& slot = slots_[place.body];
  if (compact(place.body)) {
    const body::PlaceMap map = reduction::place_map(body.structure, *reduced_[place.body].basis, place.node);
    Marker at;
    at.framed = true;
    for (int i = 0; i < 3; ++i) at.coordinates.push_back(slot.frame + i);
    for (Eigen::Index i = 0; i < map.S.cols(); ++i) at.coordinates.push_back(slot.elastic + static_cast<int>(i));
    at.x = map.x.head<2>();
    at.S = map.S;
    at.psi = map.psi;
    return at;
  }
  if (!owner_) return Marker::ground(Eigen::Vector2d::Zero());  // its term lives on the last rank
  const bool corotational = formulation_ == Formulation::cfr;
  Marker at = reference::node_marker(corotational ? fem::Conditions{} : body.frame.conditions, *slot.nodes, slot.frame,
                                     place.node, place.x);
  if (corotational) {
    at.framed = false;
    at.coordinates.erase(at.coordinates.begin(), at.coordinates.begin() + 3);
    at.x = world(body, place.x);
    at.angle0 = body.pose[2];
  }
  return at;
}

Eigen::Vector3d Assembly::pose_at(const Marker& marker, const Eigen::VectorXd& q) const {
  Eigen::VectorXd own(static_cast<Eigen::Index>(marker.coordinates.size()));
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = q[marker.coordinates[i]];
  dynamics::Pose at;
  dynamics::pose(marker, own, Eigen::VectorXd::Zero(own.size()), Eigen::VectorXd::Zero(own.size()), at);
  return at.y;
}

void Assembly::add_joints(const Eigen::VectorXd& q) {
  std::vector<std::array<Marker, 2>> markers;  // finding them is collective, what follows is rank-local
  for (const auto& joint : prepared_.joints) markers.push_back({marker(joint[0]), marker(joint[1])});
  const auto add = [&] {
    for (std::size_t j = 0; owner_ && j < markers.size(); ++j) add_joint(j, markers[j], q);
  };
  if (is_reduced(formulation_))
    add();
  else
    petsc::agree(prepared_.comm, add);
}

void Assembly::add_joint(std::size_t j, std::array<Marker, 2>& places, const Eigen::VectorXd& q) {
  const Joint& joint = prepared_.scene.joints[j];
  for (int i = 0; i < 2; ++i)  // a ground without a point follows the other place
    if (prepared_.joints[j][i].body < 0 && std::isnan(places[i].x.x()))
      places[i].x = pose_at(places[1 - i], q).head<2>();
  const Eigen::Vector3d y[2] = {pose_at(places[0], q), pose_at(places[1], q)};
  const Eigen::Vector2d apart = (y[1] - y[0]).head<2>();
  const double offset = y[1][2] - y[0][2];
  const int multipliers = joint_multipliers_[j];
  const bool meet = joint.kind != Joint::Kind::spring && joint.kind != Joint::Kind::prismatic;
  if (meet && apart.norm() > 1e-6 * prepared_.extent)
    throw InputError(
        fmt::format("{}: the two places of joint {} are {:.6g} apart at the start, at ({:.6g}, {:.6g}) and "
                    "({:.6g}, {:.6g}); expected the same point",
                    joint.where.text(), joint.name, apart.norm(), y[0][0], y[0][1], y[1][0], y[1][1]));
  switch (joint.kind) {
    case Joint::Kind::revolute:
      terms_.push_back(
          std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Revolute{}, multipliers, joint_rows_[j]));
      break;
    case Joint::Kind::fixed:
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{offset, {}}, multipliers,
                                                         joint_rows_[j]));
      break;
    case Joint::Kind::driven: {
      const math::Formula angle = joint.angle;
      if (std::abs(angle(0)) > 1e-9)
        throw InputError(
            fmt::format("{}: the driven angle is {:.6g} at t = 0; expected 0, because it is measured from the "
                        "start",
                        joint.where.text(), angle(0)));
      const dynamics::TimeFunction f{[angle](double t) { return angle(t); },
                                     [angle](double t) { return angle.derivative(t); },
                                     [angle](double t) { return angle.second_derivative(t); }};
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], dynamics::Clamp{offset, f}, multipliers,
                                                         joint_rows_[j]));
      break;
    }
    case Joint::Kind::prismatic: {
      const Eigen::Vector2d axis = Eigen::Vector2d(joint.axis[0], joint.axis[1]).normalized();
      const Eigen::Vector2d normal(-axis.y(), axis.x());
      const dynamics::Prismatic slide{turn(-y[0][2]) * normal, normal.dot(apart), offset};
      terms_.push_back(std::make_unique<dynamics::Joint>(places[0], places[1], slide, multipliers, joint_rows_[j]));
      break;
    }
    case Joint::Kind::spring:
      terms_.push_back(std::make_unique<dynamics::Spring>(
          places[0], places[1],
          dynamics::SpringProperties{joint.stiffness, joint.viscosity, joint.length.value_or(apart.norm()),
                                     joint.torsional_stiffness, joint.torsional_viscosity, offset}));
      break;
  }
}

void Assembly::add_probes(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < prepared_.probes.size(); ++p) {
    const Probe& spec = prepared_.scene.probes[p];
    const PreparedPlace& place = prepared_.probes[p][0];
    ModelProbe probe{spec.name, spec.quantity, marker(place), {}, {}, {}, Eigen::Vector3d::Zero()};
    if (spec.quantity == Probe::Quantity::deflection && place.body >= 0 && !compact(place.body) &&
        formulation_ == Formulation::cfr) {
      const PreparedBody& body = prepared_.bodies[place.body];
      if (body.frame.kind == fem::ReferenceFrame::Kind::mean_axis)
        throw InputError(spec.where.text() + ": deflection from mean axes is not known in formulation cfr");
      for (const PreparedPlace& node : body.frame_places)
        probe.frame.push_back(marker({place.body, node.node, node.x}));
    }
    if (spec.relative_to) probe.relative_to = marker(prepared_.probes[p][1]);
    if (owner_) {
      probe.start = pose_at(probe.marker, q);
      if (probe.relative_to) probe.start_relative = pose_at(*probe.relative_to, q);
    }
    model.probes.push_back(std::move(probe));
  }
}

void Assembly::set_full_order_start(int b, Vec U, Vec V) {
  const PreparedBody& body = prepared_.bodies[b];
  const fem::Mesh& mesh = body.structure.mesh;
  const bool corotational = formulation_ == Formulation::cfr;
  const Eigen::Matrix2d A = corotational ? turn(body.pose[2]) : Eigen::Matrix2d(Eigen::Matrix2d::Identity());
  auto local = [&](Vec field) {
    return field ? body.structure.exchange.gather(field)
                 : Eigen::VectorXd(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(mesh.positions.size())));
  };
  const Eigen::VectorXd shape = local(body.deformation), rate = local(body.deformation_rate);
  for (PetscInt i = 0; i < mesh.owned_nodes; ++i) {
    Eigen::Vector3d u = shape.segment<3>(3 * i), v = rate.segment<3>(3 * i);
    u.head<2>() = (A * u.head<2>()).eval(), v.head<2>() = (A * v.head<2>()).eval();
    if (corotational) {
      const Eigen::Vector2d arm = turn(body.pose[2]) * mesh.positions[i].head<2>() + u.head<2>();
      v.head<2>() += body.velocity.head<2>() + body.velocity[2] * Eigen::Vector2d(-arm.y(), arm.x());
      v[2] += body.velocity[2];
    }
    const PetscInt global = coordinates_.global()[slots_[b].nodes->of_local_node(static_cast<int>(i))];
    const PetscInt rows[3] = {global, global + 1, global + 2};
    check(VecSetValues(U, 3, rows, u.data(), INSERT_VALUES));
    check(VecSetValues(V, 3, rows, v.data(), INSERT_VALUES));
  }
}

void Assembly::set_start(Model& model) {
  const dynamics::System layout(coordinates_, {});
  model.U = layout.create_vector();
  model.V = layout.create_vector();
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    const PreparedBody& body = prepared_.bodies[b];
    const Slot& slot = slots_[b];
    if (!compact(static_cast<int>(b))) set_full_order_start(static_cast<int>(b), model.U, model.V);
    Eigen::VectorXd shape, rate;
    const int k = compact(static_cast<int>(b)) ? reduced_[b].body.coordinates() : 0;
    shape.setZero(k), rate.setZero(k);
    if (k > 0 && body.deformation) check(BVDotVec(reduced_[b].basis->V, body.deformation, shape.data()));
    if (k > 0 && body.deformation_rate) check(BVDotVec(reduced_[b].basis->V, body.deformation_rate, rate.data()));
    if (!owner_) continue;
    const auto& global = coordinates_.global();
    for (int i = 0; i < 3 && slot.frame >= 0; ++i) {
      check(VecSetValue(model.U, global[slot.frame + i], body.pose[i], INSERT_VALUES));
      check(VecSetValue(model.V, global[slot.frame + i], body.velocity[i], INSERT_VALUES));
    }
    for (int i = 0; i < k; ++i) {
      check(VecSetValue(model.U, global[slot.elastic + i], shape[i], INSERT_VALUES));
      check(VecSetValue(model.V, global[slot.elastic + i], rate[i], INSERT_VALUES));
    }
  }
  for (Vec v : {model.U.get(), model.V.get()}) {
    check(VecAssemblyBegin(v));
    check(VecAssemblyEnd(v));
  }
}

Model Assembly::model() {
  Model model;
  model.formulation = formulation_;
  add_coordinates();
  for (std::size_t b = 0; b < slots_.size(); ++b) {
    add_body_terms(static_cast<int>(b));
    add_gravity(static_cast<int>(b));
    BodyReport report = reduced_[b].report;
    const fem::Mesh& mesh = prepared_.bodies[b].structure.mesh;
    report.name = prepared_.bodies[b].spec.name;
    report.rigid = prepared_.bodies[b].spec.rigid;
    report.nodes = mesh.node_count, report.elements = mesh.cell_count,
    report.dofs = prepared_.bodies[b].structure.dofs();
    report.first_coordinate = slots_[b].frame, report.first_elastic = slots_[b].elastic;
    report.first_node = mesh.first_node;
    for (PetscInt i = 0; i < mesh.owned_nodes; ++i)
      report.positions.insert(report.positions.end(), {mesh.positions[i].x(), mesh.positions[i].y()});
    model.bodies.push_back(std::move(report));
  }
  set_start(model);
  Eigen::VectorXd q;
  {
    const dynamics::System layout(coordinates_, {});
    layout.gather(model.U, q);
  }
  add_loads();
  add_joints(q);
  add_probes(model, q);
  model.multipliers = coordinates_.multiplier_count();
  model.coordinates = coordinates_.global_size() - model.multipliers;
  model.system = std::make_unique<dynamics::System>(std::move(coordinates_), std::move(terms_));
  model.velocity_correction = dynamics::consistent_velocities(*model.system, 0, model.U, model.V);
  return model;
}

}  // namespace floe::scene
