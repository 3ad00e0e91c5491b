#include "floe/reduction/derivatives.h"

#include <catch2/catch.hpp>
#include <numbers>

#include "bodies.h"
#include "eigenvalues.h"

using namespace floe;
using Eigen::VectorXd;
using testing::everywhere;
using testing::Held;
using testing::Kind;

namespace {

fem::Structure paper_beam(MPI_Comm comm, PetscInt elements) {
  return testing::straight(comm, elements, 100, testing::paper_section());
}

/// The equilibrium of the constrained body under a load, by Newton on dense matrices.
VectorXd equilibrium(const fem::Structure& s, const fem::Conditions& constrained, const VectorXd& load) {
  VectorXd q = VectorXd::Zero(s.dofs());
  for (int iteration = 0; iteration < 8; ++iteration) {
    testing::FullElasticity at(s, q);
    VectorXd out = load - at.force;
    for (PetscInt dof : constrained)
      at.tangent.row(dof).setZero(), at.tangent.col(dof).setZero(), at.tangent(dof, dof) = 1, out[dof] = 0;
    q += at.tangent.ldlt().solve(out);
  }
  return q;
}

}  // namespace

TEST_CASE("static derivatives are the second-order part of the equilibrium under K (eta_i phi_i + eta_j phi_j)") {
  // q(eta) = sum eta_i phi_i + 1/2 sum_ij eta_i eta_j theta_ij + ..., and the mixed difference gives theta_ij
  const fem::Conditions constrained = GENERATE(fem::Conditions{0, 1, 2}, fem::Conditions{0, 1, 18, 19});
  const Held body(paper_beam(PETSC_COMM_WORLD, 6), Kind::clamped, constrained);
  const fem::Structure& s = body.structure;
  const reduction::Modes modes = reduction::vibration_modes(s, body.frame, body.holding, body.statics, 3);
  const petsc::MatHandle K = fem::stiffness(s, {});
  // Differences are taken of the body as it is constrained (raw modes); the frame's projector then acts on the result.
  const reduction::Columns theta = reduction::static_derivatives(s, body.statics, modes.raw, reduction::all_pairs(3));
  const reduction::Pairs pairs = reduction::all_pairs(3);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [i, j] = pairs[p];
    const VectorXd fi = testing::product(K, modes.raw[i]), fj = testing::product(K, modes.raw[j]);
    const auto q = [&](double a, double b) { return equilibrium(s, constrained, a * fi + b * fj); };
    const auto second = [&](double h) -> VectorXd {
      return i == j ? VectorXd((q(h, 0) + q(-h, 0)) / (h * h))
                    : VectorXd((q(h, h) - q(h, -h) - q(-h, h) + q(-h, -h)) / (4 * h * h));
    };
    const double h = 1.0 / modes.omega[2];
    const VectorXd difference = (4 * second(h) - second(2 * h)) / 3;  // order 4 in h
    const petsc::VecHandle expected = testing::field_of(s, difference);
    fem::to_frame(body.frame, expected);
    INFO(i << "," << j);
    const double scale =
        std::max(everywhere(theta[0]).cwiseAbs().maxCoeff(), everywhere(expected).cwiseAbs().maxCoeff());
    CHECK((everywhere(theta[p]) - everywhere(expected)).cwiseAbs().maxCoeff() < 1e-5 * scale);
  }
}

