#include "nas_shapes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "text.h"

namespace floe::mesh {
namespace {

/// A rectangle of a section: its centre, and its sides along y and z of the element.
struct Rectangle {
  double y, z, height, width;
};

/// A thin wall of an open section between points (y, z) on middle lines. It begins where an earlier one began or ended.
struct Wall {
  Eigen::Vector2d from, to;
  double thickness;
  Eigen::Vector2d along() const { return to - from; }
};

struct Outline {
  std::vector<Rectangle> parts;
  std::vector<Wall> walls;
};

using Dimensions = const std::vector<double>&;

// d of the shapes as in the guides, y up, z to the right.
Outline shape_i(Dimensions d) {
  const double low = d[4] / 2, high = d[0] - d[5] / 2;
  return {{{low, 0, d[4], d[1]}, {(d[0] + d[4] - d[5]) / 2, 0, d[0] - d[4] - d[5], d[3]}, {high, 0, d[5], d[2]}},
          {{{low, 0}, {high, 0}, d[3]},
           {{low, 0}, {low, -d[1] / 2}, d[4]},
           {{low, 0}, {low, d[1] / 2}, d[4]},
           {{high, 0}, {high, -d[2] / 2}, d[5]},
           {{high, 0}, {high, d[2] / 2}, d[5]}}};
}
Outline shape_i1(Dimensions d) {
  const double flange = (d[3] - d[2]) / 2;
  return shape_i({d[3], d[0] + d[1], d[0] + d[1], d[1], flange, flange});
}
/// A T or, where `up` is -1, one upside down.
Outline tee(Dimensions d, double up) {
  const double flange = -up * d[2] / 2;
  return {{{flange, 0, d[2], d[0]}, {-up * (d[1] + d[2]) / 2, 0, d[1] - d[2], d[3]}},
          {{{flange, 0}, {flange, -d[0] / 2}, d[2]},
           {{flange, 0}, {flange, d[0] / 2}, d[2]},
           {{flange, 0}, {-up * d[1], 0}, d[3]}}};
}
Outline shape_t(Dimensions d) { return tee(d, 1); }
Outline shape_t2(Dimensions d) { return tee(d, -1); }
Outline shape_t1(Dimensions d) {
  const double z = d[2] / 2;
  return {{{0, z, d[0], d[2]}, {0, -d[1] / 2, d[3], d[1]}},
          {{{0, z}, {-d[0] / 2, z}, d[2]}, {{0, z}, {d[0] / 2, z}, d[2]}, {{0, z}, {0, -d[1]}, d[3]}}};
}
Outline shape_l(Dimensions d) {
  const double y = d[2] / 2, z = d[3] / 2;
  return {{{y, d[0] / 2, d[2], d[0]}, {(d[1] + d[2]) / 2, z, d[1] - d[2], d[3]}},
          {{{y, z}, {y, d[0]}, d[2]}, {{y, z}, {d[1], z}, d[3]}}};
}
Outline shape_chan(Dimensions d) {
  const double y = (d[1] - d[3]) / 2, inner = d[1] - 2 * d[3], web = d[2] / 2;
  return {{{0, web, inner, d[2]}, {y, d[0] / 2, d[3], d[0]}, {-y, d[0] / 2, d[3], d[0]}},
          {{{-y, web}, {y, web}, d[2]}, {{y, web}, {y, d[0]}, d[3]}, {{-y, web}, {-y, d[0]}, d[3]}}};
}
Outline shape_chan1(Dimensions d) { return shape_chan({d[0] + d[1], d[3], d[1], (d[3] - d[2]) / 2}); }
Outline shape_chan2(Dimensions d) {
  const double y = (d[2] + d[1]) / 2, z = (d[3] - d[0]) / 2, web = d[1] / 2;
  return {{{web, 0, d[1], d[3]}, {y, z, d[2] - d[1], d[0]}, {y, -z, d[2] - d[1], d[0]}},
          {{{web, -z}, {web, z}, d[1]}, {{web, z}, {d[2], z}, d[0]}, {{web, -z}, {d[2], -z}, d[0]}}};
}
Outline shape_cross(Dimensions d) {
  const double z = d[1] / 2 + d[0] / 4;
  return {{{0, 0, d[2], d[1]}, {0, z, d[3], d[0] / 2}, {0, -z, d[3], d[0] / 2}},
          {{{0, 0}, {d[2] / 2, 0}, d[1]},
           {{0, 0}, {-d[2] / 2, 0}, d[1]},
           {{0, 0}, {0, d[0] / 2}, d[3]},
           {{0, 0}, {0, -d[0] / 2}, d[3]}}};
}
Outline shape_h(Dimensions d) {
  const double z = d[0] / 2 + d[1] / 4, y = d[2] / 2;
  return {{{0, 0, d[3], d[0]}, {0, z, d[2], d[1] / 2}, {0, -z, d[2], d[1] / 2}},
          {{{0, -z}, {0, z}, d[3]},
           {{0, z}, {y, z}, d[1] / 2},
           {{0, z}, {-y, z}, d[1] / 2},
           {{0, -z}, {y, -z}, d[1] / 2},
           {{0, -z}, {-y, -z}, d[1] / 2}}};
}
Outline shape_z(Dimensions d) {
  const double flange = (d[3] - d[2]) / 2, y = (d[3] - flange) / 2, z = (d[0] + d[1]) / 2, tip = d[0] + d[1] / 2;
  return {{{0, 0, d[3], d[1]}, {y, -z, flange, d[0]}, {-y, z, flange, d[0]}},
          {{{-y, 0}, {y, 0}, d[1]}, {{y, 0}, {y, -tip}, flange}, {{-y, 0}, {-y, tip}, flange}}};
}
Outline shape_hat(Dimensions d) {
  const double t = d[1], side = (d[2] - t) / 2, brim = d[3] + t, z = d[2] / 2 - t + brim / 2;
  const double top = d[0] - t / 2, tip = d[2] / 2 + d[3];
  return {{{top, 0, t, d[2]},
           {d[0] / 2, side, d[0] - 2 * t, t},
           {d[0] / 2, -side, d[0] - 2 * t, t},
           {t / 2, z, t, brim},
           {t / 2, -z, t, brim}},
          {{{top, -side}, {top, side}, t},
           {{top, side}, {t / 2, side}, t},
           {{t / 2, side}, {t / 2, tip}, t},
           {{top, -side}, {t / 2, -side}, t},
           {{t / 2, -side}, {t / 2, -tip}, t}}};
}
Outline shape_box1(Dimensions d) {
  const double inner = d[1] - d[2] - d[3], y = d[3] + inner / 2;
  return {{{d[1] - d[2] / 2, d[0] / 2, d[2], d[0]},
           {d[3] / 2, d[0] / 2, d[3], d[0]},
           {y, d[4] / 2, inner, d[4]},
           {y, d[0] - d[5] / 2, inner, d[5]}},
          {}};
}

/// Closed, of four thin walls: J = 4 A^2 / sum(s / t), A and s to the middle of the walls (Bredt).
double torsion_of_box1(Dimensions d) {
  const double w = d[0] - (d[4] + d[5]) / 2, h = d[1] - (d[2] + d[3]) / 2;
  return 4 * w * w * h * h / (w / d[2] + w / d[3] + h / d[4] + h / d[5]);
}

/// W = 2 A t of the thinnest wall.
double modulus_of_box1(Dimensions d) {
  const double w = d[0] - (d[4] + d[5]) / 2, h = d[1] - (d[2] + d[3]) / 2;
  return 2 * w * h * *std::min_element(d.begin() + 2, d.begin() + 6);
}

/// A hexagon, DIM1 from its rectangle to its points; J = A^4 / (40 (I1 + I2)), as Saint-Venant's of compact sections.
std::array<double, 5> hexagon(Dimensions d) {
  const double w = d[1] - 2 * d[0], h = d[2], area = h * (w + d[0]);
  const double i1 = w * std::pow(h, 3) / 12 + d[0] * std::pow(h, 3) / 24,
               i2 = h * std::pow(w, 3) / 12 +
                    2 * (h * std::pow(d[0], 3) / 36 + h * d[0] / 2 * std::pow(w / 2 + d[0] / 3, 2));
  return {area, i1, i2, 0, std::pow(area, 4) / (40 * (i1 + i2))};
}

/// y and z.
Eigen::Vector2d centre_of(const Outline& outline) {
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (const auto& p : outline.parts) {
    area += p.height * p.width;
    moment += p.height * p.width * Eigen::Vector2d(p.y, p.z);
  }
  return moment / area;
}

/// A, I1, I2, I12 about the centre of the area, and J of thin walls, sum(s t^3) / 3.
std::array<double, 5> constants_of(const Outline& outline) {
  const Eigen::Vector2d centre = centre_of(outline);
  const double y = centre[0], z = centre[1];
  double area = 0, i1 = 0, i2 = 0, i12 = 0, j = 0;
  for (const auto& p : outline.parts) {
    const double a = p.height * p.width;
    area += a;
    i1 += a * (p.height * p.height / 12 + (p.y - y) * (p.y - y));
    i2 += a * (p.width * p.width / 12 + (p.z - z) * (p.z - z));
    i12 += a * (p.y - y) * (p.z - z);
  }
  for (const auto& wall : outline.walls) j += wall.along().norm() * std::pow(wall.thickness, 3) / 3;
  return {area, i1, i2, std::abs(i12) > 1e-12 * std::sqrt(i1 * i2) ? i12 : 0, j};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Shear centre of an open section of thin walls: with r from the centre of their areas, and the sectorial coordinate
/// w, dw = r x dr, it is at d, where int w r dA = (int r r^T dA) (-d_z, d_y). Source: Vlasov, Thin-walled elastic
/// beams, 2nd ed., ch. 1.
Eigen::Vector2d shear_centre_of(const std::vector<Wall>& walls) {
  double area = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), sectorial = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (const Wall& wall : walls) {
    const double a = wall.along().norm() * wall.thickness;
    area += a, centre += a * (wall.from + wall.to) / 2;
  }
  centre /= area;
  std::vector<std::pair<Eigen::Vector2d, double>> known{{walls.front().from, 0}};  // w of the ends so far
  for (const Wall& wall : walls) {
    const auto begin =
        std::find_if(known.begin(), known.end(), [&](const auto& end) { return end.first == wall.from; });
    if (begin == known.end()) throw std::logic_error("a wall of a section begins where no other one is");
    const Eigen::Vector2d from = wall.from - centre, to = wall.to - centre;
    const double a = wall.along().norm() * wall.thickness, w = begin->second, change = cross(from, to);
    known.emplace_back(wall.to, w + change);
    sectorial += a * (w * (from + to) / 2 + change * (from + 2 * to) / 6);
    second +=
        a / 6 * (2 * from * from.transpose() + 2 * to * to.transpose() + from * to.transpose() + to * from.transpose());
  }
  const Eigen::Vector2d turned = second.inverse() * sectorial;
  return centre + Eigen::Vector2d(turned[1], -turned[0]);
}

/// Corners of the parts from the centre of the area: the extreme fibres are among them.
std::vector<Eigen::Vector2d> corners_of(const Outline& outline) {
  const Eigen::Vector2d centre = centre_of(outline);
  std::vector<Eigen::Vector2d> corners;
  for (const auto& p : outline.parts)
    for (const double up : {-0.5, 0.5})
      for (const double right : {-0.5, 0.5})
        corners.push_back(Eigen::Vector2d(p.y + up * p.height, p.z + right * p.width) - centre);
  return corners;
}

double thickest(const Outline& outline) {
  double t = 0;
  for (const auto& wall : outline.walls) t = std::max(t, wall.thickness);
  return t;
}

struct Shape {
  const char* name;
  std::size_t count;
  Outline (*outline)(Dimensions);  // none: a profile of its own
};

constexpr Shape shapes[] = {
    {"BAR", 2, nullptr},       {"BOX", 4, nullptr},       {"BOX1", 6, shape_box1},   {"CHAN", 4, shape_chan},
    {"CHAN1", 4, shape_chan1}, {"CHAN2", 4, shape_chan2}, {"CROSS", 4, shape_cross}, {"H", 4, shape_h},
    {"HAT", 4, shape_hat},     {"HEXA", 3, nullptr},      {"I", 6, shape_i},         {"I1", 4, shape_i1},
    {"L", 4, shape_l},         {"ROD", 1, nullptr},       {"T", 4, shape_t},         {"T1", 4, shape_t1},
    {"T2", 4, shape_t2},       {"TUBE", 2, nullptr},      {"TUBE2", 2, nullptr},     {"Z", 4, shape_z}};

const Shape* shape_named(const std::string& name) {
  const auto* found = std::find_if(std::begin(shapes), std::end(shapes), [&](const auto& s) { return name == s.name; });
  return found == std::end(shapes) ? nullptr : found;
}

void take_constants(const std::array<double, 5>& c, NasBeamProperty& property) {
  property.area = c[0];
  property.section.profile = Profile::general;
  property.section.dimensions = {c[0], c[2], c[3], c[1], c[4]};
  property.section.quarter_turn = false;  // of pieces beside one that is an I of equal flanges
}

void take_round(NasFields& card, const std::string& shape, Dimensions d, NasBeamProperty& property) {
  const double inner = shape == "ROD" ? 0 : shape == "TUBE" ? d[1] : d[0] - d[1];
  if (!(inner >= 0 && inner < d[0])) return card.refuse(9, "expects a wall inside the outer radius");
  property.section.profile = inner > 0 ? Profile::pipe : Profile::circle;
  property.section.dimensions = {d[0]};
  if (inner > 0) property.section.dimensions.push_back(d[0] - inner);
  property.area = M_PI * (d[0] * d[0] - inner * inner);
}

void take_box(NasFields& card, Dimensions d, NasBeamProperty& property) {
  constexpr double whole = 1 - 1e-12;  // of a wall that leaves nothing
  if (!(2 * d[3] < whole * d[0] && 2 * d[2] < whole * d[1]))
    return card.refuse(10, "expects walls thinner than the box");
  property.section.profile = Profile::box;
  property.section.dimensions = {d[1], d[0], d[2], d[3], d[2], d[3]};
  property.area = d[0] * d[1] - (d[0] - 2 * d[3]) * (d[1] - 2 * d[2]);
}

void take_outline(NasFields& card, const Shape& shape, Dimensions d, NasBeamProperty& property) {
  const Outline outline = shape.outline(d);
  constexpr double least = 1e-12;
  const double size = *std::max_element(d.begin(), d.end());
  for (const auto& part : outline.parts)
    if (!(part.height > least * size && part.width > least * size))
      return card.refuse(9, std::string("to the last dimension: expects walls of ") + shape.name +
                                " that are thinner than the section");
  std::array<double, 5> constants = constants_of(outline);
  if (outline.walls.empty()) constants[4] = torsion_of_box1(d);
  take_constants(constants, property);
  property.section.fibres = corners_of(outline);
  if (card.card.name == "PBEAML" && !outline.walls.empty()) {
    const Eigen::Vector2d centroid = centre_of(outline) - shear_centre_of(outline.walls);
    property.section.centroid = centroid.norm() > 1e-9 * size ? std::optional(centroid) : std::nullopt;
  }
  property.section.torsion_modulus = outline.walls.empty() ? modulus_of_box1(d) : constants[4] / thickest(outline);
}

}  // namespace

bool equal_lengths(double a, double b) { return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b)); }

