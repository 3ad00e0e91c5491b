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

struct Shape {
  double A = 0, I = 0, fibre = 0;
};

/// Of a shape whose height lies in the plane.
Shape shape_of(Document& document, Reading& reading, bool with_material) {
  const std::size_t before = document.fault_count();
  const std::string shape = reading.choice("shape");
  if (!with_material) document.fault(reading.where("shape"), "does not apply here", "this key only with `material`");
  if (document.fault_count() != before) return {};
  std::vector<std::string> keys = shape_keys(shape);
  keys.emplace_back("rhoI"), keys.emplace_back("GA");
  refuse_keys_but(document, reading, schema_section("section").keys, keys, "shape " + shape);
  try {
    const fem::SectionShape of = read_shape(document, reading);
    const double radius = reading.optional_number("radius").value_or(0);
    return {of.A, of.Iy, radius > 0 ? radius : reading.optional_number("height").value_or(0) / 2};
  } catch (const InputError& error) {
    if (document.fault_count() == before) document.fault(reading.where(), error.what());
  }
  return {};
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
  if (reading.given("shape")) {
    const Shape shape = shape_of(document, reading, !direct);
    section.GA = reading.optional_number("GA");
    if (direct) return section;
    section.EA = material->E * shape.A, section.EI = material->E * shape.I, section.rhoA = material->rho * shape.A;
    section.rhoI = reading.optional_number("rhoI").value_or(material->rho * shape.I);
    section.E = material->E, section.fibre = shape.fibre;
    return section;
  }
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
