#include <algorithm>
#include <cmath>

#include "nas_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// What one card adds to the model.
struct Reader {
  NasFields& card;
  NasModel& model;

  Where where() const { return card.card.where(); }
  std::string named(const char* kind, long long id) const { return kind + std::to_string(id); }
  template <class Map, class Value>
  void define(Map& map, long long id, Value&& value, const char* what) {
    if (card.good() && !map.emplace(id, std::forward<Value>(value)).second)
      card.refuse_card(std::string("defines ") + what + " " + std::to_string(id) + " a second time");
  }
};

void read_grid(Reader& r) {
  NasGrid grid{r.card.integer(0, "the grid's number"),
               r.card.integer(1, "axes (CP)", -1),
               r.card.integer(5, "axes (CD)", -1),
               {},
               r.where()};
  for (int i = 0; i < 3; ++i) grid.x[i] = r.card.real(2 + i, "a coordinate", 0);
  if (!r.card.card.blank(6)) {
    r.model.supports[0].emplace_back(grid.id, grid.where);
    r.model.ignored.try_emplace("GRID PS", NasCount{r.where(), 0}).first->second.times++;
  }
  if (r.card.good()) r.model.grids.push_back(grid);
}

void read_axes(Reader& r) {
  const std::string& name = r.card.card.name;
  const bool by_grids = name[4] == '1';
  for (std::size_t first = 0; first < (by_grids ? 8 : 1); first += 4) {
    if (first > 0 && r.card.card.blank(first)) break;
    const long long id = r.card.integer(first, "the number of the axes");
    NasAxes axes{name.back(), -1, {}, {}, r.where()};
    if (by_grids) {
      for (int i = 0; i < 3; ++i) axes.grids[i] = r.card.integer(first + 1 + i, "a grid");
    } else {
      axes.reference = std::max(0LL, r.card.integer(1, "axes (RID)", 0));
      for (int i = 0; i < 9; ++i) axes.points[i / 3][i % 3] = r.card.real(2 + i, "a coordinate", 0);
    }
    r.define(r.model.axes, id, axes, "axes");
  }
}

void read_shell(Reader& r) {
  const bool four = r.card.card.name.starts_with("CQUAD");
  NasShell shell{
      r.card.integer(0, "the element's number"), 0, {-1, -1, -1, -1}, four ? 4 : 3, 0, -1, 0, 0, false, r.where()};
  shell.property = r.card.card.blank(1) ? shell.id : r.card.integer(1, "a property");
  for (int i = 0; i < shell.count; ++i) shell.nodes[i] = r.card.integer(2 + i, "a grid");
  const std::size_t after = 2 + shell.count;
  if (r.card.is_integer(after))
    shell.axes = std::max(0LL, r.card.integer(after, "axes (MCID)", 0));
  else
    shell.angle = r.card.real(after, "an angle (THETA) or axes (MCID)", 0);
  shell.offset = r.card.real(after + 1, "an offset (ZOFFS)", 0);
  shell.ratio = r.card.integer(9, "0 or 1 (TFLAG)", 0) == 1;
  int given = 0;
  for (int i = 0; i < shell.count; ++i) {
    given += !r.card.card.blank(10 + i);
    shell.thickness += r.card.real(10 + i, "a thickness", 0) / shell.count;
  }
  if (given > 0 && given < shell.count)
    r.card.refuse(10, "to " + std::to_string(10 + shell.count + 3) + ": expected a thickness at each grid, or at none");
  if (given > 0) r.model.ignored.try_emplace("corner thicknesses", NasCount{r.where(), 0}).first->second.times++;
  if (shell.thickness < 0) r.card.refuse(10, "expects thicknesses greater than 0");
  if (r.card.good()) r.model.shells.push_back(shell);
}

// X1, X2, X3 or G0 in fields 6 to 8 of a beam, or of the defaults for beams.
void read_orientation_of(NasFields& card, NasBeam& beam) {
  if (card.is_integer(4) && card.card.blank(5) && card.card.blank(6)) {
    beam.orientation_node = card.integer(4, "a grid (G0)");
    return;
  }
  for (int i = 0; i < 3; ++i) beam.orientation[i] = card.real(4 + i, "a component of the orientation vector", 0);
}

