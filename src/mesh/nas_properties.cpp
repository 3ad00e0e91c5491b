#include <algorithm>
#include <cmath>

#include "nas_reader.h"
#include "nas_shapes.h"
#include "nas_taper.h"
#include "text.h"

namespace floe::mesh {
void read_pshell(NasReader& r) {
  const long long id = r.card.integer(0, "the property's number");
  const double thickness = r.card.real(2, "a thickness", 0);  // 0: of the elements, or of the scene
  if (thickness < 0) r.card.refuse(2, "expects a thickness that is not negative");
  const long long material =
      thickness > 0 ? r.card.integer(1, "a material (MID1)") : r.card.integer(1, "a material (MID1)", 0);
  NasShellProperty property{r.named("PSHELL", id), {}, {}, 0, r.where()};
  property.plies.push_back({material, thickness, 0});
  const long long bending = r.card.integer(3, "a material (MID2)", 0);
  if (bending < 0) r.card.refuse(3, "(MID2: -1, plane strain) is not read; expected a material");
  if (bending == 0) r.count_ignored("PSHELL without MID2 (membranes)");
  if (bending > 0 && bending != material) property.bending = bending;
  property.factor = r.card.real(4, "12 I / T^3", 1);
  if (std::abs(property.factor - 1) <= 1e-9) property.factor = 1;
  if (!(property.factor > 0)) r.card.refuse(4, "(12 I / T^3) expects a number greater than 0");
  if (!r.card.card.blank(5)) r.count_ignored("PSHELL MID3");
  if (!r.card.card.blank(10)) r.card.refuse(10, "(MID4: coupling of membrane and bending) is not read: use PCOMP");
  property.extra = r.card.real(7, "a mass by area (NSM)", 0);
  r.define(r.model.shell_properties, id, std::move(property), "property");
}

void read_pcomp(NasReader& r) {
  const auto& card = r.card.card;
  const bool global = card.name == "PCOMPG";
  const long long id = r.card.integer(0, "the property's number");
  NasShellProperty property{
      r.named(card.name.c_str(), id), {}, {}, r.card.real(2, "a mass by area (NSM)", 0), r.where()};
  if (!card.blank(1)) property.bottom = r.card.real(1, "the height of the bottom (Z0)");
  if (r.card.real(6, "GE", 0) != 0) r.count_ignored("GE");
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

namespace {

// A, I1, I2, I12, J of a section without a shape: I1 is about z, whose direction is that of 2.
void take_general(NasFields& card, NasBeamProperty& property, std::array<double, 5> d) {
  const auto [area, i1, i2, i12, j] = d;
  property.area = area;
  property.section.profile = Profile::general;
  property.section.dimensions = {area, i2, i12, i1, j};
  if (card.good() && !(area > 0 && i1 >= 0 && i2 >= 0 && j >= 0 && (i12 == 0 || i1 * i2 > i12 * i12)))
    card.refuse_card("expects A greater than 0, I1, I2 and J not negative, and I12^2 less than I1 I2");
}

// C1 C2 D1 D2 E1 E2 F1 F2 of PBAR, and of the stations of PBEAM, from a field on: y and z from the axis of the element.
// Pairs of blank fields are left out; all zero: none are known.
std::vector<Eigen::Vector2d> stress_points(NasFields& card, std::size_t first) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = first; i < first + 8; i += 2) {
    if (card.card.blank(i) && card.card.blank(i + 1)) continue;
    const double y = card.real(i, "a coordinate of a stress point", 0);
    points.emplace_back(y, card.real(i + 1, "a coordinate of a stress point", 0));
  }
  if (std::all_of(points.begin(), points.end(), [](const Eigen::Vector2d& point) { return point.isZero(0); }))
    return {};
  return points;
}

}  // namespace

