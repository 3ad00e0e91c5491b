#include <algorithm>
#include <cmath>
#include <span>

#include "connections.h"
#include "floe/assembly/model.h"
#include "floe/assembly/values_of_probe.h"
#include "floe/dynamics/local_indices.h"
#include "floe/dynamics/state_formula.h"
#include "floe/math/rotation.h"
#include "floe/petsc/error.h"
#include "floe/solve/start.h"
#include "held_reactions.h"
#include "shell_stress.h"

namespace floe::assembly {

namespace {

struct Placed {
  Eigen::Vector3d y, yd;
};

Placed placed(const dynamics::Marker& marker, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Eigen::VectorXd own, rate;
  dynamics::pick(marker.coordinates, q, own);
  dynamics::pick(marker.coordinates, v, rate);
  dynamics::Pose pose;
  dynamics::pose(marker, own, rate, Eigen::VectorXd::Zero(own.size()), pose);
  return {pose.y, pose.yd};
}

dynamics::SpatialPose placed(const dynamics::SpatialMarker& marker, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v) {
  Eigen::VectorXd own, rate;
  dynamics::pick(marker.coordinates, q, own);
  dynamics::pick(marker.coordinates, v, rate);
  dynamics::SpatialPose pose;
  dynamics::pose(marker, own, rate, Eigen::VectorXd::Zero(own.size()), pose);
  return pose;
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& D) {
  return math::rotation_vector(Eigen::Quaterniond(D).normalized());
}

void add_values(const SpatialProbe& probe, Probe::Quantity quantity, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                std::vector<double>& values) {
  dynamics::SpatialPose at = placed(probe.marker, q, v);
  if (probe.relative_to) {  // seen from axes that rotate with the other place
    const dynamics::SpatialPose from = placed(*probe.relative_to, q, v);
    const Eigen::Matrix3d Dt = from.D.transpose();
    const Eigen::Vector3d apart = at.p - from.p;
    at.velocity = Dt * (at.velocity - from.velocity - from.spin.cross(apart));
    at.p = Dt * apart;
    at.D = Dt * at.D;
    at.spin = Dt * (at.spin - from.spin);
  }
  Eigen::Vector3d value = at.p;
  if (quantity == Probe::Quantity::displacement) value -= probe.start;
  if (quantity == Probe::Quantity::velocity) value = at.velocity;
  if (quantity == Probe::Quantity::rotation) value = rotation_vector(at.D);
  if (quantity == Probe::Quantity::angular_velocity) value = at.spin;
  if (quantity == Probe::Quantity::deflection && probe.undeformed)
    value -= *probe.undeformed;
  else if (quantity == Probe::Quantity::deflection)
    value = probe.frame ? deflection(*probe.frame, q, at.p) : Eigen::Vector3d(probe.mesh * (at.c - probe.marker.x0));
  values.insert(values.end(), value.data(), value.data() + 3);
}

/// What a joint exerts, in world axes or in those of the other place. @param held  by dofs without equations
void add_exerted(const ModelProbe& probe, const dynamics::Wrench& held, double t, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& v, std::vector<double>& values) {
  const dynamics::Wrench wrench = held + exerted(probe.connections, t, q, v);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (probe.relative_to) axes.topLeftCorner<2, 2>() = rotation_matrix(placed(*probe.relative_to, q, v).y[2]);
  if (probe.spatial && probe.spatial->relative_to) axes = placed(*probe.spatial->relative_to, q, v).D;
  const bool force = probe.quantity == Probe::Quantity::force;
  const Eigen::Vector3d parts = axes.transpose() * wrench.segment<3>(force ? 0 : 3);
  const int first = !probe.spatial && !force ? 2 : 0, behind = !probe.spatial && force ? 2 : 3;
  values.insert(values.end(), parts.data() + first, parts.data() + behind);
}

double value_of(const dynamics::StateFormula& formula, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  Eigen::VectorXd own, rate;
  dynamics::pick(formula.coordinates(), q, own);
  dynamics::pick(formula.coordinates(), v, rate);
  return formula.value({t, own, rate, Eigen::VectorXd::Zero(own.size())});
}

bool of_section(const ModelProbe& probe) {
  return probe.quantity == Probe::Quantity::section_force || probe.quantity == Probe::Quantity::section_moment;
}

/// Work of this rank that may fail: then all ranks of the system fail. Collective.
template <class Work>
void agree(const Model& model, const Work& work) {
  int size = 1;
  MPI_Comm_size(model.system->comm(), &size);
  petsc::agree_if_parallel(model.system->comm(), size == 1, work);
}

using Probes = std::span<const ModelProbe>;

/// What the cuts of all sections exert on their parts, one after the other. Collective.
std::vector<dynamics::Wrench> in_sections(const Model& model, Probes probes, double t, const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  std::vector<dynamics::Wrench> all;
  agree(model, [&] {
    for (const ModelProbe& probe : probes)
      for (const ModelSection& section : probe.sections) all.push_back(on_part(section.cut, t, q, v, a));
  });
  MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(6 * all.size()), MPI_DOUBLE, MPI_SUM, model.system->comm());
  return all;
}

bool of_reaction(const ModelProbe& probe) {
  return probe.quantity == Probe::Quantity::force || probe.quantity == Probe::Quantity::moment;
}

/// What joints exert by dofs that they hold, of all probes of reactions, one after the other. Collective.
std::vector<dynamics::Wrench> held_reactions(const Model& model, Probes probes, double t, const Eigen::VectorXd& q,
                                             const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  std::vector<dynamics::Wrench> all;
  bool any = false;
  agree(model, [&] {
    for (const ModelProbe& probe : probes) {
      if (!of_reaction(probe)) continue;
      all.push_back(probe.held ? held_by(*probe.held, t, q, v, a) : dynamics::Wrench(dynamics::Wrench::Zero()));
      any = any || probe.held;
    }
  });
  if (any)
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(6 * all.size()), MPI_DOUBLE, MPI_SUM,
                  model.system->comm());
  return all;
}

