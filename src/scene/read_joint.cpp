#include <cmath>

#include "readers.h"

namespace floe::scene {

Joint read_joint(Document& document, const std::string& name, const Value& value) {
  using Kind = Joint::Kind;
  Joint joint;
  joint.name = name;
  joint.where = value.where;
  Reading reading(document, value, "joint");
  if (!value.node.IsMap()) return joint;
  const std::size_t before = document.fault_count();
  joint.kind = reading.choice<Kind>("type", {{"fixed", Kind::fixed},
                                             {"revolute", Kind::revolute},
                                             {"prismatic", Kind::prismatic},
                                             {"driven", Kind::driven},
                                             {"spring", Kind::spring}});
  const bool known = document.fault_count() == before;
  if (known && document.dimension == 3 && joint.kind != Kind::fixed && joint.kind != Kind::revolute)
    document.fault(reading.where("type"), "is " + reading.text("type"), "fixed or revolute in a scene in space");
  if (known) reading.set_kind(reading.text("type"));
  if (const auto between = reading.value("between")) {
    const auto places = read_list(document, *between, reading.key("between"), 2);
    if (places.size() == 2) {
      joint.first = read_place(document, places[0], reading.key("between"));
      joint.second = read_place(document, places[1], reading.key("between"));
    }
  }
  if (known && joint.kind == Kind::driven) joint.angle = reading.formula("angle");
  if (reading.given("axis")) joint.axis = reading.point("axis");
  if (joint.axis == Point{})
    document.fault(reading.where("axis"), document.dimension == 2 ? "is [0, 0]" : "is [0, 0, 0]", "a direction");
  joint.stiffness = reading.number("stiffness");
  joint.viscosity = reading.number("viscosity");
  joint.length = reading.optional_number("length");
  joint.torsional_stiffness = reading.number("torsional_stiffness");
  joint.torsional_viscosity = reading.number("torsional_viscosity");
  return joint;
}

}  // namespace floe::scene
