#include <fmt/format.h>

#include "readers.h"

namespace floe::scene {
namespace {

struct Material {
  double E, rho;
};

std::optional<Material> read_material(Document& document, Reading& body) {
  const auto value = body.value("material");
  if (!value) return {};
  Reading reading(document, *value, "material");
  return Material{reading.number("E"), reading.number("rho")};
}

// A key that the presence of `material` makes required or senseless.
double number_of(Document& document, Reading& section, const std::string& name, bool applies, bool required) {
  const char* with = applies ? "" : section.key(name).text.ends_with("with material") ? "with" : "without";
  if (section.given(name) && !applies) {
    document.fault(section.where(name), "does not apply here", fmt::format("this key only {} `material`", with));
  } else if (applies && required && !section.given(name)) {
    document.fault(section.where(name), "is missing", describe(section.key(name)));
  }
  return section.optional_number(name).value_or(0);
}

}  // namespace

Section read_section(Document& document, Reading& body, bool rigid) {
  Section section;
  const auto material = read_material(document, body);
  const auto value = body.value("section");
  if (!value) document.fault(body.where("section"), "is missing", describe(body.key("section")));
  if (!value) return section;
  section.where = value->where;
  Reading reading(document, *value, "section");
  if (!value->node.IsMap()) return section;
  const bool direct = !material;
  const double A = number_of(document, reading, "A", !direct, true);
  const double I = number_of(document, reading, "I", !direct, !rigid);
  section.EA = number_of(document, reading, "EA", direct, !rigid);
  section.EI = number_of(document, reading, "EI", direct, !rigid);
  section.rhoA = number_of(document, reading, "rhoA", direct, true);
  if (material) {
    section.EA = material->E * A;
    section.EI = material->E * I;
    section.rhoA = material->rho * A;
  }
  if (material) section.E = material->E;
  section.fibre = number_of(document, reading, "fibre", !direct, false);
  section.GA = reading.optional_number("GA");
  section.rhoI = reading.optional_number("rhoI").value_or(material ? material->rho * I : 0.0);
  return section;
}

}  // namespace floe::scene