/// @param wrench  of the probe's first section
void add_section(const ModelProbe& probe, const dynamics::Wrench* wrench, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& v, std::vector<double>& values) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
  if (probe.spatial) {
    const dynamics::SpatialPose at = placed(probe.spatial->marker, q, v);
    p = at.p, D = at.D;
  } else {
    const Eigen::Vector3d y = placed(probe.marker, q, v).y;
    p.head<2>() = y.head<2>(), D.topLeftCorner<2, 2>() = rotation_matrix(y[2]);
  }
  const bool force = probe.quantity == Probe::Quantity::section_force;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ModelSection& section : probe.sections) {
    const Eigen::Vector3d f = wrench->head<3>();
    Eigen::Vector3d m = wrench->tail<3>(), from = p;
    if (section.origin >= 0) from.head(probe.spatial ? 3 : 2) = q.segment(section.origin, probe.spatial ? 3 : 2);
    m -= (p - from).cross(f);
    sum += section.factor * ((D * section.axes).transpose() * (force ? f : m));
    ++wrench;
  }
  const int first = !probe.spatial && !force ? 2 : 0, behind = !probe.spatial && force ? 2 : 3;
  values.insert(values.end(), sum.data() + first, sum.data() + behind);
}

bool of_acceleration(const ModelProbe& probe) {
  return probe.quantity == Probe::Quantity::acceleration || probe.quantity == Probe::Quantity::angular_acceleration;
}

/// Of a place, in world axes or in those of the other place.
void add_acceleration(const ModelProbe& probe, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                      const Eigen::VectorXd& a, std::vector<double>& values) {
  const bool angular = probe.quantity == Probe::Quantity::angular_acceleration;
  Eigen::VectorXd own, rate, second;
  const auto pick_all = [&](const std::vector<int>& coordinates) {
    dynamics::pick(coordinates, q, own);
    dynamics::pick(coordinates, v, rate);
    dynamics::pick(coordinates, a, second);
  };
  if (probe.spatial) {
    pick_all(probe.spatial->marker.coordinates);
    dynamics::SpatialPose at;
    dynamics::pose(probe.spatial->marker, own, rate, second, at);
    Eigen::Vector3d value = angular ? at.spin_rate : at.acceleration;
    if (probe.spatial->relative_to) value = placed(*probe.spatial->relative_to, q, v).D.transpose() * value;
    values.insert(values.end(), value.data(), value.data() + 3);
    return;
  }
  pick_all(probe.marker.coordinates);
  dynamics::Pose at;
  dynamics::pose(probe.marker, own, rate, second, at);
  if (angular) return values.push_back(at.ydd[2]);
  Eigen::Vector2d value = at.ydd.head<2>();
  if (probe.relative_to) value = rotation_matrix(-placed(*probe.relative_to, q, v).y[2]) * value;
  values.insert(values.end(), {value.x(), value.y()});
}

