#include "state_loads.h"

#include "planar_assembly.h"
#include "spatial_assembly.h"
#include "stops.h"

namespace floe::assembly {

using dynamics::CoordinateSensor;
using dynamics::StateForce;
using dynamics::StateFormula;
using Quantity = Probe::Quantity;

dynamics::RelativeCoordinate::Of of_dynamics(JointCoordinate of) {
  using Of = dynamics::RelativeCoordinate::Of;
  return of == JointCoordinate::rotation ? Of::rotation : of == JointCoordinate::travel ? Of::slide : Of::length;
}

std::unique_ptr<dynamics::Term> unit_load(std::unique_ptr<dynamics::RelativeCoordinate> of,
                                          std::shared_ptr<const dynamics::ConstraintSwitch> active) {
  return std::make_unique<dynamics::JointForce>(
      std::move(of),
      [](double, double) {
        return dynamics::ForceOnCoordinate{-1, 0, 0, 0};
      },
      std::move(active));
}

namespace {

bool is_rate(Quantity quantity) { return quantity == Quantity::velocity || quantity == Quantity::angular_velocity; }

/// Lets probes of joints see the loads on them.
void measure_again(const Connections& connections, const Scene& scene, Model& model) {
  for (std::size_t p = 0; p < model.probes.size(); ++p)
    model.probes[p].connections = measured(connections, scene, scene.probes[p]);
}

/// Gives a probe its formula, whose sensors take part in the steps.
void watch(std::shared_ptr<StateFormula> formula, ModelProbe& probe,
           std::vector<std::unique_ptr<dynamics::Term>>& terms) {
  probe.formula = formula;
  if (!formula->coordinates().empty()) terms.push_back(std::make_unique<dynamics::Watch>(std::move(formula)));
}

/// A component of a probe in the plane (add_values of probes.cpp).
std::unique_ptr<dynamics::Sensor> sensor_of(const ModelProbe& probe, int component) {
  const bool rotations = probe.quantity == Quantity::rotation || probe.quantity == Quantity::angular_velocity;
  const dynamics::Marker from = probe.relative_to.value_or(dynamics::Marker::ground({0, 0}));
  const Eigen::Vector3d start = probe.start, other = probe.relative_to ? probe.start_relative : Eigen::Vector3d::Zero();
  double offset = 0;
  if (probe.quantity == Quantity::rotation) offset = start[2] - other[2];
  if (probe.quantity == Quantity::displacement)
    offset = (rotation_matrix(-other[2]) * (start - other).head<2>())[component];
  return std::make_unique<CoordinateSensor>(
      std::make_unique<dynamics::PlanarCoordinate>(
          from, probe.marker,
          rotations ? dynamics::RelativeCoordinate::Of::rotation : dynamics::RelativeCoordinate::Of::slide, offset,
          rotations ? Eigen::Vector2d::Zero() : Eigen::Vector2d(Eigen::Vector2d::Unit(component))),
      is_rate(probe.quantity));
}

/// Likewise in space.
std::unique_ptr<dynamics::Sensor> sensor_of(const SpatialProbe& probe, Quantity quantity, int component) {
  dynamics::SpatialMarker from = probe.relative_to.value_or(dynamics::SpatialMarker::ground(Eigen::Vector3d::Zero()));
  if (quantity == Quantity::rotation || quantity == Quantity::angular_velocity)
    return std::make_unique<dynamics::SpatialRotationSensor>(from, probe.marker, component, is_rate(quantity));
  Eigen::Matrix3d axes;  // the component's axis as the third
  for (int i = 0; i < 3; ++i) axes.col(i) = Eigen::Vector3d::Unit((component + 1 + i) % 3);
  from.D0 = (from.D0 * axes).eval();
  return std::make_unique<CoordinateSensor>(
      std::make_unique<dynamics::SpatialCoordinate>(from, probe.marker, dynamics::RelativeCoordinate::Of::slide,
                                                    quantity == Quantity::displacement ? probe.start[component] : 0),
      is_rate(quantity));
}

}  // namespace

std::vector<std::unique_ptr<dynamics::Sensor>> PlanarAssembly::sensors(const math::Formula& formula, const Model& model,
                                                                       const Eigen::VectorXd& q) const {
  std::vector<std::unique_ptr<dynamics::Sensor>> all;
  for (std::size_t i = 1; i < formula.variables().size(); ++i) {
    const Sensor sensor = scene::sensor_of(plan_.scene, formula.variables()[i]);
    if (sensor.probe >= 0)
      all.push_back(sensor_of(model.probes[sensor.probe], sensor.component));
    else
      all.push_back(std::make_unique<CoordinateSensor>(
          coordinate_of(sensor.joint, of_dynamics(sensor.of), joint_places_[sensor.joint], q), sensor.rate));
  }
  return all;
}

void PlanarAssembly::add_state_loads(Model& model, const Eigen::VectorXd& q) {
  for (std::size_t p = 0; p < model.probes.size() && owner_; ++p)
    if (model.probes[p].quantity == Quantity::formula) {
      const math::Formula& formula = plan_.scene.probes[p].formula;
      watch(std::make_shared<StateFormula>(formula, sensors(formula, model, q)), model.probes[p], terms_);
    }
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    if (!load.joint.empty()) {
      if (!owner_) continue;
      const std::size_t j = joint_index(plan_.scene, load.joint);
      const Of of = of_dynamics(loaded_coordinate(load, plan_.scene.joints[j], 2));
      connect(j, std::make_unique<StateForce>(
                     unit_load(coordinate_of(j, of, joint_places_[j], q), own_switch(switches_, load.joint)),
                     StateFormula(load.on_joint, sensors(load.on_joint, model, q))));
      continue;
    }
    if (!load.has_sensors()) continue;
    const auto& components = load.kind == Load::Kind::moment ? load.moment : load.force;
    for (int c = 0; c < 3; ++c) {
      if (components[c].constant() && components[c]() == 0) continue;
      for (auto& unit : load_terms(l, [c](double) -> Eigen::Vector3d { return Eigen::Vector3d::Unit(c); }))
        load_terms_.emplace(l, terms_
                                   .emplace_back(std::make_unique<StateForce>(
                                       std::move(unit), StateFormula(components[c], sensors(components[c], model, q))))
                                   .get());
    }
  }
  measure_again(connections_, plan_.scene, model);
}

