#include "floe/fem/piece_rows.h"

#include <catch2/catch.hpp>

#include "spatial_structures.h"

using namespace floe;
using Eigen::VectorXd;

TEST_CASE("the pieces of a cell have its energies and its mass") {
  const std::string kind = GENERATE("mixed", "linked", "hinged", "loose");
  const fem::Strains strains = GENERATE(fem::Strains::von_karman, fem::Strains::second_order);
  const testing::Order order = GENERATE(testing::Order::first, testing::Order::second);
  const auto spread = testing::Spread::shuffled;
  const std::vector<mesh::DependentNode> dependent_nodes = kind == "linked"   ? testing::mixed_links()
                                                           : kind == "hinged" ? testing::mixed_lines(true, order)
                                                           : kind == "loose"  ? testing::mixed_loose()
                                                                              : std::vector<mesh::DependentNode>{};
  fem::Structure s = testing::structure_with(PETSC_COMM_WORLD, spread, dependent_nodes, strains, order);
  if (GENERATE(false, true))  // the ramp's quadrilaterals are warped
    for (Eigen::Vector3d& x : s.mesh.positions)
      if ((x - Eigen::Vector3d(1.4, 0.5, 0.3)).norm() < 1e-9) x.z() += 0.05;
  testing::Random random(91);
  std::vector<fem::PieceRows> pieces;
  for (const auto& cell : s.mesh.cells) {
    const fem::ElementMaps maps = s.maps(cell);
    const VectorXd local = random.vector(s.local_dofs()), q = local(s.cell_dofs(cell));
    double bending = 0, membrane = 0, mass = 0, expected = 0;
    fem::piece_rows(s, cell, {true, true, true, true}, pieces);
    for (const auto& piece : pieces) {
      VectorXd own(6 * piece.nodes);
      for (int a = 0; a < piece.nodes; ++a) own.segment<6>(6 * a) = local.segment<6>(6 * piece.node[a]);
      if (piece.bending.size() > 0) bending += (piece.bending * own).squaredNorm();
      for (const auto& point : piece.strain) {
        VectorXd e = point.L * own;
        const VectorXd slope = point.G * own;
        for (const auto& t : point.terms)
          for (Eigen::Index r = 0; r < e.size(); ++r) e[r] += t.C[r] * slope[t.p] * slope[t.q] * (t.p == t.q ? 0.5 : 1);
        membrane += e.squaredNorm();
      }
      for (const auto& sample : piece.mass) mass += sample.mass * (sample.N * own).squaredNorm();
    }
    for (const auto& g : maps.membrane) {
      const VectorXd e = g.L * q + 0.5 * g.bilinear(g.G * q, g.G * q);
      expected += g.weight * e.dot(g.D * e);
    }
    if (mesh::is_quadratic(cell.kind)) {  // strains that are linear are bending in the pieces
      CHECK(bending + membrane == Approx(q.dot(maps.bending * q) + expected).epsilon(1e-11));
    } else {
      CHECK(bending == Approx(q.dot(maps.bending * q)).epsilon(1e-11));
      CHECK(membrane == Approx(expected).epsilon(1e-11));
    }
    CHECK(mass == Approx(q.dot(maps.mass_matrix() * q)).epsilon(1e-11));
  }
}