void read_beam(Reader& r) {
  NasBeam beam{r.card.integer(0, "the element's number"), 0, {}, Eigen::Vector3d::Zero(), 0, {}, r.where()};
  const auto found = r.model.defaults.find(r.card.card.name == "CBAR" ? "BAROR" : "BEAMOR");
  const NasCard* otherwise = found == r.model.defaults.end() ? nullptr : &found->second;
  if (!r.card.card.blank(1))
    beam.property = r.card.integer(1, "a property");
  else if (otherwise && !otherwise->blank(1))
    beam.property = number<long long>(otherwise->text(1)).value_or(beam.id);
  else
    beam.property = beam.id;
  for (int i : {0, 1}) beam.nodes[i] = r.card.integer(2 + i, "a grid");
  const auto& card = r.card.card;
  if (card.blank(4) && card.blank(5) && card.blank(6) && otherwise) {
    NasFields fields(*otherwise, r.card.faults());
    read_orientation_of(fields, beam);
  } else {
    read_orientation_of(r.card, beam);
  }
  const std::string offt = upper(card.text(7));
  if (!offt.empty() && offt != "GGG" && number<double>(offt).value_or(1) != 0)
    r.card.refuse(7, "expects GGG (OFFT: offsets and orientation in displacement axes), found " + in_quotes(offt));
  for (int i : {8, 9})
    if (!card.blank(i) && card.text(i) != "0")
      r.card.refuse(i, "has pin flags " + in_quotes(card.text(i)) +
                           ": they are not read; expected none (use a joint of the scene between two bodies)");
  for (int end : {0, 1})
    for (int i = 0; i < 3; ++i) beam.offsets[end][i] = r.card.real(10 + 3 * end + i, "an offset", 0);
  if (beam.orientation_node == 0 && beam.orientation.isZero(0))
    r.card.refuse(4, "expects an orientation vector, or a grid (G0)");
  if (r.card.good()) r.model.beams.push_back(beam);
}

void read_pshell(Reader& r) {
  const long long id = r.card.integer(0, "the property's number"), material = r.card.integer(1, "a material (MID1)");
  NasShellProperty property{r.named("PSHELL", id), {}, {}, 0, r.where()};
  property.plies.push_back({material, r.card.positive(2, "a thickness"), 0});
  if (r.card.integer(3, "a material (MID2)", 0) != material)
    r.card.refuse(3, "(MID2) differs from MID1: shells have one material for membrane and bending; expected " +
                         std::to_string(material));
  if (std::abs(r.card.real(4, "12 I / T^3", 1) - 1) > 1e-9)
    r.card.refuse(4, "(12 I / T^3) is not 1, which is not read");
  if (!r.card.card.blank(5)) r.model.ignored.try_emplace("PSHELL MID3", NasCount{r.where(), 0}).first->second.times++;
  if (!r.card.card.blank(10)) r.card.refuse(10, "(MID4: coupling of membrane and bending) is not read: use PCOMP");
  property.extra = r.card.real(7, "a mass by area (NSM)", 0);
  r.define(r.model.shell_properties, id, std::move(property), "property");
}