std::vector<std::unique_ptr<dynamics::Sensor>> SpatialAssembly::sensors(const math::Formula& formula,
                                                                        const Model& model) const {
  std::vector<std::unique_ptr<dynamics::Sensor>> all;
  for (std::size_t i = 1; i < formula.variables().size(); ++i) {
    const Sensor sensor = scene::sensor_of(plan_.scene, formula.variables()[i]);
    if (sensor.probe >= 0)
      all.push_back(
          sensor_of(*model.probes[sensor.probe].spatial, model.probes[sensor.probe].quantity, sensor.component));
    else
      all.push_back(std::make_unique<CoordinateSensor>(
          coordinate_of(sensor.joint, of_dynamics(sensor.of), placed_[sensor.joint]), sensor.rate));
  }
  return all;
}

void SpatialAssembly::add_state_loads(Model& model) {
  for (std::size_t p = 0; p < model.probes.size() && owner_; ++p)
    if (model.probes[p].quantity == Quantity::formula) {
      const math::Formula& formula = plan_.scene.probes[p].formula;
      watch(std::make_shared<StateFormula>(formula, sensors(formula, model)), model.probes[p], terms_);
    }
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    if (!load.joint.empty()) {
      if (!owner_) continue;
      const auto j = static_cast<int>(joint_index(plan_.scene, load.joint));
      const Of of = of_dynamics(loaded_coordinate(load, plan_.scene.joints[j], 3));
      connect(j, std::make_unique<StateForce>(
                     unit_load(coordinate_of(j, of, placed_[j]), own_switch(switches_, load.joint)),
                     StateFormula(load.on_joint, sensors(load.on_joint, model))));
      continue;
    }
    if (!load.has_sensors()) continue;
    const auto& components = load.kind == Load::Kind::moment ? load.moment : load.force;
    for (int c = 0; c < 3; ++c) {
      if (components[c].constant() && components[c]() == 0) continue;
      for (auto& unit : load_terms(l, [c](double) -> Eigen::Vector3d { return Eigen::Vector3d::Unit(c); }))
        load_terms_.emplace(l, terms_
                                   .emplace_back(std::make_unique<StateForce>(
                                       std::move(unit), StateFormula(components[c], sensors(components[c], model))))
                                   .get());
    }
  }
  measure_again(connections_, plan_.scene, model);
}

}  // namespace floe::assembly
