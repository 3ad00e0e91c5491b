#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "readers.h"

namespace floe::scene {
namespace {

/// A material or section as far as the file says, where it stands, and for what.
struct Material {
  std::optional<double> E, nu, G, E1, E2, nu12, G12;
  double rho = 0;
  Where where;
};

Material read_material(Document& document, const Value& value) {
  Reading reading(document, value, "spatial material");
  const auto number = [&](const char* key) { return reading.optional_number(key); };
  Material material{number("E"),    number("nu"),  number("G"),           number("E1"), number("E2"),
                    number("nu12"), number("G12"), reading.number("rho"), value.where};
  const bool orthotropic = material.E1 || material.E2 || material.nu12 || material.G12;
  if (orthotropic && !(material.E1 && material.E2 && material.nu12 && material.G12))
    document.fault(value.where, "is not complete", "E1, E2, nu12 and G12, or E and nu");
  if (orthotropic ? material.E.has_value() : !material.E)
    document.fault(value.where, orthotropic ? "has E besides E1" : "has no E", "E and nu, or E1, E2, nu12 and G12");
  return material;
}

fem::ShellMaterial shell_material(Document& document, const Material& m) {
  if (m.E1) return {*m.E1, m.E2.value_or(NAN), m.nu12.value_or(NAN), m.G12.value_or(NAN), m.rho};
  if (!m.nu) document.fault(m.where, "has no nu", "E and nu for shells");
  return fem::isotropic(m.E.value_or(NAN), m.nu.value_or(NAN), m.rho);
}

fem::Section shell_of(Document& document, Reading& reading, const Material& material, fem::StressPoints& points) {
  const fem::ShellMaterial of = shell_material(document, material);
  std::vector<fem::Ply> plies;
  if (const auto thickness = reading.optional_number("thickness")) plies.push_back({of, *thickness, 0});
  if (const auto value = reading.value("plies")) {
    Key pair = reading.key("plies");
    pair.type = Type::numbers;
    for (const Value& ply : read_list(document, *value, reading.key("plies"))) {
      const auto numbers = read_list(document, ply, pair, 2);
      if (numbers.size() != 2) continue;
      const double t = read_number(document, numbers[0], pair), angle = read_number(document, numbers[1], pair);
      plies.push_back({of, t, angle * M_PI / 180});
    }
  }
  const Point axis = reading.given("axis") ? reading.point("axis") : Point{};
  const double offset = reading.number("offset");
  const fem::ShellSection section = fem::shell_section(plies, offset, Eigen::Vector3d(axis[0], axis[1], axis[2]));
  points.layers = fem::shell_layers(plies, offset);
  return section;
}

fem::SectionShape shape_of(Document& document, Reading& reading) {
  if (reading.given("shape")) return read_shape(document, reading);
  const auto measure = [&](const char* key) {
    const auto number = reading.optional_number(key);
    if (!number) document.fault(reading.where(key), "is missing", describe(reading.key(key)));
    return number.value_or(NAN);
  };
  fem::SectionShape shape;
  shape.A = measure("A"), shape.Iy = measure("Iy"), shape.Iz = measure("Iz"), shape.J = measure("J");
  shape.Iyz = reading.number("Iyz");
  return shape;
}

/// Extreme fibres of a shape, or those that are given.
fem::StressPoints fibres_of(Document& document, Reading& reading) {
  fem::StressPoints points;
  if (const auto given = reading.value("fibres")) {
    Key pair = reading.key("fibres");
    pair.type = Type::numbers;
    for (const Value& fibre : read_list(document, *given, reading.key("fibres")))
      if (const auto at = read_list(document, fibre, pair, 2); at.size() == 2)
        points.fibres.emplace_back(read_number(document, at[0], pair), read_number(document, at[1], pair));
  }
  if (!reading.given("shape")) return points;
  const std::string shape = reading.choice("shape");
  if (shape == "circle" || shape == "tube")
    points.radius = reading.optional_number("radius").value_or(0);
  else
    points.fibres = fem::rectangle_corners(reading.optional_number("width").value_or(0),
                                           reading.optional_number("height").value_or(0));
  return points;
}

fem::Section beam_of(Document& document, Reading& reading, const Material& material, fem::StressPoints& points) {
  const std::size_t before = document.fault_count();
  if (!material.E) document.fault(material.where, "has no E", "E with nu or G for beams");
  if (!material.nu && !material.G) document.fault(material.where, "has neither nu nor G", "one of them for beams");
  const fem::SectionShape shape = shape_of(document, reading);
  const auto centroid = reading.numbers("centroid");
  if (centroid.size() != 2) document.fault(reading.where("centroid"), "does not have two numbers", "[y, z]");
  const std::size_t read = document.fault_count();
  const auto factors = reading.given("shear_factor") ? reading.numbers("shear_factor") : std::vector<double>{};
  const bool positive = factors.size() == 2 && std::min(factors[0], factors[1]) > 0;
  if (reading.given("shear_factor") && !positive && document.fault_count() == read)
    document.fault(reading.where("shear_factor"), "is not two numbers greater than 0", "[y, z]");
  if (!reading.given("orientation"))
    document.fault(reading.where(), "has no orientation", "a vector that orients the section of beams");
  const Point y = reading.given("orientation") ? reading.point("orientation") : Point{};
  points = fibres_of(document, reading);
  if (document.fault_count() != before) return fem::SpatialBeam{};
  points.E = *material.E, points.W = shape.W;
  const double E = *material.E, G = material.G ? *material.G : fem::shear_modulus(E, *material.nu);
  fem::SpatialBeam beam{fem::spatial_section(shape, {E, G, material.rho}, {centroid[0], centroid[1]}),
                        Eigen::Vector3d(y[0], y[1], y[2]),
                        {}};
  beam.strain.wagner = reading.flag("wagner");
  if (!factors.empty()) beam.section.GA = G * shape.A * Eigen::Vector2d(factors[0], factors[1]);
  return beam;
}

/// Keys of the section that belong to what it describes: shells, a shape of beams, or beams by their constants ("A").
std::vector<std::string> keys_of(const std::string& kind) {
  if (kind == "shells") return {"thickness", "plies", "offset", "axis"};
  std::vector<std::string> keys =
      kind == "A" ? std::vector<std::string>{"A", "Iy", "Iz", "Iyz", "J", "fibres"} : shape_keys(kind);
  for (const char* key : {"orientation", "centroid", "shear_factor", "wagner"}) keys.emplace_back(key);
  return keys;
}

fem::Section section_of(Document& document, const Value& value, const Material& material, fem::StressPoints& points) {
  Reading reading(document, value, "spatial section");
  const bool shaped = reading.given("shape");
  const bool shell = !shaped && (reading.given("thickness") || reading.given("plies"));
  const bool beam = shaped || reading.given("A");
  if (shell == beam || (shell && reading.given("thickness") && reading.given("plies")))
    document.fault(value.where, "is a section neither of shells nor of beams, or of both",
                   "thickness or plies (shells), or shape or A (beams)");
  const std::size_t before = document.fault_count();
  if (shell == beam) return fem::SpatialBeam{};
  const std::string shape = shaped ? reading.choice("shape") : "";
  if (document.fault_count() != before) return fem::SpatialBeam{};
  refuse_keys_but(document, reading, schema_section("spatial section").keys,
                  keys_of(shell    ? "shells"
                          : shaped ? shape
                                   : "A"),
                  shell    ? "shells"
                  : shaped ? "shape " + shape
                           : "beams without shape");
  try {
    return shell ? shell_of(document, reading, material, points) : beam_of(document, reading, material, points);
  } catch (const InputError& error) {
    if (document.fault_count() == before) document.fault(value.where, error.what());
  }
  return fem::SpatialBeam{};
}

}  // namespace

std::vector<PartSpec> read_parts(Document& document, Reading& body) {
  std::vector<PartSpec> parts;
  const auto section = body.value("section"), material = body.value("material");
  const auto add = [&](const std::string& name, const std::optional<Value>& of, const std::optional<Value>& made,
                       const Where& where) {
    if (!of) return document.fault(where, "has no section", "section, here or in the body");
    if (!made) return document.fault(where, "has no material", "material, here or in the body");
    const std::size_t before = document.fault_count();
    const Material read = read_material(document, *made);
    if (document.fault_count() != before) return;
    fem::StressPoints points;
    fem::Section made_of = section_of(document, *of, read, points);
    parts.push_back({name, std::move(made_of), of->where, std::move(points)});
  };
  if (const auto named = body.value("parts")) {
    for (const auto& entry : read_mapping(document, *named, describe(body.key("parts")))) {
      Reading part(document, entry.value, "part");
      const auto own = part.value("section"), of = part.value("material");
      add(entry.name, own ? own : section, of ? of : material, entry.where);
    }
  }
  if (section && (material || !body.given("parts"))) add("", section, material, section->where);
  return parts;
}

}  // namespace floe::scene