TEST_CASE("derivatives of hinged modes against the closed form") {
  // phi_n = sqrt(2) sin(n pi x); ends axially fixed: theta_ij of sines, twice for the norm
  const int n = 48;
  const bool fixed = GENERATE(true, false);
  const double pi = std::numbers::pi;
  const fem::Conditions constrained =
      fixed ? fem::Conditions{0, 1, 3 * n, 3 * n + 1} : fem::Conditions{0, 1, 3 * n + 1};
  const Held body(testing::straight(PETSC_COMM_WORLD, n, 1, {1e8, 1, 1, 0}), Kind::pinned, constrained);
  const reduction::Modes modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 3);
  const reduction::Pairs pairs = reduction::all_pairs(3);
  const reduction::Columns theta = reduction::static_derivatives(body.structure, body.statics, modes.shapes, pairs);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const double i = pairs[p][0] + 1, j = pairs[p][1] + 1;
    const VectorXd found = everywhere(theta[p]);
    double greatest = 0;
    for (int node = 0; node <= n; ++node) {
      const double x = double(node) / n;
      double u =
          i == j ? -(i * pi / 4) * std::sin(2 * i * pi * x)
                 : -(i * j * pi / 2) * (std::sin((i - j) * pi * x) / (i - j) + std::sin((i + j) * pi * x) / (i + j));
      if (!fixed && i == j) u -= i * i * pi * pi / 2 * x;
      greatest = std::max(greatest, std::abs(found[3 * node] - 2 * u) + std::abs(found[3 * node + 1]));
    }
    CHECK(greatest < 0.01 * i * j);  // the mesh's own error
  }
}

TEST_CASE("derivatives are solved under the joints' axial conditions") {
  const PetscInt n = 6;
  const Held movable(paper_beam(PETSC_COMM_WORLD, n), Kind::pinned, {0, 1, 3 * n + 1});
  const Held immovable(paper_beam(PETSC_COMM_WORLD, n), Kind::pinned, {0, 1, 3 * n, 3 * n + 1});
  const auto end = [&](const Held& body) {
    const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 1);
    return everywhere(reduction::static_derivatives(body.structure, body.statics, modes.shapes, {{0, 0}})[0])[3 * n];
  };
  CHECK(std::abs(end(immovable)) < 1e-14);
  CHECK(end(movable) < -1e-4);
}

TEST_CASE("full derivatives satisfy eq. 10 and are M-orthogonal to their mode, as the joints hold the body") {
  const fem::Conditions constrained = GENERATE(fem::Conditions{0, 1, 2}, fem::Conditions{0, 1, 24, 25});
  const Kind kind = GENERATE(Kind::clamped, Kind::pinned, Kind::mean_axis);
  const Held body(paper_beam(PETSC_COMM_WORLD, 8), kind, constrained);
  const fem::Structure& s = body.structure;
  const reduction::Modes modes = reduction::vibration_modes(s, body.frame, body.holding, body.statics, 4);
  reduction::Pairs which;
  const reduction::Columns theta =
      reduction::full_derivatives(s, body.frame, body.holding, body.statics, modes, reduction::all_pairs(4), which);
  REQUIRE(theta.size() == 16);  // (i, j) and (j, i)
  REQUIRE(which.size() == 16);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {});
  Eigen::MatrixXd rigid(s.dofs(), 3);
  for (int i = 0; i < 3; ++i) rigid.col(i) = everywhere(body.frame.rigid[i]);
  const auto mass = [&](const VectorXd& x) { return testing::product(M, testing::field_of(s, x)); };
  for (std::size_t p = 0; p < theta.size(); ++p) {
    const auto [i, j] = which[p];
    const double lambda = modes.omega[i] * modes.omega[i];
    // theta stands in the frame; the rigid motion that brings it back under the joints is unique
    VectorXd raw = everywhere(theta[p]);
    const VectorXd away = raw(constrained),
                   back = rigid(constrained, Eigen::all).completeOrthogonalDecomposition().solve(away);
    raw -= rigid * back;
    CHECK(raw(constrained).cwiseAbs().maxCoeff() <= 1e-9 * raw.cwiseAbs().maxCoeff());
    const petsc::VecHandle load = fem::stiffness_derivative(s, modes.shapes[i], modes.shapes[j]);
    const double slope = everywhere(modes.shapes[i]).dot(everywhere(load));
    fem::balance(body.frame, load);
    VectorXd left = testing::product(K, theta[p]) - lambda * mass(raw);
    VectorXd right = slope * testing::product(M, modes.raw[i]) - everywhere(load);
    for (PetscInt dof : constrained) left[dof] = right[dof] = 0;
    const double scale = everywhere(load).cwiseAbs().maxCoeff();
    INFO(i << "," << j);
    CHECK((left - right).cwiseAbs().maxCoeff() < 1e-8 * scale + 1e-9);
    CHECK(std::abs(everywhere(modes.raw[i]).dot(mass(raw))) <= 1e-9 * std::sqrt(raw.dot(mass(raw))));
  }
}

