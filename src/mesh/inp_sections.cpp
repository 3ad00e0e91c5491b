#include <cmath>

#include "deck_file.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

std::string value_of(const InpBlock& block, const std::string& key) {
  const auto found = block.parameters.find(key);
  return found == block.parameters.end() ? "" : found->second;
}

double number_of(const InpBlock& block, const std::string& key, InpReading& reading) {
  const std::string text = value_of(block, key);
  if (text.empty()) return 0;
  if (upper(text) == "SPOS") return 0.5;
  if (upper(text) == "SNEG") return -0.5;
  if (const auto value = fortran_number(text); value && std::isfinite(*value)) return *value;
  reading.faults.add(block.where, block.name + " expects a number after " + key + "=, found " + in_quotes(text));
  return 0;
}

std::string set_of(const InpBlock& block, InpUse::Kind kind, InpReading& reading) {
  std::string set = reading.scopes.own(required(block, "ELSET", reading), InpName::elements);
  if (!set.empty()) reading.uses.push_back({kind, set, block.where, 0});
  return set;
}

void use_orientation(const std::string& name, Where where, InpReading& reading) {
  if (!name.empty()) reading.orientations_used.emplace_back(name, where);
}

std::optional<Ply> ply(std::string_view line, Where where, InpReading& reading) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  fields.resize(std::max<std::size_t>(fields.size(), 4));
  const auto thickness = fortran_number(fields[0]);
  if (!thickness || !(*thickness > 0) || fields[2].empty() || fields.size() > 5) {
    reading.faults.add(where,
                       "a ply is: thickness, (points), material[, angle or orientation], found " + in_quotes(line));
    return std::nullopt;
  }
  Ply result{*thickness, std::string(fields[2]), "", 0};
  if (const auto angle = fortran_number(fields[3]))
    result.angle = *angle;
  else
    result.orientation = reading.scopes.own(std::string(fields[3]), InpName::orientation);
  reading.materials_used.emplace_back(result.material, where);
  use_orientation(result.orientation, where, reading);
  return result;
}

// Dimensions of a profile: how many, and what they are called.
struct Shape {
  const char* name;
  Profile profile;
  std::size_t least, most;
  const char* dimensions;
};
constexpr Shape shapes[] = {{"RECT", Profile::rectangle, 1, 2, "a, b"},
                            {"CIRC", Profile::circle, 1, 2, "a radius, or the diameters along 1 and 2"},
                            {"PIPE", Profile::pipe, 2, 2, "outer radius, wall"},
                            {"THICK PIPE", Profile::pipe, 2, 2, "outer radius, wall"},
                            {"BOX", Profile::box, 6, 6, "a, b, t1, t2, t3, t4"},
                            {"I", Profile::i_section, 7, 7, "l, h, b1, b2, t1, t2, t3"}};

void refuse_bad_dimensions(const BeamSection& section, Where where, Faults& faults) {
  const auto& d = section.dimensions;
  bool good = true;
  for (std::size_t i = 0; i < d.size(); ++i)
    good = good && std::isfinite(d[i]) && (d[i] > 0 || (section.profile == Profile::i_section && i == 0));
  if (section.profile == Profile::pipe) good = good && d[1] <= d[0];
  if (section.profile == Profile::box) good = good && d[3] + d[5] < d[1] && d[2] + d[4] < d[0];
  if (section.profile == Profile::i_section) good = good && d[4] + d[5] < d[1];
  if (!good)
    faults.add(where, "the dimensions are inconsistent: they must be greater than 0, walls thinner than the section");
}

void read_direction(const std::pair<Where, std::string_view>& line, BeamSection& section, Faults& faults) {
  const auto n = numbers(line.second, line.first, 1, 3, "the direction of the local 1-axis", faults);
  if (!n) return;
  section.direction_1.setZero();
  for (std::size_t i = 0; i < n->size(); ++i) section.direction_1[static_cast<Eigen::Index>(i)] = (*n)[i];
  if (!(section.direction_1.norm() > 0)) faults.add(line.first, "the direction of the local 1-axis has no length");
}

