#include <fmt/format.h>

#include "readers.h"

namespace floe::scene {
namespace {

std::string coordinates(const Document& document) { return document.dimension == 3 ? "[x, y, z]" : "[x, y]"; }

}  // namespace

Place read_place(Document& document, const Value& value, const Key& key) {
  Place place;
  place.where = value.where;
  if (value.node.IsMap()) {
    Reading reading(document, value, "place");
    const std::size_t before = document.fault_count();
    const std::string body = reading.text("body");
    place.point = reading.point("node");
    if (document.fault_count() == before) place.body = body;
    return place;
  }
  const std::string text = value.node.IsScalar() ? value.node.Scalar() : "";
  const auto dot = text.find('.');
  if (text == "ground") {
    place.body = text;
  } else if (text.starts_with("ground.")) {
    document.fault(value.where, shown(value.node) + ", but the ground has no named places",
                   "ground or {body: ground, node: " + coordinates(document) + "}");
  } else if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) {
    document.fault(value.where, shown(value.node),
                   key.type == Type::places
                       ? "a place (BODY.NAME, ground, or {body: BODY, node: " + coordinates(document) + "})"
                       : describe(key, document.dimension));
  } else {
    place.body = text.substr(0, dot);
    place.name = text.substr(dot + 1);
  }
  return place;
}

Place read_own_place(Document& document, const Value& value, const Key& key, const std::string& body) {
  Place place;
  place.body = body;
  place.where = value.where;
  if (value.node.IsSequence()) {
    const std::size_t before = document.fault_count();
    place.point = read_point(document, value, key);
    if (document.fault_count() != before) place.body.clear();
  } else if (value.node.IsScalar()) {
    place.name = value.node.Scalar();
  } else {
    document.fault(value.where, shown(value.node), describe(key, document.dimension));
    place.body.clear();
  }
  return place;
}

}  // namespace floe::scene
