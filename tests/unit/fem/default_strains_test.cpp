#include "floe/fem/default_strains.h"

#include <catch2/catch.hpp>

#include "floe/generate/generate.h"
#include "floe/mesh/partition.h"
#include "floe/petsc/error.h"

using namespace floe;
using Eigen::Vector3d;

namespace {

constexpr double thickness = 0.01;

/// A plate of 1 x `width`, oblique in space, with an arc of `height` across.
fem::StrainsChoice choice_of(double width, double height) {
  const Vector3d along = Vector3d(3, 2, -1).normalized(), across = along.unitOrthogonal(), normal = along.cross(across);
  generate::Plate plate;
  plate.a = along, plate.b = width * across, plate.na = 8, plate.nb = 4;
  mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
  for (Vector3d& x : raw.positions) {
    const double s = 2 * x.dot(across) / width - 1;
    x += height * (1 - s * s) * normal;
  }
  const fem::Mesh mesh = fem::mesh_of(raw, mesh::partition(raw));
  return fem::default_strains(mesh, {fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), thickness}})});
}

}  // namespace

TEST_CASE("default strains: von Karman's for flat, wide shells alone") {
  const fem::StrainsChoice flat = choice_of(0.5, 0), strip = choice_of(0.1, 0),
                           curved = choice_of(0.5, 0.2 * thickness);
  CHECK(flat.strains() == fem::Strains::von_karman);
  CHECK(flat.height < 1e-10);
  CHECK(flat.width == Approx(0.5).epsilon(0.2));  // exact but for the corners' share of the area's moments
  CHECK(flat.text().substr(0, 10) == "von_karman");
  CHECK(strip.strains() == fem::Strains::second_order);
  CHECK(strip.text().substr(0, 26) == "second_order (width/length");
  CHECK(curved.strains() == fem::Strains::second_order);
  CHECK(curved.height == Approx(0.2));
  CHECK(curved.text() == "second_order (height 0.2 thicknesses, limit 0.1)");
  CHECK(choice_of(0.5, 0.05 * thickness).strains() == fem::Strains::von_karman);
}

TEST_CASE("default strains: of second order for beams in space") {
  const fem::Mesh line = fem::mesh_of(PETSC_COMM_WORLD, {{Vector3d::Zero(), Vector3d::UnitX()}, {{0, 1}}, {4}});
  const fem::StrainsChoice choice = fem::default_strains(line, {fem::SpatialBeam{}});
  CHECK(choice.strains() == fem::Strains::second_order);
  CHECK(choice.text() == "second_order (beams)");
}
