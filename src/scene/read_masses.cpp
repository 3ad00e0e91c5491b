#include "readers.h"

namespace floe::scene {

std::vector<MassSpec> read_masses(Document& document, Reading& body, const std::string& name) {
  std::vector<MassSpec> masses;
  const auto named = body.value("masses");
  if (!named) return masses;
  for (const auto& entry : read_mapping(document, *named, describe(body.key("masses")))) {
    Reading reading(document, entry.value, "mass");
    MassSpec mass;
    mass.name = entry.name;
    mass.where = entry.where;
    if (const auto at = reading.value("at")) mass.at = read_own_place(document, *at, reading.key("at"), name);
    mass.mass = reading.number("mass");
    mass.inertia = read_inertia(document, reading);
    if (reading.given("offset")) mass.offset = reading.point("offset");
    masses.push_back(std::move(mass));
  }
  return masses;
}

}  // namespace floe::scene
