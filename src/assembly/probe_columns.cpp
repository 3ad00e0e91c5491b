#include "floe/assembly/model.h"
#include "floe/scene/sensors.h"

namespace floe::assembly {

namespace {

/// Unit, size and kind of a probe's columns.
struct Meaning {
  std::string unit;
  double scale;
  ProbeColumn::Kind kind;
};

Meaning meaning_of(const ModelProbe& probe, const Model& model) {
  const Probe::Quantity quantity = probe.quantity;
  constexpr double unknown = 1e-100;  // any force is large beside it
  const double extent = model.extent, force = model.force > 0 ? model.force : unknown;
  using Kind = ProbeColumn::Kind;
  if (quantity == Probe::Quantity::drive)
    return probe.drive.rotation ? Meaning{"N m", force * extent, Kind::load} : Meaning{"N", force, Kind::load};
  switch (quantity) {
    case Probe::Quantity::rotation:
      return {"rad", 1, Kind::place};
    case Probe::Quantity::velocity:
      return {"m/s", extent, Kind::rate};
    case Probe::Quantity::angular_velocity:
      return {"rad/s", 1, Kind::rate};
    case Probe::Quantity::force:
      return {"N", force, Kind::load};
    case Probe::Quantity::moment:
      return {"N m", force * extent, Kind::load};
    case Probe::Quantity::section_force:
      return {"N", force, Kind::load};
    case Probe::Quantity::section_moment:
      return {"N m", force * extent, Kind::load};
    case Probe::Quantity::stress:
      return {"Pa", 1, Kind::stress};
    case Probe::Quantity::principal_stress:
      return {"Pa", 1, Kind::stress};
    case Probe::Quantity::von_mises_stress:
      return {"Pa", 1, Kind::stress};
    case Probe::Quantity::membrane_force:
      return {"N/m", force / extent, Kind::load};
    case Probe::Quantity::bending_moment:
      return {"N", force, Kind::load};
    case Probe::Quantity::strain:
      return {"", 1, Kind::strain};
    case Probe::Quantity::acceleration:
      return {"m/s2", extent, Kind::acceleration};
    case Probe::Quantity::angular_acceleration:
      return {"rad/s2", 1, Kind::acceleration};
    case Probe::Quantity::power:
      return {"W", 1, Kind::energy};
    case Probe::Quantity::kinetic_energy:
    case Probe::Quantity::strain_energy:
      return {"J", 1, Kind::energy};
    case Probe::Quantity::formula:  // joints' coordinates, too
      if (probe.unit == "rad") return {"rad", 1, Kind::place};
      if (probe.unit == "m") return {"m", extent, Kind::place};
      if (probe.unit == "rad/s") return {"rad/s", 1, Kind::rate};
      if (probe.unit == "m/s") return {"m/s", extent, Kind::rate};
      return {"", 1, Kind::formula};
    default:
      return {"m", extent, Kind::place};
  }
}

}  // namespace

std::vector<ProbeColumn> probe_columns(const Model& model) {
  std::vector<ProbeColumn> columns;
  for (const ModelProbe& probe : model.probes) {
    const Meaning meaning = meaning_of(probe, model);
    for (const std::string& component : components_of(probe.quantity, probe.spatial ? 3 : 2))
      columns.push_back({probe.name + "." + component,
                         meaning.kind == ProbeColumn::Kind::formula ? probe.unit : meaning.unit, meaning.scale,
                         meaning.kind});
  }
  return columns;
}

}  // namespace floe::assembly