void read_pbar(NasReader& r) {
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named("PBAR", id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  take_general(r.card, property,
               {r.card.real(2, "the area"), r.card.real(3, "I1", 0), r.card.real(4, "I2", 0), r.card.real(18, "I12", 0),
                r.card.real(5, "J", 0)});
  property.extra = r.card.real(6, "a mass per length (NSM)", 0);
  for (int i : {0, 1}) property.section.shear_factors[i] = std::max(0.0, r.card.real(16 + i, "a shear factor", 0));
  property.section.fibres = stress_points(r.card, 8);
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

namespace {

/// The line after the stations of PBEAM: K1 K2 S1 S2 NSI(A) NSI(B) CW(A) CW(B), and the offsets after it.
void read_after_stations(NasReader& r, std::size_t at, bool has_added_mass, NasBeamProperty& property) {
  for (int i : {0, 1}) property.section.shear_factors[i] = std::max(0.0, r.card.real(at + i, "a shear factor", 1));
  constexpr const char* pairs[] = {"PBEAM S1, S2", "PBEAM NSI", "PBEAM CW"};
  for (std::size_t k = 0; k < std::size(pairs); ++k) {
    const std::size_t first = at + 2 + 2 * k;
    const double a = r.card.real(first, "a real number", 0), b = r.card.real(first + 1, "a real number", 0);
    if (a != 0 || b != 0) r.count_ignored(pairs[k]);
  }
  for (int i : {0, 1}) {
    const double a = r.card.real(at + 12 + i, "an offset of the neutral axis", 0);
    if (r.card.real(at + 14 + i, "an offset of the neutral axis", a) != a)
      r.card.refuse(at + 14 + i, "is another offset of the neutral axis than at end A; expected the same");
    if (a != 0) property.section.centroid = property.section.centroid.value_or(Eigen::Vector2d::Zero());
    if (a != 0) (*property.section.centroid)[i] = a;
  }
  const Eigen::Vector2d centroid = property.section.centroid.value_or(Eigen::Vector2d::Zero());
  bool on_axis = false;
  for (int i : {0, 1}) {
    const double a = r.card.real(at + 8 + i, "an offset of the mass", 0);
    for (const auto& [field, offset] :
         {std::pair{at + 8 + i, a}, {at + 10 + i, r.card.real(at + 10 + i, "an offset of the mass", a)}}) {
      if (!has_added_mass || offset == centroid[i]) continue;
      on_axis = on_axis || offset == 0;
      if (offset != 0)
        r.card.refuse(field,
                      "is an offset of the nonstructural mass that is not that of the neutral axis (N1, N2), "
                      "which is not read");
    }
  }
  if (on_axis) r.count_ignored("PBEAM M1, M2");
}

// Of what no piece carries the ends of the whole are released (torsion at A alone), and the constant that is 0 becomes
// that of a square of this area: releases of every piece would leave the nodes between them without stiffness.
void release_whole(NasFields& card, NasBeamProperty& property) {
  const auto release = [&](std::size_t constant, double square, unsigned ends) {
    auto& pieces = property.pieces;
    const auto zero = [&](const NasBeamProperty& piece) { return piece.section.dimensions[constant] == 0; };
    if (std::none_of(pieces.begin(), pieces.end(), zero)) return;
    if (!std::all_of(pieces.begin(), pieces.end(), zero))
      return card.refuse_card("expects I1, I2 and J greater than 0 along the whole beam, or 0 along all of it");
    for (NasBeamProperty& piece : pieces) piece.section.dimensions[constant] = piece.area * piece.area * square;
    property.releases |= ends;
  };
  release(4, 1. / 7, 1u << 3);
  release(1, 1. / 12, 1u << 4 | 1u << 10);
  release(3, 1. / 12, 1u << 5 | 1u << 11);
}

}  // namespace

void read_pbeam(NasReader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named("PBEAM", id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  constexpr const char* names[] = {"the area", "I1", "I2", "I12", "J", "a mass per length (NSM)"};
  std::vector<double> at_a;
  for (int i = 0; i < 6; ++i) at_a.push_back(i > 2 ? r.card.real(2 + i, names[i], 0) : r.card.real(2 + i, names[i]));
  const auto take = [&](const std::vector<double>& d, NasBeamProperty& of) {
    take_general(r.card, of, {d[0], d[1], d[2], d[3], d[4]});
    of.extra = d[5];
  };
  take(at_a, property);
  NasTaper taper(at_a);
  bool heavy = at_a[5] != 0;
  const auto station = [&](std::size_t i) {
    const std::string word = upper(card.text(i));
    return word == "YES" || word == "YESA" || word == "NO";
  };
  std::size_t next = station(8) ? 8 : 16;
  std::vector<Eigen::Vector2d> points;
  const auto take_points = [&](std::size_t first) {
    for (const Eigen::Vector2d& point : stress_points(r.card, first)) points.push_back(point);
  };
  if (next == 16) take_points(8);
  while (station(next)) {
    std::vector<std::optional<double>> values(at_a.size());
    for (int i = 0; i < 6; ++i)
      if (!card.blank(next + 2 + i)) values[i] = r.card.real(next + 2 + i, names[i]);
    heavy = heavy || values[5].value_or(0) != 0;
    taper.add(r.card.real(next + 1, "a position along the length (X/XB)", 1), values);
    const bool with_points = upper(card.text(next)) == "YES";
    if (with_points) take_points(next + 8);
    next += with_points ? 16 : 8;
  }
  taper.complete(r.card);
  const bool varies = r.card.good() && taper.varies();
  read_after_stations(r, next, heavy, property);
  for (Eigen::Vector2d& point : points) point -= property.section.centroid.value_or(Eigen::Vector2d::Zero());
  if (!varies) property.section.fibres = points;
  if (r.card.good() && varies) taper.divide(property, take), release_whole(r.card, property);
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

void read_pbarl(NasReader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the property's number");
  NasBeamProperty property{r.named(card.name.c_str(), id), r.card.integer(1, "a material"), {}, 0, 0, r.where()};
  const std::string shape = upper(card.text(3));
  const std::size_t count = nas_shape_dimensions(shape);
  if (count == 0) {
    const std::vector<std::string> known = nas_shape_names();
    return r.card.refuse(3,
                         "expects one of " + listed(known) + ", found " + in_quotes(shape) + suggestion(shape, known));
  }
  std::vector<double> d;
  for (std::size_t i = 0; i < count; ++i) d.push_back(r.card.positive(8 + i, "a dimension"));
  d.push_back(r.card.real(8 + count, "a mass per length (NSM)", 0));
  if (!r.card.good()) return;
  const auto take = [&](const std::vector<double>& values, NasBeamProperty& of) {
    take_nas_shape(r.card, shape, {values.begin(), values.end() - 1}, of);
    of.extra = values.back();
  };
  take(d, property);
  NasTaper taper(d);
  if (card.name == "PBEAML")
    for (std::size_t i = 9 + count; i < card.fields.size() && !card.blank_from(i); i += 2 + d.size()) {
      std::vector<std::optional<double>> values(d.size());
      for (std::size_t k = 0; k < d.size(); ++k) {
        const std::size_t field = i + 2 + k;
        if (!card.blank(field))
          values[k] = k < count ? r.card.positive(field, "a dimension") : r.card.real(field, "a mass per length (NSM)");
      }
      taper.add(r.card.real(i + 1, "a position along the length (X/XB)", 1), values);
    }
  taper.complete(r.card);
  if (r.card.good() && taper.varies()) taper.divide(property, take);
  const auto beside = [](const NasBeamProperty& of) { return of.section.centroid && of.extra != 0; };
  if (beside(property) || std::any_of(property.pieces.begin(), property.pieces.end(), beside))
    r.count_ignored("axis of the NSM of PBEAML");
  r.define(r.model.beam_properties, id, std::move(property), "property");
}

}  // namespace floe::mesh