BeamSection named_beam(const BeamSection& plain, const InpBlock& block, InpReading& reading) {
  BeamSection section = plain;
  reading.last_shell = -1;
  section.part = set_of(block, InpUse::beam, reading);
  section.number = next_part(reading.deck);
  section.offset_1 = number_of(block, "OFFSET1", reading);
  section.offset_2 = number_of(block, "OFFSET2", reading);
  return section;
}

void add_section(const ShellSection& section, InpReading& reading) {
  reading.last_shell = static_cast<int>(reading.deck.shell_sections.size());
  reading.deck.shell_sections.push_back(section);
}

}  // namespace

void read_shell_section(const InpBlock& block, InpReading& reading) {
  ShellSection section{set_of(block, InpUse::shell, reading),
                       next_part(reading.deck),
                       reading.scopes.own(value_of(block, "ORIENTATION"), InpName::orientation),
                       number_of(block, "OFFSET", reading),
                       {}};
  use_orientation(section.orientation, block.where, reading);
  section.added_mass = number_of(block, "DENSITY", reading);
  if (section.added_mass < 0)
    reading.faults.add(block.where, block.name + " expects 0 or a positive mass per area after DENSITY=");
  if (const std::string stack = value_of(block, "STACKDIRECTION"); !stack.empty() && stack != "3")
    reading.faults.add(block.where, block.name + " is read with STACK DIRECTION=3, not " + in_quotes(stack));
  if (block.parameters.contains("NODALTHICKNESS")) reading.nodal.push_back(section.number);
  if (block.parameters.contains("COMPOSITE")) {
    constexpr std::size_t most_plies = 1000;
    for (const auto& [where, line] : data_lines(block, 1, most_plies, "a line for each ply", reading.faults))
      if (const auto layer = ply(line, where, reading)) section.plies.push_back(*layer);
    if (block.parameters.contains("SYMMETRIC"))
      for (std::size_t i = section.plies.size(); i-- > 0;) section.plies.push_back(Ply(section.plies[i]));
  } else {
    const std::string material = required(block, "MATERIAL", reading);
    if (!material.empty()) reading.materials_used.emplace_back(material, block.where);
    for (const auto& [where, line] : data_lines(block, 1, 1, "a thickness", reading.faults)) {
      const auto values = numbers(line, where, 1, 2, "a thickness[, points]", reading.faults);
      if (values && !(values->front() > 0)) reading.faults.add(where, "a thickness must be greater than 0");
      if (values) section.plies.push_back({values->front(), material, "", 0});
    }
  }
  add_section(section, reading);
}

namespace {

// The upper triangle of the stiffness, column by column, eight numbers on a line: 11 12 22 13 23 33 14 24, ...
std::optional<Eigen::Matrix<double, 6, 6>> stiffness_of(const InpBlock& block, InpReading& reading) {
  constexpr std::size_t lines_of_numbers = 3, on_line = 8, on_last = 5;
  const char* what = "the 21 numbers of a stiffness: 8, 8 and 5 on three lines";
  const auto lines = data_lines(block, lines_of_numbers, lines_of_numbers + 1, what, reading.faults);
  if (lines.empty()) return std::nullopt;
  std::vector<double> all;
  for (std::size_t i = 0; i < lines_of_numbers; ++i) {
    const std::size_t count = i + 1 < lines_of_numbers ? on_line : on_last;
    auto values = numbers(lines[i].second, lines[i].first, 1, count, what, reading.faults);
    if (!values) return std::nullopt;
    values->resize(count);  // those at the end that are empty are 0
    all.insert(all.end(), values->begin(), values->end());
  }
  if (lines.size() > lines_of_numbers)
    reading.notices.push_back(reading.faults.text_of(lines.back().first) + ": " + block.name +
                              ": thermal forces are ignored: heat and other fields do not concern the body");
  Eigen::Matrix<double, 6, 6> S;
  auto next = all.begin();
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i) S(i, j) = S(j, i) = *next++;
  return S;
}

}  // namespace

