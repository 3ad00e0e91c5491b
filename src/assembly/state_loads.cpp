#include "state_loads.h"

#include <algorithm>

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

bool has_spread_state_loads(const Scene& scene) {
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [](const Load& load) { return load.spread() && load.has_sensors(); });
}

namespace {

/// The components of a load that depends on time alone: a pressure as the first.
std::function<Eigen::Vector3d(double)> value_of(const Load& load) {
  std::array<math::Formula, 3> all{0., 0., 0.};
  const auto components = load.formulas();
  for (std::size_t c = 0; c < components.size(); ++c) all[c] = *components[c];
  return [all](double t) { return Eigen::Vector3d(all[0](t), all[1](t), all[2](t)); };
}

}  // namespace

std::vector<std::unique_ptr<dynamics::Term>> terms_of_load(const Load& load, const StateFormulas& formulas,
                                                           const UnitLoads& unit) {
  if (!load.has_sensors()) return unit(value_of(load));
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  const auto components = load.formulas();
  for (std::size_t c = 0; c < components.size(); ++c) {
    if (components[c]->constant() && (*components[c])() == 0) continue;
    const Eigen::Vector3d one = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(c));
    for (auto& term : unit([one](double) { return one; }))
      terms.push_back(std::make_unique<StateForce>(std::move(term), formulas.at(c)));
  }
  return terms;
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
  const auto formula_of = [&](const math::Formula& formula) {
    return std::make_shared<StateFormula>(formula, sensors(formula, model, q));
  };
  for (std::size_t p = 0; p < model.probes.size() && owner_; ++p)
    if (model.probes[p].quantity == Quantity::formula)
      watch(formula_of(plan_.scene.probes[p].formula), model.probes[p], terms_);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    if (!load.joint.empty()) {
      if (!owner_) continue;
      const std::size_t j = joint_index(plan_.scene, load.joint);
      const Of of = of_dynamics(loaded_coordinate(load, plan_.scene.joints[j], 2));
      connect(j, std::make_unique<StateForce>(
                     unit_load(coordinate_of(j, of, joint_places_[j], q), own_switch(switches_, load.joint)),
                     formula_of(load.on_joint)));
      continue;
    }
    if (!load.has_sensors()) continue;
    StateFormulas& formulas = state_formulas_[l];
    for (const math::Formula* formula : load.formulas())
      if (sees_) formulas.push_back(formula_of(*formula));
    add_load(l);
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
  const auto formula_of = [&](const math::Formula& formula) {
    return std::make_shared<StateFormula>(formula, sensors(formula, model));
  };
  for (std::size_t p = 0; p < model.probes.size() && owner_; ++p)
    if (model.probes[p].quantity == Quantity::formula)
      watch(formula_of(plan_.scene.probes[p].formula), model.probes[p], terms_);
  for (std::size_t l = 0; l < plan_.loads.size(); ++l) {
    const Load& load = plan_.scene.loads[l];
    if (!load.joint.empty()) {
      if (!owner_) continue;
      const auto j = static_cast<int>(joint_index(plan_.scene, load.joint));
      const Of of = of_dynamics(loaded_coordinate(load, plan_.scene.joints[j], 3));
      connect(j, std::make_unique<StateForce>(
                     unit_load(coordinate_of(j, of, placed_[j]), own_switch(switches_, load.joint)),
                     formula_of(load.on_joint)));
      continue;
    }
    if (!load.has_sensors()) continue;
    StateFormulas& formulas = state_formulas_[l];
    for (const math::Formula* formula : load.formulas())
      if (sees_) formulas.push_back(formula_of(*formula));
    add_load(l);
  }
  measure_again(connections_, plan_.scene, model);
}

}  // namespace floe::assembly