void read_pcomp(Reader& r) {
  const auto& card = r.card.card;
  const bool global = card.name == "PCOMPG";
  const long long id = r.card.integer(0, "the property's number");
  NasShellProperty property{
      r.named(card.name.c_str(), id), {}, {}, r.card.real(2, "a mass by area (NSM)", 0), r.where()};
  if (!card.blank(1)) property.bottom = r.card.real(1, "the height of the bottom (Z0)");
  const std::string lamination = global ? "" : upper(card.text(7));
  if (!lamination.empty() && lamination != "SYM")
    r.card.refuse(7, "expects nothing or SYM (LAM), found " + in_quotes(lamination));
  const std::size_t step = global ? 8 : 4, start = global ? 9 : 8;
  for (std::size_t i = start; i + 2 < std::max(card.fields.size(), start); i += step) {
    if (card.blank(i) && card.blank(i + 1) && card.blank(i + 2)) continue;
    const bool first = property.plies.empty();
    NasPly ply{first ? 0 : property.plies.back().material, first ? 0 : property.plies.back().thickness, 0};
    if (first || !card.blank(i)) ply.material = r.card.integer(i, "a material");
    if (first || !card.blank(i + 1)) ply.thickness = r.card.positive(i + 1, "a thickness");
    ply.angle = r.card.real(i + 2, "an angle", 0);
    property.plies.push_back(ply);
  }
  if (property.plies.empty()) r.card.refuse_card("has no plies");
  if (lamination == "SYM")
    for (std::size_t i = property.plies.size(); i-- > 0;) property.plies.push_back(NasPly(property.plies[i]));
  r.define(r.model.shell_properties, id, std::move(property), "property");
}

// A, I1, I2, I12, J of a section without a shape: I1 is about z, whose direction is that of 2.
void take_general(NasFields& card, NasBeamProperty& property, std::array<double, 5> d) {
  const auto [area, i1, i2, i12, j] = d;
  property.area = area;
  property.section.profile = Profile::general;
  property.section.dimensions = {area, i2, i12, i1, j};
  if (card.good() && !(area > 0 && i1 > 0 && i2 > 0 && j > 0 && i1 * i2 > i12 * i12))
    card.refuse_card("expects A, I1, I2, J and I1 I2 - I12^2 greater than 0");
}