// By a material or plies as *SHELL SECTION, else by numbers.
void read_shell_general_section(const InpBlock& block, InpReading& reading) {
  if (block.parameters.contains("MATERIAL") || block.parameters.contains("COMPOSITE")) {
    if (block.parameters.contains("DENSITY"))
      reading.faults.add(block.where, block.name + " with a material is read without DENSITY=: expected *DENSITY");
    return read_shell_section(block, reading);
  }
  ShellSection section{set_of(block, InpUse::shell, reading),
                       next_part(reading.deck),
                       reading.scopes.own(value_of(block, "ORIENTATION"), InpName::orientation),
                       0,
                       {}};
  use_orientation(section.orientation, block.where, reading);
  if (block.parameters.contains("OFFSET"))
    reading.faults.add(block.where, block.name + " by its stiffness has no thickness, and is read without OFFSET=");
  const auto values = stiffness_of(block, reading);
  section.stiffness = ShellStiffness{values.value_or(Eigen::Matrix<double, 6, 6>::Identity()), {}};
  if (block.parameters.contains("DENSITY")) section.stiffness->density = number_of(block, "DENSITY", reading);
  if (section.stiffness->density.value_or(0) < 0)
    reading.faults.add(block.where, block.name + " expects 0 or a positive mass per area after DENSITY=, found " +
                                        in_quotes(value_of(block, "DENSITY")));
  add_section(section, reading);
}

// Of the section before it: K11, K22, K12.
void read_transverse_shear(const InpBlock& block, InpReading& reading) {
  if (reading.last_shell < 0) return ignore(block, "beams have no shear deformation", reading);
  const auto lines = data_lines(block, 1, 1, "K11, K22, K12", reading.faults);
  if (lines.empty()) return;
  const auto k = numbers(lines[0].second, lines[0].first, 1, 8, "K11, K22, K12", reading.faults);
  if (!k) return;
  const double first = (*k)[0], second = k->size() > 1 ? (*k)[1] : first, mixed = k->size() > 2 ? (*k)[2] : 0;
  if (!(first > 0 && second > 0))
    return reading.faults.add(lines[0].first, block.name + " expects K11 and K22 greater than 0");
  const bool equal = std::abs(first - second) <= 1e-3 * first && mixed == 0;
  reading.deck.shell_sections[static_cast<std::size_t>(reading.last_shell)].shear = (first + second) / 2;
  reading.notices.push_back(reading.faults.text_of(lines[0].first) + ": " + block.name + ": elements of second order " +
                            "shear by " + (equal ? "K11" : "the mean of K11 and K22, in all directions") +
                            ", those of first order do not shear");
}

/// The material of a *BEAM GENERAL SECTION, or its own density. @return its moduli are on its third line
bool read_general_material(const InpBlock& block, BeamSection& section, InpReading& reading) {
  section.material = value_of(block, "MATERIAL");
  if (!section.material.empty()) reading.materials_used.emplace_back(section.material, block.where);
  if (block.parameters.contains("DENSITY")) section.density = number_of(block, "DENSITY", reading);
  if (section.density.value_or(0) < 0)
    reading.faults.add(block.where, block.name + " expects 0 or a positive number after DENSITY=, found " +
                                        in_quotes(value_of(block, "DENSITY")));
  return section.material.empty();
}

void read_moduli(const std::pair<Where, std::string_view>& line, BeamSection& section, Faults& faults) {
  const auto moduli = numbers(line.second, line.first, 2, 4, "E, G", faults);
  if (!moduli) return;
  section.youngs = (*moduli)[0];
  section.shear = (*moduli)[1];
  if (!(section.youngs > 0 && section.shear > 0)) faults.add(line.first, "E and G must be greater than 0");
}

