#include <Eigen/Geometry>
#include <algorithm>

#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

// The material that *ELASTIC or *DENSITY belongs to.
Material* current(const InpBlock& block, InpReading& reading) {
  if (!reading.deck.materials.empty()) return &reading.deck.materials.back();
  reading.faults.add(block.where, block.name + " precedes any *MATERIAL");
  return nullptr;
}

constexpr std::size_t most_lines = 1000;  // of a material's constants, each at one temperature

void report_temperatures(const InpBlock& block, long long temperatures, InpReading& reading) {
  if (temperatures > 1)
    reading.notices.push_back(reading.faults.text_of(block.where) + ": " + block.name + " is given at " +
                              std::to_string(temperatures) + " temperatures: the first is used");
}

bool positive(const std::vector<double>& values, std::initializer_list<int> which) {
  for (const int i : which)
    if (!(values[i] > 0)) return false;
  return true;
}

// Nine constants, of which a line may end after any; then the temperature.
std::optional<std::vector<double>> engineering_constants(const InpBlock& block, InpReading& reading) {
  constexpr std::size_t count = 9;
  const char* what = "E1 E2 E3 nu12 nu13 nu23 G12 G13 G23[, temperature] on two lines";
  const auto lines = data_lines(block, 1, most_lines, what, reading.faults);
  if (lines.empty()) return std::nullopt;
  std::vector<double> values;
  std::size_t used = 0;
  while (values.size() < count && used < lines.size()) {
    const auto more =
        numbers(lines[used].second, lines[used].first, 1, count + 1 - values.size(), what, reading.faults);
    if (!more) return std::nullopt;
    values.insert(values.end(), more->begin(), more->end()), ++used;
  }
  if (values.size() < count) reading.faults.add(block.where, block.name + " expects " + what);
  if (values.size() < count) return std::nullopt;
  values.resize(count);
  report_temperatures(block, std::ssize(lines) / static_cast<long long>(used), reading);
  if (positive(values, {0, 1, 2, 6, 7, 8})) return values;
  reading.faults.add(lines[0].first, "moduli of " + block.name + " must be greater than 0");
  return std::nullopt;
}

std::optional<std::vector<double>> one_line(const InpBlock& block, std::size_t count, const char* what,
                                            std::initializer_list<int> moduli, InpReading& reading) {
  const auto lines = data_lines(block, 1, most_lines, what, reading.faults);
  if (lines.empty()) return std::nullopt;
  report_temperatures(block, block.lines(), reading);
  auto values = numbers(lines[0].second, lines[0].first, count, count + 1, what, reading.faults);
  if (!values) return std::nullopt;
  values->resize(count);
  if (positive(*values, moduli)) return values;
  reading.faults.add(lines[0].first, block.name + ": " + (count > 1 ? "moduli among " : "") + what +
                                         " must be greater than 0, found " + in_quotes(lines[0].second));
  return std::nullopt;
}

}  // namespace

void read_material(const InpBlock& block, InpReading& reading) {
  Material material;
  material.name = required(block, "NAME", reading);
  for (const auto& other : reading.deck.materials)
    if (upper(other.name) == upper(material.name))
      reading.faults.add(block.where, "material " + in_quotes(material.name) + " is defined a second time");
  reading.deck.materials.push_back(material);
}