std::vector<std::string> nas_shape_names() {
  std::vector<std::string> names;
  for (const auto& one : shapes) names.push_back(one.name);
  return names;
}

std::size_t nas_shape_dimensions(const std::string& shape) {
  const Shape* found = shape_named(shape);
  return found ? found->count : 0;
}

// Dimensions of PBARL and PBEAML in those of BeamSection: direction 1 is y of the element, 2 is z.
void take_nas_shape(NasFields& card, const std::string& name, Dimensions d, NasBeamProperty& property) {
  const Shape& shape = *shape_named(name);
  if (card.card.name == "PBEAML" && name == "BOX1" && !(equal_lengths(d[2], d[3]) && equal_lengths(d[4], d[5])))
    return card.refuse(3,
                       "(BOX1 of unequal walls): the axis of a CBEAM is its line of shear centres, whose distance from "
                       "the centroid is not read for this shape; expected equal walls, or CBAR with PBARL");
  if (name == "BAR") {
    property.section.profile = Profile::rectangle;
    property.section.dimensions = {d[1], d[0]};
    property.area = d[0] * d[1];
  } else if (name == "BOX") {
    take_box(card, d, property);
  } else if (name == "HEXA") {
    if (!(2 * d[0] < d[1])) return card.refuse(9, "expects DIM1 less than half of DIM2");
    take_constants(hexagon(d), property);
    const double y = d[2] / 2, z = d[1] / 2 - d[0];
    property.section.fibres = {{y, z}, {y, -z}, {-y, z}, {-y, -z}, {0, d[1] / 2}, {0, -d[1] / 2}};
  } else if (!shape.outline) {
    take_round(card, name, d, property);
  } else {
    take_outline(card, shape, d, property);
    const bool even = name == "I" && equal_lengths(d[1], d[2]) && equal_lengths(d[4], d[5]);
    if (!even || !card.good()) return;
    property.section.profile = Profile::i_section;
    property.section.dimensions = {d[0] / 2, d[0], d[1], d[2], d[4], d[5], d[3]};
    property.section.quarter_turn = true;
  }
}

}  // namespace floe::mesh