void read_pbar(Reader& r) {
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named("PBAR", id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  take_general(r.card, property,
               {r.card.real(2, "the area"), r.card.real(3, "I1"), r.card.real(4, "I2"), r.card.real(18, "I12", 0),
                r.card.real(5, "J")});
  property.extra = r.card.real(6, "a mass by length (NSM)", 0);
  for (int i : {0, 1}) property.section.shear_factors[i] = std::max(0.0, r.card.real(16 + i, "a shear factor", 0));
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

bool equal(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

void read_pbeam(Reader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named("PBEAM", id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  constexpr const char* names[] = {"the area", "I1", "I2", "I12", "J", "a mass by length (NSM)"};
  std::array<double, 6> at_a;
  for (int i = 0; i < 6; ++i)
    at_a[i] = i == 3 || i == 5 ? r.card.real(2 + i, names[i], 0) : r.card.real(2 + i, names[i]);
  take_general(r.card, property, {at_a[0], at_a[1], at_a[2], at_a[3], at_a[4]});
  property.extra = at_a[5];
  const auto station = [&](std::size_t i) {
    const std::string word = upper(card.text(i));
    return word == "YES" || word == "YESA" || word == "NO";
  };
  std::size_t next = station(8) ? 8 : 16;
  while (station(next)) {
    for (int i = 0; i < 6; ++i)
      if (!equal(r.card.real(next + 2 + i, names[i], at_a[i]), at_a[i]))
        r.card.refuse(next + 2 + i, "differs from end A: beams with taper are not read; expected the same section");
    next += upper(card.text(next)) == "YES" ? 16 : 8;
  }
  for (int i : {0, 1}) property.section.shear_factors[i] = std::max(0.0, r.card.real(next + i, "a shear factor", 1));
  for (int i = 12; i < 16; ++i)
    if (r.card.real(next + i, "an offset of the neutral axis", 0) != 0)
      r.card.refuse(next + i, "is an offset of the neutral axis, which is not read");
  for (int i = 8; i < 12; ++i)
    if (r.card.real(next + i, "an offset of the mass", 0) != 0)
      r.card.refuse(next + i, "is an offset of the nonstructural mass, which is not read");
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

struct NasShape {
  const char* name;
  int count;
};
constexpr NasShape nas_shapes[] = {{"BAR", 2}, {"BOX", 4}, {"I", 6}, {"ROD", 1}, {"TUBE", 2}, {"TUBE2", 2}};

// Dimensions of PBARL and PBEAML in those of BeamSection: direction 1 is y of the element, 2 is z.
void take_shape(NasFields& card, const std::string& shape, const std::vector<double>& d, NasBeamProperty& property) {
  auto& section = property.section;
  constexpr double whole = 1 - 1e-12;  // of a wall that leaves nothing
  if (shape == "BAR") {
    section.profile = Profile::rectangle;
    section.dimensions = {d[1], d[0]};
    property.area = d[0] * d[1];
  } else if (shape == "ROD") {
    section.profile = Profile::circle;
    section.dimensions = {d[0]};
    property.area = M_PI * d[0] * d[0];
  } else if (shape == "TUBE" || shape == "TUBE2") {
    const double inner = shape == "TUBE" ? d[1] : d[0] - d[1];
    if (!(inner >= 0 && inner < d[0])) return card.refuse(9, "expects a wall inside the outer radius");
    section.profile = inner > 0 ? Profile::pipe : Profile::circle;
    section.dimensions = {d[0]};
    if (inner > 0) section.dimensions.push_back(d[0] - inner);
    property.area = M_PI * (d[0] * d[0] - inner * inner);
  } else if (shape == "BOX") {
    if (!(2 * d[3] < whole * d[0] && 2 * d[2] < whole * d[1]))
      return card.refuse(10, "expects walls thinner than the box");
    section.profile = Profile::box;
    section.dimensions = {d[1], d[0], d[2], d[3], d[2], d[3]};
    property.area = d[0] * d[1] - (d[0] - 2 * d[3]) * (d[1] - 2 * d[2]);
  } else {
    if (!equal(d[1], d[2]) || !equal(d[4], d[5]))
      return card.refuse(9, "to 17: an I that is not symmetric is not read; expected DIM2 = DIM3, DIM5 = DIM6");
    if (!(d[4] + d[5] < whole * d[0] && d[3] < whole * d[1]))
      return card.refuse(11, "expects walls thinner than the section");
    section.profile = Profile::i_section;
    section.dimensions = {d[0] / 2, d[0], d[1], d[2], d[4], d[5], d[3]};
    section.quarter_turn = true;
    property.area = d[1] * d[4] + d[2] * d[5] + (d[0] - d[4] - d[5]) * d[3];
  }
}

void read_pbarl(Reader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named(card.name.c_str(), id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  const std::string shape = upper(card.text(3));
  const auto* found =
      std::find_if(std::begin(nas_shapes), std::end(nas_shapes), [&](const auto& s) { return shape == s.name; });
  if (found == std::end(nas_shapes)) {
    std::vector<std::string> known;
    for (const auto& one : nas_shapes) known.push_back(one.name);
    return r.card.refuse(3,
                         "expects one of " + listed(known) + ", found " + in_quotes(shape) + suggestion(shape, known));
  }
  std::vector<double> d;
  for (int i = 0; i < found->count; ++i) d.push_back(r.card.positive(8 + i, "a dimension"));
  if (!r.card.good()) return;
  take_shape(r.card, shape, d, property);
  const std::size_t after = 8 + found->count;
  property.extra = r.card.real(after, "a mass by length (NSM)", 0);
  if (card.name == "PBEAML") {
    for (std::size_t i = after + 1; i < card.fields.size() && !card.blank_from(i); i += 3 + found->count)
      for (int k = 0; k < found->count; ++k)
        if (!equal(r.card.real(i + 2 + k, "a dimension", d[k]), d[k]))
          r.card.refuse(i + 2 + k, "differs from end A: beams with taper are not read; expected the same section");
  }
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

void read_mat1(Reader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT1_", id), Elasticity::isotropic, {}, r.card.real(4, "a density", 0)}, 0, r.where()};
  double e = r.card.real(1, "E", 0), g = r.card.real(2, "G", 0), nu = r.card.real(3, "nu", 0);
  const int given = !card.blank(1) + !card.blank(2) + !card.blank(3);
  if (given < 2 && !(given == 1 && !card.blank(1))) r.card.refuse(1, "to 4 expect two of E, G and nu");
  if (card.blank(1)) e = 2 * g * (1 + nu);
  if (card.blank(3) && !card.blank(2)) nu = e / (2 * g) - 1;
  if (card.blank(2)) g = e / (2 * (1 + nu));
  if (r.card.good() && !(e > 0 && g > 0)) r.card.refuse(1, "to 4 expect E and G greater than 0");
  if (r.card.good() && !(nu > -1 && nu <= 0.5))
    r.card.refuse(3, "expects nu between -1 and 1/2, found " + std::to_string(nu));
  if (found.material.density < 0) r.card.refuse(4, "expects a density that is not negative");
  found.material.constants = {e, nu};
  found.shear = g;
  if (std::abs(2 * g * (1 + nu) / e - 1) > 0.01)
    r.model.ignored.try_emplace("MAT1 G", NasCount{r.where(), 0}).first->second.times++;
  r.define(r.model.materials, id, std::move(found), "material");
}

void read_mat8(Reader& r) {
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT8_", id), Elasticity::lamina, {}, r.card.real(7, "a density", 0)}, 0, r.where()};
  const double e1 = r.card.positive(1, "E1"), e2 = r.card.positive(2, "E2"), nu = r.card.real(3, "nu12");
  const double g = r.card.positive(4, "G12");
  found.material.constants = {e1, e2, nu, g, r.card.real(5, "G1Z", g), r.card.real(6, "G2Z", g)};
  if (found.material.density < 0) r.card.refuse(7, "expects a density that is not negative");
  if (r.card.good() && !(nu * nu < e1 / e2)) r.card.refuse(3, "expects nu12^2 < E1 / E2");
  r.define(r.model.materials, id, std::move(found), "material");
}

void read_mat2(Reader& r) {
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT2_", id), Elasticity::lamina, {}, r.card.real(7, "a density", 0)}, 0, r.where()};
  const double g11 = r.card.positive(1, "G11"), g12 = r.card.real(2, "G12", 0), g22 = r.card.positive(4, "G22"),
               g33 = r.card.positive(6, "G33");
  for (int i : {3, 5})
    if (r.card.real(i, "G13 or G23", 0) != 0) r.card.refuse(i, "is not 0: materials are orthotropic in their own axes");
  if (found.material.density < 0) r.card.refuse(7, "expects a density that is not negative");
  if (r.card.good() && !(g11 * g22 > g12 * g12)) r.card.refuse(2, "expects G12^2 < G11 G22");
  if (!r.card.good()) return;
  const double e1 = g11 - g12 * g12 / g22, e2 = g22 - g12 * g12 / g11;
  found.material.constants = {e1, e2, g12 / g22, g33, g33, g33};
  r.define(r.model.materials, id, std::move(found), "material");
}

void read_conm2(Reader& r) {
  NasMass found{r.card.integer(1, "a grid"), std::max(-1LL, r.card.integer(2, "axes (CID)", 0)), {}, r.where()};
  found.mass.mass = r.card.real(3, "a mass");
  if (r.card.good() && found.mass.mass < 0) r.card.refuse(3, "expects a mass that is not negative");
  for (int i = 0; i < 3; ++i) found.mass.offset[i] = r.card.real(4 + i, "an offset", 0);
  double inertia[6];  // 11 21 22 31 32 33
  for (int i = 0; i < 6; ++i) inertia[i] = r.card.real(8 + i, "a moment of inertia", 0);
  found.mass.inertia << inertia[0], -inertia[1], -inertia[3], -inertia[1], inertia[2], -inertia[4], -inertia[3],
      -inertia[4], inertia[5];
  if (r.card.good() && (found.mass.mass > 0 || !found.mass.inertia.isZero(0))) r.model.masses.push_back(found);
}

bool all_six(std::string_view text) {
  std::string digits(text);
  std::sort(digits.begin(), digits.end());
  digits.erase(std::unique(digits.begin(), digits.end()), digits.end());
  return digits == "123456";
}

void read_rbe2(Reader& r) {
  const auto& card = r.card.card;
  NasLink link{r.card.integer(1, "the independent grid (GN)"), {}, r.where()};
  if (!all_six(card.text(2)))
    r.card.refuse(2, "expects 123456: rigid links hold all six directions; found " + in_quotes(card.text(2)));
  std::size_t last = card.fields.size();
  while (last > 3 && card.blank(last - 1)) --last;
  if (last > 4 && card.text(last - 1).find('.') != std::string_view::npos) --last;  // ALPHA
  for (std::size_t i = 3; i < last; ++i)
    if (!card.blank(i)) link.nodes.push_back(r.card.integer(i, "a dependent grid"));
  if (r.card.good()) r.model.links.push_back(link);
}

void read_rbar(Reader& r) {
  const auto& card = r.card.card;
  const long long a = r.card.integer(1, "a grid (GA)"), b = r.card.integer(2, "a grid (GB)");
  const bool first = all_six(card.text(3)) && card.blank(4), second = all_six(card.text(4)) && card.blank(3);
  if (!first && !second) r.card.refuse(3, "and 6 expect 123456 for one end and nothing for the other (CNA, CNB)");
  const std::string_view dependent = card.text(first ? 6 : 5);
  if (!dependent.empty() && dependent != "0" && !all_six(dependent))
    r.card.refuse(first ? 6 : 5, "expects nothing or 123456, found " + in_quotes(dependent));
  if (r.card.good()) r.model.links.push_back({first ? a : b, {first ? b : a}, r.where()});
}

void count_ignored(Reader& r) {
  r.model.ignored.try_emplace(r.card.card.name, NasCount{r.where(), 0}).first->second.times++;
}

void read_spc(Reader& r) {
  const auto& card = r.card.card;
  count_ignored(r);
  const long long set = r.card.integer(0, "the set's number");
  auto& nodes = r.model.supports[set];
  if (card.name == "SPC") {
    for (std::size_t i : {1, 4})
      if (!card.blank(i)) nodes.emplace_back(r.card.integer(i, "a grid"), r.where());
    return;
  }
  if (upper(card.text(3)) == "THRU") {
    const long long first = r.card.integer(2, "a grid"), last = r.card.integer(4, "a grid");
    if (r.card.good()) r.model.support_ranges.push_back({set, first, last, r.where()});
    return;
  }
  for (std::size_t i = 2; i < card.fields.size(); ++i)
    if (!card.blank(i)) nodes.emplace_back(r.card.integer(i, "a grid"), r.where());
}

void read_param(Reader& r) {
  if (upper(r.card.card.text(0)) == "WTMASS") {
    r.model.mass_factor = r.card.positive(1, "a factor on all masses");
    return;
  }
  count_ignored(r);
}

void read_defaults(Reader& r) {
  if (r.card.card.name != "GRDSET" && !r.model.beams.empty()) r.card.refuse_card("is expected before the first beam");
  NasCard& kept = r.model.defaults[r.card.card.name] = r.card.card;
  for (auto& field : kept.fields) field = r.model.texts.emplace_back(field);
}

using Read = void (*)(Reader&);
const std::map<std::string, Read>& nas_readers() {
  static const std::map<std::string, Read> all{
      {"GRID", read_grid},     {"GRDSET", read_defaults}, {"BAROR", read_defaults}, {"BEAMOR", read_defaults},
      {"CORD1R", read_axes},   {"CORD1C", read_axes},     {"CORD1S", read_axes},    {"CORD2R", read_axes},
      {"CORD2C", read_axes},   {"CORD2S", read_axes},     {"CQUAD4", read_shell},   {"CQUADR", read_shell},
      {"CTRIA3", read_shell},  {"CTRIAR", read_shell},    {"CBAR", read_beam},      {"CBEAM", read_beam},
      {"PSHELL", read_pshell}, {"PCOMP", read_pcomp},     {"PCOMPG", read_pcomp},   {"PBAR", read_pbar},
      {"PBARL", read_pbarl},   {"PBEAM", read_pbeam},     {"PBEAML", read_pbarl},   {"MAT1", read_mat1},
      {"MAT2", read_mat2},     {"MAT8", read_mat8},       {"CONM2", read_conm2},    {"RBE2", read_rbe2},
      {"RBAR", read_rbar},     {"SPC", read_spc},         {"SPC1", read_spc},       {"PARAM", read_param}};
  return all;
}

using Groups = std::vector<std::pair<const char*, std::vector<const char*>>>;

std::map<std::string, std::string> reasons_of(const Groups& groups) {
  std::map<std::string, std::string> all;
  for (const auto& [why, names] : groups)
    for (const char* name : names) all.emplace(name, why);
  return all;
}

const std::map<std::string, std::string>& nas_ignored() {
  static const auto all = reasons_of(
      {{"",
        {"PARAM",   "EIGRL",   "EIGR",    "EIGB",    "EIGC",    "EIGP",    "TSTEP",   "TSTEPNL", "NLPARM",  "NLPCI",
         "NLSTEP",  "FREQ",    "FREQ1",   "FREQ2",   "FREQ3",   "FREQ4",   "TABLED1", "TABLED2", "TABLED3", "TABLED4",
         "TABLEM1", "TABLES1", "TABRND1", "RANDPS",  "ASET",    "ASET1",   "OMIT",    "OMIT1",   "BSET",    "BSET1",
         "CSET",    "CSET1",   "QSET",    "QSET1",   "USET",    "USET1",   "SET1",    "SET3",    "MDLPRM",  "DTI",
         "PLOTEL",  "DESVAR",  "DVPREL1", "DVPREL2", "DCONSTR", "DRESP1",  "DRESP2",  "DOPTPRM", "DEQATN",  "DLINK",
         "DSCREEN", "TOPVAR",  "PSET",    "PVAL",    "MONPNT1", "ECHOON",  "ECHOOFF", "SEQGP",   "SESET",   "SNORM",
         "DCONADD", "DVMREL1", "MODTRAK", "SUPAX",   "CONTRLT", "TSTEP1",  "PSOLID",  "PROD",    "PELAS",   "PBUSH",
         "PDAMP",   "PVISC",   "PTUBE",   "PSHEAR",  "PGAP",    "PLSOLID", "PBUSH1D", "PFAST",   "PWELD",   "PMASS",
         "TABLEM2", "TABLEM3", "TABLEM4"}},
       {"loads are those of the scene",
        {"FORCE",  "FORCE1",  "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "PLOAD",  "PLOAD1", "PLOAD2",
         "PLOAD4", "PLOADB3", "GRAV",   "ACCEL",  "ACCEL1",  "RFORCE",  "LOAD",   "TEMP",   "TEMPD",
         "TEMPP1", "TEMPRB",  "SLOAD",  "DAREA",  "TLOAD1",  "TLOAD2",  "RLOAD1", "RLOAD2", "DLOAD",
         "LSEQ",   "DELAY",   "DPHASE", "DEFORM", "TIC",     "NOLIN1"}},
       {"supports are joints of the scene", {"SPC", "SPC1", "SPCADD", "SPCD", "SPCOFF", "SUPORT", "SUPORT1", "SPCR"}},
       {"the nodes are not tied by it", {"MPC", "MPCADD", "MPCY"}},
       {"damping is that of the scene", {"TABDMP1", "DAMPING"}},
       {"the material is linear elastic, at one temperature",
        {"MATS1", "MATT1", "MATT2", "MATT8", "CREEP", "MATHP", "MATEP", "MATF"}},
       {"heat does not concern the body",
        {"MAT4", "MAT5", "CHBDYE", "CHBDYG", "CHBDYP", "CONV", "PCONV", "QBDY1", "QBDY3", "QVOL", "VIEW", "PHBDY"}},
       {"contact is not represented",
        {"BCTABLE", "BCBODY", "BCONP", "BSURF", "BSURFS", "BCTSET", "BCTADD", "BCTPARM", "BCPARA", "BCBDPRP", "BCPROP",
         "BLSEG", "BFRIC", "BCTPARA"}},
       {"matrices of a file are not added", {"DMIG", "DMI", "DMIK", "DMIJ"}},
       {"aerodynamic forces are those of the scene",
        {"AERO",   "AEROS",  "CAERO1", "CAERO2", "PAERO1",  "PAERO2",  "SPLINE1", "SPLINE2", "AEFACT", "AESTAT",
         "AESURF", "AELIST", "AELINK", "TRIM",   "MKAERO1", "MKAERO2", "FLFACT",  "FLUTTER", "GUST",   "DIVERG"}},
       {"a density, NSM or CONM2 is expected instead", {"NSM", "NSM1", "NSML", "NSML1", "NSMADD"}}});
  return all;
}

const std::map<std::string, std::string>& nas_others() {
  static const auto all = reasons_of(
      {{"a solid", {"CTETRA", "CHEXA", "CPENTA", "CPYRAM", "CTRIAX6", "CTRIAX", "CQUADX", "CQUADX4", "CQUADX8"}},
       {"a shell of second order", {"CQUAD8", "CTRIA6", "CQUAD"}},
       {"a beam of second order or a curved one", {"CBEAM3", "CBEND"}},
       {"a shear panel", {"CSHEAR"}},
       {"a rod", {"CROD", "CONROD", "CTUBE"}},
       {"a spring; use springs or bushings of the scene",
        {"CELAS1", "CELAS2", "CELAS3", "CELAS4", "CBUSH", "CBUSH1D", "CBUSH2D", "GENEL"}},
       {"a damper; use dampers of the scene", {"CDAMP1", "CDAMP2", "CDAMP3", "CDAMP4", "CDAMP5", "CVISC"}},
       {"a gap or a connector", {"CGAP", "CFAST", "CWELD", "CSEAM"}},
       {"a mass by directions; use CONM2", {"CONM1", "CMASS1", "CMASS2", "CMASS3", "CMASS4"}},
       {"a point without coordinates", {"SPOINT", "EPOINT"}},
       {"a mean over grids; expected rigid links (RBE2, RBAR), or a place of several nodes in the scene", {"RBE3"}},
       {"a rigid element of another kind; use RBE2 or RBAR",
        {"RBE1", "RBAR1", "RROD", "RTRPLT", "RTRPLT1", "RSPLINE", "RSSCON", "RJOINT"}},
       {"axes by another rule; use CORD2R", {"CORD3G", "CORD3R", "CORD3C", "CORD3S"}},
       {"a section that is not read; use PBAR, PBARL or PBEAM", {"PBRSECT", "PBMSECT", "PBCOMP", "PBEND", "PBEAM3"}},
       {"a material that is not read; use MAT1, MAT8 or MAT2", {"MAT3", "MAT9", "MAT10", "MAT11"}}});
  return all;
}

}  // namespace

std::vector<std::string> nas_names() {
  std::vector<std::string> names;
  for (const auto& [name, unused] : nas_readers()) names.push_back(name);
  for (const auto& [name, unused] : nas_ignored()) names.push_back(name);
  for (const auto& [name, unused] : nas_others()) names.push_back(name);
  return names;
}

std::string nas_refusal(const std::string& name) {
  const auto found = nas_others().find(name);
  return found == nas_others().end() ? "" : found->second;
}

std::string nas_reason(const std::string& name) {
  if (name == "GRID PS") return "supports are joints of the scene";
  if (name == "PSHELL MID3") return "shells have no transverse shear deformation";
  if (name == "MAT1 G")
    return "shells take E and nu, beams E and G, which differ by more than 1 % from E = 2 G (1 + nu)";
  if (name == "corner thicknesses") return "a shell has their mean";
  const auto found = nas_ignored().find(name);
  return found == nas_ignored().end() ? "" : found->second;
}

void read_nas_card(const NasCard& card, NasModel& model, Faults& faults) {
  NasFields fields(card, faults);
  Reader reader{fields, model};
  const auto& readers = nas_readers();
  const auto count = [&](std::map<std::string, NasCount>& in) {
    in.try_emplace(card.name, NasCount{card.where(), 0}).first->second.times++;
  };
  if (const auto read = readers.find(card.name); read != readers.end())
    read->second(reader);
  else if (nas_ignored().contains(card.name))
    count(model.ignored);
  else if (nas_others().contains(card.name))
    count(model.refused);
  else
    count(model.unknown);
}

}  // namespace floe::mesh