/// Of a place in the plane as one in space.
dynamics::SpatialPose in_space(const dynamics::Marker& marker, double start, const Eigen::VectorXd& q,
                               const Eigen::VectorXd& v) {
  const Placed at = placed(marker, q, v);
  dynamics::SpatialPose pose;
  pose.p << at.y.head<2>(), 0;
  pose.velocity << at.yd.head<2>(), 0;
  pose.spin << 0, 0, at.yd[2];
  pose.D = Eigen::AngleAxisd(at.y[2] - start, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

/// What a joint exerts on its coordinate, or does on both places: the opposite wrench acts on the first, on the same
/// line.
double drive_or_power(const ModelProbe& probe, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  const dynamics::SpatialPose one = probe.spatial ? placed(*probe.spatial->other, q, v)
                                                  : in_space(*probe.other, probe.start_relative[2], q, v),
                              two =
                                  probe.spatial ? placed(probe.spatial->marker, q, v) : in_space(probe.marker, 0, q, v);
  const dynamics::Wrench wrench = exerted(probe.connections, t, q, v);
  const Eigen::Vector3d f = wrench.head<3>(), m = wrench.tail<3>(), apart = two.p - one.p;
  if (probe.quantity == Probe::Quantity::power)
    return f.dot(two.velocity - one.velocity - one.spin.cross(apart)) + m.dot(two.spin - one.spin);
  if (probe.drive.length) return f.dot(apart.normalized());
  return (one.D * probe.drive.axis).dot(probe.drive.rotation ? m : f);
}

/// Energies of the bodies of all probes that measure one, one after the other. Collective.
std::vector<double> of_bodies(const Model& model, Probes probes, double t, const Eigen::VectorXd& q,
                              const Eigen::VectorXd& v) {
  std::vector<double> all;
  Eigen::VectorXd own, rate;
  for (const ModelProbe& probe : probes) {
    const bool kinetic = probe.quantity == Probe::Quantity::kinetic_energy;
    if (!kinetic && probe.quantity != Probe::Quantity::strain_energy) continue;
    double& sum = all.emplace_back(0);
    for (const dynamics::Term* term : probe.terms) {
      dynamics::pick(term->coordinates(), q, own);
      dynamics::pick(term->coordinates(), v, rate);
      const dynamics::Energy energy = term->energy({t, own, rate, Eigen::VectorXd::Zero(own.size())});
      sum += kinetic ? energy.kinetic : energy.elastic;
    }
  }
  if (!all.empty())
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, model.system->comm());
  return all;
}

/// What all probes of shells record, one after the other. Collective.
std::vector<Eigen::Vector3d> in_shells(const Model& model, Probes probes, double t, const Eigen::VectorXd& q) {
  std::vector<Eigen::Vector3d> all;
  agree(model, [&] {
    for (const ModelProbe& probe : probes)
      if (probe.shell) all.push_back(probe.shell->value(t, q));
  });
  if (!all.empty())
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(3 * all.size()), MPI_DOUBLE, MPI_SUM,
                  model.system->comm());
  return all;
}

void add_shell(Probe::Quantity quantity, const Eigen::Vector3d& s, std::vector<double>& values) {
  const double mean = (s[0] + s[1]) / 2, radius = std::hypot((s[0] - s[1]) / 2, s[2]);
  if (quantity == Probe::Quantity::principal_stress)
    values.insert(values.end(), {mean + radius, mean - radius});
  else if (quantity == Probe::Quantity::von_mises_stress)
    values.push_back(std::sqrt(s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]));
  else
    values.insert(values.end(), s.data(), s.data() + 3);
}

void add_values(const ModelProbe& probe, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                std::vector<double>& values) {
  if (probe.quantity == Probe::Quantity::drive || probe.quantity == Probe::Quantity::power)
    return values.push_back(drive_or_power(probe, t, q, v));
  if (probe.quantity == Probe::Quantity::formula) return values.push_back(value_of(*probe.formula, t, q, v));
  if (probe.spatial) return add_values(*probe.spatial, probe.quantity, q, v, values);
  Placed at = placed(probe.marker, q, v);
  Eigen::Vector3d start = probe.start;
  if (probe.relative_to) {  // seen from axes that move with the other place
    const Placed from = placed(*probe.relative_to, q, v);
    const Eigen::Matrix2d A = rotation_matrix(from.y[2]), A0 = rotation_matrix(probe.start_relative[2]);
    const Eigen::Vector2d d = A.transpose() * (at.y - from.y).head<2>();
    const Eigen::Vector2d dd =
        A.transpose() * (at.yd - from.yd).head<2>() - from.yd[2] * Eigen::Vector2d(-d.y(), d.x());
    at.y << d, at.y[2] - from.y[2];
    at.yd << dd, at.yd[2] - from.yd[2];
    start << A0.transpose() * (probe.start - probe.start_relative).head<2>(), probe.start[2] - probe.start_relative[2];
  }
  switch (probe.quantity) {
    case Probe::Quantity::position:
      values.insert(values.end(), {at.y[0], at.y[1]});
      break;
    case Probe::Quantity::displacement:
      values.insert(values.end(), {at.y[0] - start[0], at.y[1] - start[1]});
      break;
    case Probe::Quantity::velocity:
      values.insert(values.end(), {at.yd[0], at.yd[1]});
      break;
    case Probe::Quantity::rotation:
      values.push_back(at.y[2] - start[2]);
      break;
    case Probe::Quantity::angular_velocity:
      values.push_back(at.yd[2]);
      break;
    case Probe::Quantity::force:
    case Probe::Quantity::moment:
    default:
      break;  // add_exerted, value_of, add_section, add_shell
    case Probe::Quantity::deflection: {
      if (probe.frame || probe.undeformed) {
        const Eigen::Vector2d p = at.y.head<2>(),
                              u = probe.frame ? deflection(*probe.frame, q, p) : Eigen::Vector2d(p - *probe.undeformed);
        values.insert(values.end(), {u.x(), u.y()});
        break;
      }
      const dynamics::Marker& marker = probe.marker;
      Eigen::VectorXd elastic(marker.S.cols());
      for (Eigen::Index i = 0; i < elastic.size(); ++i) elastic[i] = q[marker.coordinates[3 + i]];
      const Eigen::Vector2d u = marker.S * elastic;
      values.insert(values.end(), {u.x(), u.y()});
      break;
    }
  }
}

