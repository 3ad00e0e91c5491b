#include "floe/plan/load_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/fem/structure.h"
#include "floe/plan/weight.h"

namespace floe::plan {

namespace {

/// Mass per unit length or area, and bending stiffness of the softer direction ([N m2] or, of shells, [N m]).
struct Softness {
  double operator()(const fem::BeamSection& section) const { return section.EI; }
  double operator()(const fem::SpatialBeam& beam) const {
    return beam.releases.any() ? 0 : std::min(beam.section.EIy, beam.section.EIz);
  }
  double operator()(const fem::ShellSection& shell) const { return shell.D()(0, 0); }
  double operator()(const fem::PointMass&) const { return 0; }
  double operator()(const fem::NodeSpring&) const { return 0; }
};
struct Density {
  double operator()(const fem::BeamSection& section) const { return section.rhoA; }
  double operator()(const fem::SpatialBeam& beam) const { return beam.section.rhoA; }
  double operator()(const fem::ShellSection& shell) const { return shell.mass; }
  double operator()(const fem::PointMass& point) const { return point.mass; }
  double operator()(const fem::NodeSpring&) const { return 0; }
};

/// Length, area (of second order: of its corners), or 1 of a mass.
double measure(const fem::Mesh& mesh, const fem::Mesh::Cell& cell) {
  const auto corners = cell.corners();
  const auto at = [&](std::size_t i) { return mesh.positions[cell.place[i]]; };
  if (corners.size() < 2) return 1;
  if (corners.size() == 2) return (at(1) - at(0)).norm();
  double area = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) area += (at(i - 1) - at(0)).cross(at(i) - at(0)).norm() / 2;
  return area;
}

struct OfBody {
  double mass = 0, bending = 0;  // bending: force that bends it by its length [N]
};

OfBody of_body(const PlannedBody& body) {
  if (body.spec.reduced) return {body.spec.reduced->file->body.inertia.m, 0};
  if (body.spec.mass) return {body.spec.mass->mass, 0};
  const fem::Structure& structure = body.structure;
  const double L = fem::extent(structure);
  double mass = 0, softest = std::numeric_limits<double>::infinity();
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const auto& section = structure.sections[cell.part];
    mass += std::visit(Density(), section) * measure(structure.mesh, cell);
    if (const double B = std::visit(Softness(), section); B > 0)
      softest = std::min(softest, cell.corners().size() > 2 ? B / L : B / (L * L));
  }
  MPI_Allreduce(MPI_IN_PLACE, &mass, 1, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, &softest, 1, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
  return {mass, body.spec.rigid || !std::isfinite(softest) ? 0 : softest};
}

double size_of(const Load& load, double t, double extent) {
  if (load.has_sensors()) return 0;  // not a function of t
  if (!load.joint.empty()) return std::abs(load.on_joint(t)) / (load.kind == Load::Kind::moment ? extent : 1);
  const auto norm = [&](const std::array<math::Formula, 3>& f) { return std::hypot(f[0](t), f[1](t), f[2](t)); };
  const double size = load.per == Load::Per::length ? extent : load.per == Load::Per::area ? extent * extent : 1;
  switch (load.kind) {
    case Load::Kind::moment:
      return size * norm(load.moment) / extent;
    case Load::Kind::distributed:
      return norm(load.force) * extent;
    case Load::Kind::pressure:
      return std::abs(load.pressure(t)) * extent * extent;
    default:
      return size * norm(load.force);
  }
}

/// 0 where a formula has no value: a motion that comes to that instant reports it.
template <class Size>
double where_defined(const Size& size) {
  try {
    return size();
  } catch (const math::FormulaError&) {
    return 0;
  }
}

}  // namespace

double force_of(const Plan& plan) {
  constexpr int instants = 64;
  const double extent = plan.extent > 0 ? plan.extent : 1, end = plan.scene.motion.end;
  double mass = 0, bending = std::numeric_limits<double>::infinity(), most = 0;
  for (const PlannedBody& body : plan.bodies) {
    const OfBody one = of_body(body);
    mass += one.mass;
    if (one.bending > 0) bending = std::min(bending, one.bending);
  }
  if (std::isfinite(bending)) most = 1e-3 * bending;
  const Weight weight(plan.scene);
  for (int i = 0; i <= instants; ++i) {
    const double t = (std::isfinite(end) && end > 0 ? end : 1) * i / instants;
    most = std::max(most, where_defined([&] { return mass * weight(t).norm(); }));
    for (const Load& load : plan.scene.loads)
      most = std::max(most, where_defined([&] { return size_of(load, t, extent); }));
  }
  return std::isfinite(most) ? most : 0;
}

}  // namespace floe::plan
