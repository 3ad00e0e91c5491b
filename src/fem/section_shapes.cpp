#include <algorithm>
#include <cmath>
#include <string>

#include "floe/error.h"
#include "floe/fem/beam_section_3d.h"

namespace floe::fem {
namespace {

constexpr double pi = 3.14159265358979323846;

void expect_positive(const char* shape, std::initializer_list<double> sizes) {
  for (const double size : sizes)
    if (!(size > 0) || !std::isfinite(size))
      throw InputError(std::string(shape) +
                       ": sizes must be positive, of hollow shapes also what the walls leave, not " +
                       std::to_string(size));
}

double rectangle_torsion(double a, double b) {
  if (a < b) std::swap(a, b);
  double sum = 0;
  for (int n = 2001; n >= 1; n -= 2)  // smallest first; what is left out is below 1e-14
    sum += std::tanh(n * pi * a / (2 * b)) / std::pow(n, 5);
  return a * b * b * b * (1.0 / 3 - 64 / std::pow(pi, 5) * b / a * sum);
}

/// J / W.
double rectangle_shear(double a, double b) {
  if (a < b) std::swap(a, b);
  double sum = 0;
  for (int n = 41; n >= 1; n -= 2) sum += 1 / (std::pow(n, 2) * std::cosh(n * pi * a / (2 * b)));
  return b * (1 - 8 / (pi * pi) * sum);
}

SectionShape without(const SectionShape& outer, const SectionShape& hole) {
  return {outer.A - hole.A, outer.Iy - hole.Iy, outer.Iz - hole.Iz, 0, outer.J - hole.J};
}

}  // namespace

SectionShape rectangle(double b, double h) {
  expect_positive("rectangle", {b, h});
  SectionShape shape{b * h, b * h * h * h / 12, h * b * b * b / 12, 0, rectangle_torsion(b, h)};
  shape.W = shape.J / rectangle_shear(b, h);
  return shape;
}

SectionShape circle(double radius) {
  expect_positive("circle", {radius});
  const double A = pi * radius * radius, I = A * radius * radius / 4;
  SectionShape shape{A, I, I, 0, 2 * I};
  shape.W = shape.J / radius;
  return shape;
}

SectionShape tube(double outer, double inner) {
  expect_positive("tube", {outer, inner, outer - inner});
  SectionShape shape = without(circle(outer), circle(inner));
  shape.W = shape.J / outer;
  return shape;
}

SectionShape box(double b, double h, double side, double cover) {
  expect_positive("box", {b, h, side, cover, b - 2 * side, h - 2 * cover});
  SectionShape shape = without(rectangle(b, h), rectangle(b - 2 * side, h - 2 * cover));
  const double bm = b - side, hm = h - cover;
  shape.J = 4 * bm * bm * hm * hm / (2 * hm / side + 2 * bm / cover);
  shape.W = 2 * bm * hm * std::min(side, cover);
  return shape;
}

SectionShape i_section(double b, double h, double flange, double web) {
  expect_positive("I section", {b, h, flange, web, h - 2 * flange});
  if (web > b) throw InputError("I section: its web is wider than its flanges");
  SectionShape shape = without(rectangle(b, h), rectangle(b, h - 2 * flange));
  const SectionShape middle = rectangle(web, h - 2 * flange);
  shape.A += middle.A, shape.Iy += middle.Iy, shape.Iz += middle.Iz;
  shape.J = (2 * b * std::pow(flange, 3) + (h - flange) * std::pow(web, 3)) / 3;
  shape.W = shape.J / std::max(flange, web);
  return shape;
}

SectionShape rotated(const SectionShape& shape, double angle) {
  const Eigen::Rotation2Dd rotation(angle);
  const Eigen::Matrix2d R = rotation.toRotationMatrix();
  Eigen::Matrix2d second;  // int [y, z]' [y, z]
  second << shape.Iz, shape.Iyz, shape.Iyz, shape.Iy;
  second = (R * second * R.transpose()).eval();
  return {shape.A, second(1, 1),           second(0, 0), (second(0, 1) + second(1, 0)) / 2,
          shape.J, R * shape.shear_centre, shape.W};
}

double shear_modulus(double E, double nu) {
  if (!(nu > -1 && nu <= 0.5)) throw InputError("Poisson's ratio must lie in (-1, 0.5], not " + std::to_string(nu));
  return E / (2 * (1 + nu));
}

SpatialBeamSection spatial_section(const SectionShape& shape, const BeamMaterial& m, const Eigen::Vector2d& centroid) {
  SpatialBeamSection section;
  section.EA = m.E * shape.A, section.GJ = m.G * shape.J;
  section.EIy = m.E * shape.Iy, section.EIz = m.E * shape.Iz, section.EIyz = m.E * shape.Iyz;
  section.rhoA = m.rho * shape.A;
  section.rhoIy = m.rho * shape.Iy, section.rhoIz = m.rho * shape.Iz, section.rhoIyz = m.rho * shape.Iyz;
  section.centroid = centroid;
  section.shear_centre = centroid + shape.shear_centre;
  check(section);
  return section;
}

void check(const SpatialBeamSection& s) {
  const auto expect = [](bool good, const char* fault) {
    if (!good) throw InputError(std::string("beam section: ") + fault);
  };
  const double sum = s.EA + s.EIy + s.EIz + s.EIyz + s.GJ + s.rhoA + s.rhoIy + s.rhoIz + s.rhoIyz;
  expect(std::isfinite(sum) && s.centroid.allFinite() && s.shear_centre.allFinite(), "a value is not finite");
  expect(s.EA > 0, "axial stiffness must be positive");
  expect(s.GA.minCoeff() > 0, "shear stiffness must be positive");
  expect(s.EIy >= 0 && s.EIz >= 0 && s.GJ >= 0, "bending and torsional stiffness must not be negative");
  expect(s.rhoA >= 0 && s.rhoIy >= 0 && s.rhoIz >= 0, "mass and rotary inertia must not be negative");
  constexpr double rounding = 1 + 1e-9;
  expect(s.EIyz * s.EIyz <= s.EIy * s.EIz * rounding, "EIyz^2 exceeds EIy EIz");
  expect(s.rhoIyz * s.rhoIyz <= s.rhoIy * s.rhoIz * rounding, "rhoIyz^2 exceeds rhoIy rhoIz");
  expect(s.rhoA > 0 || s.rhoIy + s.rhoIz == 0, "rotary inertia without mass");
}

}  // namespace floe::fem
