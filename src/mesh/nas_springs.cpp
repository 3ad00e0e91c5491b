#include "nas_reader.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// A grid and its component; both blank or 0: ground.
void read_end(NasFields& card, std::size_t field, NasSpring& spring, int end) {
  spring.grids[end] = card.integer(field, "a grid", 0);
  const long long component = card.integer(field + 1, "a component (1 to 6)", 0);
  if (spring.grids[end] == 0) return;
  if (component < 1 || component > 6)
    return card.refuse(field + 1, "expects a component from 1 to 6 of a grid (scalar points are not read)");
  spring.components[end] = static_cast<int>(component);
}

}  // namespace

void read_celas(NasReader& r) {
  const bool first_form = r.card.card.name == "CELAS1";
  NasSpring spring{r.card.integer(0, "the element's number"), {0, 0}};
  spring.where = r.where();
  if (first_form)
    spring.property = r.card.card.blank(1) ? spring.id : r.card.integer(1, "a property");
  else
    spring.stiffness = r.card.real(1, "a stiffness");
  read_end(r.card, 2, spring, 0);
  read_end(r.card, 4, spring, 1);
  if (r.card.good() && spring.stiffness < 0) r.card.refuse(1, "expects a stiffness that is not negative");
  if (!first_form && r.card.real(6, "GE", 0) != 0) r.count_ignored("GE");
  if (r.card.good()) r.model.springs.push_back(spring);
}

void read_pelas(NasReader& r) {
  for (const std::size_t first : {0, 4}) {
    if (r.card.card.blank(first)) continue;
    const long long id = r.card.integer(first, "the property's number");
    const double stiffness = r.card.real(first + 1, "a stiffness");
    if (r.card.good() && stiffness < 0) r.card.refuse(first + 1, "expects a stiffness that is not negative");
    if (r.card.real(first + 2, "GE", 0) != 0) r.count_ignored("GE");
    r.define(r.model.scalar_stiffness, id, stiffness, "property");
  }
}

void read_cbush(NasReader& r) {
  NasSpring spring{r.card.integer(0, "the element's number"), {r.card.integer(2, "a grid (GA)"), 0}};
  spring.where = r.where();
  spring.property = r.card.card.blank(1) ? spring.id : r.card.integer(1, "a property");
  spring.grids[1] = r.card.integer(3, "a grid (GB)", 0);
  if (r.card.is_integer(4) && r.card.card.blank(5) && r.card.card.blank(6))
    spring.orientation_node = r.card.integer(4, "a grid (GO)");
  else
    for (int i = 0; i < 3; ++i) spring.orientation[i] = r.card.real(4 + i, "a component of the orientation vector", 0);
  spring.axes = r.card.integer(7, "axes (CID)", -1);
  spring.at = r.card.real(8, "a place between the grids (S)", 0.5);
  if (r.card.integer(9, "axes (OCID)", -1) >= 0)
    r.card.refuse(9, "(OCID: a spring beside the line of its grids) is not read; expected nothing or -1");
  if (r.card.good()) r.model.springs.push_back(spring);
}

void read_pbush(NasReader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the property's number");
  std::array<double, 6> stiffness{};
  for (std::size_t line = 0; line < card.fields.size(); line += 8) {
    const std::string what = upper(card.text(line + 1));
    if (what == "B" || what == "GE") r.count_ignored("PBUSH B, GE");
    if (what == "M") r.count_ignored("PBUSH M");
    if (what == "K")
      for (std::size_t i = 0; i < 6; ++i) {
        stiffness[i] = r.card.real(line + 2 + i, "a stiffness", 0);
        if (r.card.good() && stiffness[i] < 0) r.card.refuse(line + 2 + i, "expects a stiffness that is not negative");
      }
  }
  r.define(r.model.bush_stiffness, id, stiffness, "property");
}

namespace {

/// A section of area and torsion constant alone: what bends is without stiffness.
NasBeamProperty rod_property(const std::string& name, long long material, double area, double torsion, double extra,
                             Where where) {
  NasBeamProperty property{name, material, {}, area, extra, where};
  property.section.profile = Profile::general;
  property.section.dimensions = {area, 0, 0, 0, torsion};
  return property;
}

}  // namespace

void read_prod(NasReader& r) {
  const bool tube = r.card.card.name == "PTUBE";
  const long long id = r.card.integer(0, "the property's number"), material = r.card.integer(1, "a material");
  double area = r.card.positive(2, tube ? "an outer diameter" : "the area"),
         torsion = tube ? 0 : r.card.real(3, "J", 0);
  if (tube) {
    const double outer = area, wall = r.card.real(3, "a wall", 0), inner = wall > 0 ? outer - 2 * wall : 0;
    if (r.card.good() && !(wall >= 0 && inner >= 0)) r.card.refuse(3, "expects a wall of at most half the diameter");
    if (!r.card.card.blank(5) && r.card.real(5, "an outer diameter", outer) != outer)
      r.card.refuse(5, "differs from field 4: tubes with taper are not read; expected one diameter");
    area = M_PI / 4 * (outer * outer - inner * inner);
    torsion = M_PI / 32 * (std::pow(outer, 4) - std::pow(inner, 4));
  }
  const double extra = r.card.real(tube ? 4 : 5, "a mass per length (NSM)", 0);
  if (r.card.good() && torsion < 0) r.card.refuse(3, "expects J that is not negative");
  r.define(r.model.beam_properties, id,
           rod_property(r.named(r.card.card.name.c_str(), id), material, area, torsion, extra, r.where()), "property");
}

void read_rod(NasReader& r) {
  NasBeam rod{r.card.integer(0, "the element's number"), 0, {}, Eigen::Vector3d::Zero(), 0, {}, r.where()};
  rod.property = r.card.card.blank(1) ? rod.id : r.card.integer(1, "a property");
  for (int i : {0, 1}) rod.nodes[i] = r.card.integer(2 + i, "a grid");
  rod.offsets.fill(Eigen::Vector3d::Zero());
  rod.rod = true;
  if (r.card.good()) r.model.beams.push_back(rod);
}

void read_conrod(NasReader& r) {
  NasBeam rod{r.card.integer(0, "the element's number"), 0, {}, Eigen::Vector3d::Zero(), 0, {}, r.where()};
  for (int i : {0, 1}) rod.nodes[i] = r.card.integer(1 + i, "a grid");
  rod.offsets.fill(Eigen::Vector3d::Zero());
  rod.rod = true;
  rod.property = -rod.id;
  const long long material = r.card.integer(3, "a material");
  const double area = r.card.positive(4, "the area"), torsion = r.card.real(5, "J", 0),
               extra = r.card.real(7, "a mass per length (NSM)", 0);
  if (r.card.good() && torsion < 0) r.card.refuse(5, "expects J that is not negative");
  r.define(r.model.beam_properties, rod.property,
           rod_property(r.named("CONROD", rod.id), material, area, torsion, extra, r.where()), "rod");
  if (r.card.good()) r.model.beams.push_back(rod);
}

}  // namespace floe::mesh
