#include <catch2/catch.hpp>

#include "floe/reduction/derivatives.h"
#include "scene_motion.h"

using namespace floe;

namespace {

constexpr double pi = M_PI, L = 2;
constexpr int elements = 60;

/// theta_ij of the hinged beam for modes scaled to sin(n pi x/L): (u, v) at node 0, 1, ...
struct Derivatives {
  std::vector<Eigen::VectorXd> theta;  ///< of the pairs, 3 entries a node
  reduction::Pairs pairs;
};

Derivatives derivatives(bool fixed_ends) {
  const fem::Structure structure =
      fem::planar_structure(fem::mesh_of(PETSC_COMM_WORLD, {{{0, 0, 0}, {L, 0, 0}}, {{0, 1}}, {elements}}),
                            {{1e5, 1, 1, 0}}, fem::MembraneStrain::averaged);
  const fem::ReferenceFrame frame = fem::reference_frame(structure, fem::ReferenceFrame::Kind::pinned, 0, elements);
  fem::Conditions constrained = {0, 1, 3 * elements + 1};
  if (fixed_ends) constrained.insert(constrained.begin() + 2, 3 * elements);
  const fem::Holding holding = fem::holding(structure, frame, constrained);
  const reduction::Statics statics(structure, frame, holding);
  reduction::Modes modes = reduction::vibration_modes(structure, frame, holding, statics, 3);
  for (int n = 1; n <= 3; ++n) {  // greatest value 1, at x = L/2n
    const double top = test::everywhere(modes.shapes[n - 1])[3 * (elements / (2 * n)) + 1];
    petsc::check(VecScale(modes.shapes[n - 1], 1 / top));
  }
  Derivatives result;
  result.pairs = reduction::all_pairs(3);
  for (const auto& theta : reduction::static_derivatives(structure, statics, modes.shapes, result.pairs))
    result.theta.push_back(test::everywhere(theta));
  return result;
}

/// Axially fixed ends: u of theta_ij.
double fixed(int i, int j, double x) {
  if (i == j) return -i * pi / (4 * L) * std::sin(2 * i * pi * x / L);
  return -i * j * pi / (2 * L) * (std::sin((i - j) * pi * x / L) / (i - j) + std::sin((i + j) * pi * x / L) / (i + j));
}

/// One end free to move along the axis.
double movable(int i, int j, double x) { return fixed(i, j, x) - (i == j ? i * i * pi * pi / (2 * L * L) * x : 0); }

}  // namespace

// Closed form of the straight von Karman beam: u' + phi_i' phi_j' has the mean (fixed) or is zero (movable); no
// transverse part. The elements give nodal values to the order h^2 of the averaged slopes.
TEST_CASE("modal derivatives of hinged modes in closed form") {
  for (const bool fixed_ends : {true, false}) {
    const Derivatives found = derivatives(fixed_ends);
    for (std::size_t p = 0; p < found.pairs.size(); ++p) {
      const int i = found.pairs[p][0] + 1, j = found.pairs[p][1] + 1;
      INFO((fixed_ends ? "fixed ends, theta_" : "movable end, theta_") << i << j);
      double greatest = 0, error_u = 0, error_v = 0;
      for (int node = 0; node <= elements; ++node) {
        const double x = L * node / elements, exact = fixed_ends ? fixed(i, j, x) : movable(i, j, x);
        greatest = std::max(greatest, std::abs(exact));
        error_u = std::max(error_u, std::abs(found.theta[p][3 * node] - exact));
        error_v = std::max(error_v, std::abs(found.theta[p][3 * node + 1]));
      }
      CHECK(error_u < 2e-5 * greatest);
      CHECK(error_v < 1e-8 * greatest);
    }
  }
}