void read_elastic(const InpBlock& block, InpReading& reading) {
  Material* material = current(block, reading);
  if (!material) return;
  if (!material->constants.empty())
    reading.faults.add(block.where, "material " + in_quotes(material->name) + " has a second *ELASTIC");
  const auto found = block.parameters.find("TYPE");
  const std::string type = found == block.parameters.end() ? "ISO" : folded(found->second);
  std::optional<std::vector<double>> constants;
  if (type == "ISO" || type == "ISOTROPIC") {
    material->elasticity = Elasticity::isotropic;
    constants = one_line(block, 2, "E, nu", {0}, reading);
    if (constants && !((*constants)[1] > -1 && (*constants)[1] <= 0.5))
      reading.faults.add(block.where, block.name + " expects nu between -1 and 1/2");
  } else if (type == "ENGINEERINGCONSTANTS") {
    material->elasticity = Elasticity::engineering_constants;
    constants = engineering_constants(block, reading);
  } else if (type == "LAMINA") {
    material->elasticity = Elasticity::lamina;
    constants = one_line(block, 6, "E1, E2, nu12, G12, G13, G23", {0, 1, 3, 4, 5}, reading);
  } else {
    reading.faults.add(block.where, block.name + " is read with TYPE=ISO, ENGINEERING CONSTANTS or LAMINA, not " +
                                        in_quotes(found->second));
  }
  if (constants) material->constants = *constants;
}

void read_density(const InpBlock& block, InpReading& reading) {
  Material* material = current(block, reading);
  if (!material) return;
  const auto density = one_line(block, 1, "a density", {0}, reading);
  if (density) material->density = density->front();
}

void read_orientation(const InpBlock& block, InpReading& reading) {
  auto& faults = reading.faults;
  Orientation orientation{reading.scopes.own(required(block, "NAME", reading), InpName::orientation), {}, {}, 0, 0};
  const auto is_it = [&](const auto& other) { return upper(other.name) == upper(orientation.name); };
  if (std::any_of(reading.deck.orientations.begin(), reading.deck.orientations.end(), is_it) ||
      std::any_of(reading.cylinders.begin(), reading.cylinders.end(), is_it))
    faults.add(block.where, "orientation " + in_quotes(orientation.name) + " is defined a second time");
  const auto system = block.parameters.find("SYSTEM"), definition = block.parameters.find("DEFINITION");
  const std::string kind = system == block.parameters.end() ? "RECTANGULAR" : upper(system->second);
  if (kind != "RECTANGULAR" && kind != "CYLINDRICAL")
    return faults.add(block.where, block.name + " is read with SYSTEM=RECTANGULAR or CYLINDRICAL only");
  if (definition != block.parameters.end() && upper(definition->second) != "COORDINATES")
    return faults.add(block.where, block.name + " is read with DEFINITION=COORDINATES only");
  const auto lines = data_lines(block, 1, 2, "two points, and perhaps an axis and an angle", faults);
  if (lines.empty()) return;
  const auto points = numbers(lines[0].second, lines[0].first, 4, 6, "two points of three coordinates", faults);
  if (!points) return;
  auto p = *points;
  p.resize(6, 0.0);
  orientation.a = {p[0], p[1], p[2]};
  orientation.b = {p[3], p[4], p[5]};
  const bool cylindrical = kind == "CYLINDRICAL";
  if (cylindrical && !((orientation.b - orientation.a).norm() > 0))
    faults.add(lines[0].first, "the axis of a cylindrical orientation has no length");
  if (!cylindrical && orientation.a.cross(orientation.b).norm() <= 1e-12 * orientation.a.norm() * orientation.b.norm())
    faults.add(lines[0].first, "the points of an orientation lie on one line with the origin");
  if (lines.size() == 2) {
    const auto rotation = numbers(lines[1].second, lines[1].first, 1, 2, "an axis (1, 2, 3) and an angle", faults);
    if (!rotation) return;
    const double axis = rotation->front();
    orientation.angle = rotation->size() > 1 ? (*rotation)[1] : 0.0;
    if (axis == 1 || axis == 2 || axis == 3)
      orientation.axis = static_cast<int>(axis);
    else
      faults.add(lines[1].first, "expected an axis (1, 2, 3) and an angle, found " + in_quotes(lines[1].second));
  }
  if (cylindrical)
    reading.cylinders.push_back({orientation.name, block.where, orientation.a, orientation.b,
                                 orientation.axis == 0 ? 1 : orientation.axis, orientation.angle});
  else
    reading.deck.orientations.push_back(orientation);
}

}  // namespace floe::mesh