TEST_CASE("full derivatives are the derivatives of the modes of the deformed body") {
  // K(q) phi = omega^2 M phi at q = eta phi_j: differences of the mode i, by a dense eigenvalue solve
  const fem::Conditions constrained{0, 1, 18, 19};
  const Held body(paper_beam(PETSC_COMM_WORLD, 6), Kind::pinned, constrained);
  const fem::Structure& s = body.structure;
  const reduction::Modes modes = reduction::vibration_modes(s, body.frame, body.holding, body.statics, 2);
  reduction::Pairs which;
  const reduction::Columns theta =
      reduction::full_derivatives(s, body.frame, body.holding, body.statics, modes, {{0, 1}}, which);
  const Eigen::Index n = s.dofs();
  Eigen::MatrixXd M(n, n);
  const petsc::MatHandle mass = fem::mass(s, {});
  for (Eigen::Index c = 0; c < n; ++c) M.col(c) = testing::product(mass, testing::field_of(s, VectorXd::Unit(n, c)));
  std::vector<int> free;
  for (int dof = 0; dof < n; ++dof)
    if (!std::count(constrained.begin(), constrained.end(), dof)) free.push_back(dof);
  const auto mode = [&](int i, const VectorXd& q) -> VectorXd {
    const Eigen::MatrixXd K = testing::FullElasticity(s, q).tangent;
    const Eigen::MatrixXd vectors = testing::eigenvectors(K(free, free), M(free, free));
    VectorXd phi = VectorXd::Zero(n);
    phi(free) = vectors.col(i);
    return phi.dot(everywhere(modes.raw[i])) < 0 ? VectorXd(-phi) : phi;
  };
  for (std::size_t p = 0; p < theta.size(); ++p) {
    const auto [i, j] = which[p];
    const VectorXd along = everywhere(modes.raw[j]);
    const VectorXd difference = testing::derivative([&, i = i](double eta) { return mode(i, eta * along); }, 0, 1e-2);
    const petsc::VecHandle expected = testing::field_of(s, difference);
    fem::to_frame(body.frame, expected);
    CHECK(testing::relative_error(everywhere(theta[p]), everywhere(expected)) < 1e-5);
  }
}

TEST_CASE("all pairs come in the order (1,1) (1,2) ... (m,m)") {
  CHECK(reduction::all_pairs(3) == reduction::Pairs{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}});
  CHECK(reduction::all_pairs(0).empty());
}

TEST_CASE("the same derivatives on any number of ranks") {
  const bool full = GENERATE(false, true);
  const auto energies = [&](MPI_Comm comm) {
    const Held body(paper_beam(comm, 10), Kind::pinned, {0, 1, 2});
    const auto modes = reduction::vibration_modes(body.structure, body.frame, body.holding, body.statics, 4);
    reduction::Pairs which;
    const reduction::Columns theta =
        full ? reduction::full_derivatives(body.structure, body.frame, body.holding, body.statics, modes,
                                           reduction::all_pairs(4), which)
             : reduction::static_derivatives(body.structure, body.statics, modes.shapes, reduction::all_pairs(4));
    const petsc::MatHandle K = fem::stiffness(body.structure, {});
    std::vector<double> all;
    for (const auto& column : theta) all.push_back(testing::form(K, column, column));
    return all;
  };
  const std::vector<double> found = energies(PETSC_COMM_WORLD), expected = energies(PETSC_COMM_SELF);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-8).margin(1e-12));
}
