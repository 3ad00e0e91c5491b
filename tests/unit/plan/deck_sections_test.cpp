#include "../../../src/plan/deck_sections.h"

#include <catch2/catch.hpp>

#include "floe/fem/structure.h"

using namespace floe;

namespace {

fem::SpatialBeamSection section(const mesh::BeamSection& own) {
  mesh::DeckFile file;
  file.deck.materials = {{"M", mesh::Elasticity::isotropic, {2.6, 0.3}, 1}};  // G = 1
  file.deck.beam_sections = {own};
  return std::get<fem::SpatialBeam>(plan::deck_sections(file).parts.at(0)).section;
}

mesh::BeamSection profile(mesh::Profile kind, const std::vector<double>& dimensions) {
  mesh::BeamSection own;
  own.part = "B", own.number = 0, own.material = "M", own.profile = kind, own.dimensions = dimensions;
  return own;
}

}  // namespace

TEST_CASE("an ellipse has the area, moments of inertia and torsion constant of its integrals") {
  constexpr double a = 0.3, b = 0.2, h = 5e-4;
  double A = 0, Iy = 0, Iz = 0, J = 0;  // J = 2 int phi dA, lap phi = -2, phi = 0 at the edge
  for (double y = -a + h / 2; y < a; y += h)
    for (double z = -b + h / 2; z < b; z += h) {
      const double inside = 1 - y * y / (a * a) - z * z / (b * b);
      if (inside < 0) continue;
      A += h * h, Iy += z * z * h * h, Iz += y * y * h * h;
      J += 2 * inside * a * a * b * b / (a * a + b * b) * h * h;
    }
  const auto found = section(profile(mesh::Profile::circle, {a, b}));
  CHECK(found.rhoA == Approx(A).epsilon(1e-3));
  CHECK(found.EIy == Approx(2.6 * Iy).epsilon(1e-3));
  CHECK(found.EIz == Approx(2.6 * Iz).epsilon(1e-3));
  CHECK(found.GJ == Approx(J).epsilon(1e-3));
  const auto equal = section(profile(mesh::Profile::circle, {a, a})),
             round = section(profile(mesh::Profile::circle, {a}));
  CHECK(equal.GJ == Approx(round.GJ));
  CHECK(equal.EIy == Approx(round.EIy));
}

TEST_CASE("offsets of an ellipse are parts of its diameters") {
  auto own = profile(mesh::Profile::circle, {0.3, 0.2});
  own.offset_1 = 0.5, own.offset_2 = 0.25;
  CHECK((section(own).centroid - Eigen::Vector2d(-0.3, -0.1)).norm() < 1e-15);
}