/// Unknowns and accelerations at an instant: given ones, or those that are consistent with U and V. Collective.
void find_accelerations(const Model& model, double t, Vec U, Vec V, Vec A, Eigen::VectorXd& q, Eigen::VectorXd& a) {
  if (A) return model.system->gather(A, a);
  const petsc::VecHandle own = model.system->create_vector(), found = model.system->create_vector();
  petsc::check(VecCopy(U, own));
  solve::consistent_start(*model.system, t, own, V, found);
  model.system->gather(own, q);  // with the multipliers of these accelerations
  model.system->gather(found, a);
}

/// Of some probes of the model, one after the other. Collective.
std::vector<double> values_of(const Model& model, Probes probes, double t, Vec U, Vec V, Vec A) {
  static thread_local Eigen::VectorXd q, v, a, whole;
  model.system->gather(U, q);
  model.system->gather(V, v);
  std::vector<double> values;
  std::vector<dynamics::Wrench> wrenches;
  const bool sections = std::any_of(probes.begin(), probes.end(), of_section);
  whole = q;
  if (sections || std::any_of(probes.begin(), probes.end(), of_acceleration) ||
      std::any_of(probes.begin(), probes.end(), [](const ModelProbe& probe) { return probe.held != nullptr; })) {
    find_accelerations(model, t, U, V, A, whole, a);
    if (sections) wrenches = in_sections(model, probes, t, whole, v, a);
  }
  const std::vector<dynamics::Wrench> held = held_reactions(model, probes, t, whole, v, a);
  const MPI_Comm comm = model.system->comm();
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  const std::vector<Eigen::Vector3d> of_shells = in_shells(model, probes, t, q);
  const std::vector<double> energies = of_bodies(model, probes, t, q, v);
  std::size_t next = 0, next_shell = 0, next_body = 0, next_held = 0;
  agree(model, [&] {
    if (rank != size - 1) return;
    for (const ModelProbe& probe : probes) {
      if (of_section(probe))
        add_section(probe, &wrenches[next], q, v, values);
      else if (of_reaction(probe))
        add_exerted(probe, held[next_held++], t, q, v, values);
      else if (probe.shell)
        add_shell(probe.quantity, of_shells[next_shell++], values);
      else if (of_acceleration(probe))
        add_acceleration(probe, q, v, a, values);
      else if (probe.quantity == Probe::Quantity::kinetic_energy || probe.quantity == Probe::Quantity::strain_energy)
        values.push_back(energies[next_body++]);
      else
        add_values(probe, t, q, v, values);
      next += probe.sections.size();
    }
  });
  if (size > 1) {
    auto count = static_cast<int>(values.size());
    MPI_Bcast(&count, 1, MPI_INT, size - 1, comm);
    values.resize(count);
    MPI_Bcast(values.data(), count, MPI_DOUBLE, size - 1, comm);
  }
  return values;
}

}  // namespace

std::vector<double> probe_values(const Model& model, double t, Vec U, Vec V, Vec A) {
  return values_of(model, model.probes, t, U, V, A);
}

std::vector<double> values_of_probe(const Model& model, std::size_t probe, double t, Vec U, Vec V) {
  return values_of(model, Probes(model.probes).subspan(probe, 1), t, U, V, nullptr);
}

}  // namespace floe::assembly