// Sections of a named shape, by *BEAM SECTION, or by *BEAM GENERAL SECTION (Abaqus: with E and G, CalculiX: with a
// material).
void read_shape(const InpBlock& block, InpReading& reading) {
  BeamSection section = named_beam({}, block, reading);
  bool own = false;
  if (block.keyword == "BEAMSECTION") {
    section.material = required(block, "MATERIAL", reading);
    if (!section.material.empty()) reading.materials_used.emplace_back(section.material, block.where);
  } else {
    own = read_general_material(block, section, reading);
  }
  const std::string name = upper(required(block, "SECTION", reading));
  if (block.parameters.contains("NODALTHICKNESS"))
    reading.faults.add(block.where, block.name +
                                        " is read without NODAL THICKNESS: expected uniform beams, whose "
                                        "dimensions are on its data line");
  const Shape* shape = nullptr;
  for (const auto& candidate : shapes)
    if (name == candidate.name || ((name == "RECTANGULAR" || name == "CIRCULAR") && name.starts_with(candidate.name)))
      shape = &candidate;
  if (!shape)
    return reading.faults.add(block.where,
                              block.name + " is read with SECTION=RECT, CIRC, PIPE, BOX or I" +
                                  (block.keyword == "BEAMSECTION" ? "" : ", or GENERAL") +
                                  (name.starts_with("ELLIP") ? "; an ellipse is CIRC with two diameters" : ""));
  section.profile = shape->profile;
  const auto lines = own ? data_lines(block, 3, 3, "dimensions, a direction, and E G", reading.faults)
                         : data_lines(block, 1, 2, "dimensions and perhaps a direction", reading.faults);
  if (lines.empty()) return;
  const auto values =
      numbers(lines[0].second, lines[0].first, shape->least, shape->most, shape->dimensions, reading.faults);
  if (!values) return;
  section.dimensions = *values;
  if (section.profile == Profile::circle && values->size() == 2) {
    for (double& d : section.dimensions) d /= 2;
    if (section.dimensions[0] == section.dimensions[1]) section.dimensions.pop_back();
  }
  if (section.profile == Profile::circle && values->size() == 1)
    reading.notices.push_back(reading.faults.text_of(lines[0].first) + ": " + block.name +
                              " of a circle has one dimension: it is read as the radius (Abaqus), which CalculiX takes "
                              "for the diameter; give both diameters for the same section in both");
  if (section.profile == Profile::rectangle && values->size() == 1) {
    section.dimensions.push_back(values->front());
    reading.notices.push_back(reading.faults.text_of(lines[0].first) + ": " + block.name +
                              " has one dimension: it is read as a square");
  }
  refuse_bad_dimensions(section, lines[0].first, reading.faults);
  if (lines.size() > 1) read_direction(lines[1], section, reading.faults);
  if (own) read_moduli(lines[2], section, reading.faults);
  reading.deck.beam_sections.push_back(section);
}

void read_beam_section(const InpBlock& block, InpReading& reading) { read_shape(block, reading); }

void read_beam_general_section(const InpBlock& block, InpReading& reading) {
  auto& faults = reading.faults;
  const std::string shape = value_of(block, "SECTION");
  if (!shape.empty() && upper(shape) != "GENERAL") return read_shape(block, reading);
  BeamSection section = named_beam({}, block, reading);
  section.profile = Profile::general;
  const bool own = read_general_material(block, section, reading);
  const auto lines =
      data_lines(block, own ? 3 : 1, own ? 3 : 2,
                 own ? "A I11 I12 I22 J, a direction, and E G" : "A I11 I12 I22 J, and a direction", faults);
  if (lines.empty()) return;
  const auto values = numbers(lines[0].second, lines[0].first, 5, 5, "A, I11, I12, I22, J", faults);
  if (!values) return;
  section.dimensions = *values;
  const auto& d = section.dimensions;
  if (!(d[0] > 0 && d[1] > 0 && d[3] > 0 && d[4] > 0 && d[1] * d[3] > d[2] * d[2]))
    faults.add(lines[0].first, "A, I11, I22, J and I11 I22 - I12^2 must be greater than 0");
  if (lines.size() > 1) read_direction(lines[1], section, faults);
  if (own) read_moduli(lines[2], section, faults);
  reading.deck.beam_sections.push_back(section);
}

}  // namespace floe::mesh
