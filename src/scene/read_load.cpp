#include "readers.h"

namespace floe::scene {

Load read_load(Document& document, const std::string& name, const Value& value) {
  using Kind = Load::Kind;
  Load load;
  load.name = name;
  load.where = value.where;
  Reading reading(document, value, "load");
  if (!value.node.IsMap()) return load;
  const std::size_t before = document.fault_count();
  load.kind = reading.choice<Kind>("type", {{"force", Kind::force},
                                            {"moment", Kind::moment},
                                            {"distributed", Kind::distributed},
                                            {"pressure", Kind::pressure}});
  if (document.fault_count() != before) return load;  // which keys it needs is unknown
  if (load.kind == Kind::pressure && document.dimension == 2) {
    document.fault(reading.where("type"), "is pressure", "force, moment or distributed in a planar scene");
    return load;
  }
  reading.set_kind(reading.text("type"));
  if (load.kind == Kind::pressure) {
    load.body = reading.text("body");
    load.part = reading.text("part");
    load.pressure = reading.formula("pressure");
    load.follower = reading.flag("follower");
    return load;
  }
  if (load.kind == Kind::distributed) {
    load.body = reading.text("body");
  } else if (const std::string on = reading.one_of({"at", "joint"}); on == "at") {
    load.at = read_place(document, *reading.value("at"), reading.key("at"));
  } else if (on == "joint") {
    load.joint = reading.text("joint");
    load.on_joint = reading.formula(load.kind == Kind::moment ? "moment" : "force");
    for (const char* key : {"axes", "per", "shape"})
      if (reading.given(key))
        document.fault(reading.where(key), "does not apply to a load on a joint", std::string(key) + " only with at");
    return load;
  } else {
    return load;
  }
  if (load.kind == Kind::moment)
    load.moment = reading.moment("moment");
  else
    load.force = reading.force("force");
  load.axes = reading.choice<Load::Axes>(
      "axes", {{"world", Load::Axes::world}, {"body", Load::Axes::body}, {"place", Load::Axes::place}});
  if (load.axes == Load::Axes::place && load.kind == Kind::distributed)
    document.fault(reading.where("axes"), "is place", "place only for a force or moment at a place");
  load.per = reading.choice<Load::Per>(
      "per", {{"whole", Load::Per::whole}, {"length", Load::Per::length}, {"area", Load::Per::area}});
  if (reading.given("shape")) {
    load.shape = read_formula(document, *reading.value("shape"), reading.key("shape"), {"x", "y", "z"});
    if (load.per == Load::Per::whole)
      document.fault(reading.where("shape"), "is given without per", "per: length or per: area");
  }
  return load;
}

}  // namespace floe::scene
