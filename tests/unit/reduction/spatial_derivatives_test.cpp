#include <catch2/catch.hpp>

#include "bodies_in_space.h"
#include "eigenvalues.h"
#include "floe/reduction/derivatives.h"

using namespace floe;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using generate::ShellCells;
using testing::Kind;
using testing::SpatiallyConstrained;
using testing::Spread;
using testing::What;

namespace {

std::vector<PetscInt> root_of(bool beams) { return beams ? std::vector<PetscInt>{0} : testing::root_of_plate(); }

What kind_of(bool beams) { return beams ? What::beams : What::triangles; }

}  // namespace

TEST_CASE("static derivatives in space solve K theta = -(dK/deta_j) phi_i under the joints, in the frame") {
  const bool beams = GENERATE(false, true);
  const Kind kind = GENERATE(Kind::clamped, Kind::mean_axis);
  const SpatiallyConstrained body(body_of(kind_of(beams), PETSC_COMM_WORLD, Spread::shuffled), kind, root_of(beams));
  const fem::Structure& s = body.structure;
  const reduction::Modes modes = body.modes(3);
  const reduction::Pairs pairs = reduction::all_pairs(3);
  const reduction::Columns theta = reduction::static_derivatives(s, body.statics, modes.shapes, pairs);
  const petsc::MatHandle K = fem::stiffness(s, {});
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const petsc::VecHandle load = fem::stiffness_derivative(s, modes.shapes[pairs[p][0]], modes.shapes[pairs[p][1]]);
    fem::balance(body.frame, load);
    VectorXd left = testing::product(K, theta[p]), right = -testing::everywhere(load);
    const double scale = right.cwiseAbs().maxCoeff();
    for (PetscInt dof : body.holding.constrained) left[dof] = right[dof] = 0;  // the joints' reactions
    CHECK((left - right).cwiseAbs().maxCoeff() < 1e-8 * scale);
    const VectorXd before = testing::everywhere(theta[p]);
    CHECK(before.norm() > 0);
    fem::to_frame(body.frame, theta[p]);
    CHECK(testing::relative_error(testing::everywhere(theta[p]), before) < 1e-9);
  }
}

TEST_CASE("static derivatives in space are the same on any partition") {
  const bool beams = GENERATE(false, true);
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled);
  const SpatiallyConstrained all(body_of(kind_of(beams), PETSC_COMM_WORLD, spread), Kind::clamped, root_of(beams)),
      alone(body_of(kind_of(beams), PETSC_COMM_SELF, Spread::last), Kind::clamped, root_of(beams));
  const auto derivatives = [](const SpatiallyConstrained& body) {
    std::vector<VectorXd> columns;
    for (const auto& theta :
         reduction::static_derivatives(body.structure, body.statics, body.modes(3).shapes, reduction::all_pairs(3)))
      columns.push_back(testing::in_original_order(body.structure, theta));
    return columns;
  };
  const auto found = derivatives(all), expected = derivatives(alone);
  REQUIRE(found.size() == 6);
  for (std::size_t p = 0; p < 6; ++p) CHECK(testing::relative_error(found[p], expected[p]) < 1e-6);
}

TEST_CASE("full derivatives in space satisfy eq. 10 and are M-orthogonal to their mode") {
  const bool beams = GENERATE(false, true);
  const SpatiallyConstrained body(body_of(kind_of(beams), PETSC_COMM_WORLD, Spread::metis), Kind::clamped,
                                  root_of(beams));
  const fem::Structure& s = body.structure;
  const fem::Conditions& constrained = body.holding.constrained;
  const reduction::Modes modes = body.modes(3);
  reduction::Pairs which;
  const reduction::Columns theta =
      reduction::full_derivatives(s, body.frame, body.holding, body.statics, modes, reduction::all_pairs(3), which);
  REQUIRE((theta.size() == 9 && which.size() == 9));
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {});
  for (std::size_t p = 0; p < theta.size(); ++p) {
    const auto [i, j] = which[p];
    INFO(i << "," << j);
    const double lambda = modes.omega[i] * modes.omega[i];
    const VectorXd Mtheta = testing::product(M, theta[p]);  // at the clamp frame and joints agree: raw = shape
    const petsc::VecHandle load = fem::stiffness_derivative(s, modes.shapes[i], modes.shapes[j]);
    const VectorXd f = testing::everywhere(load);
    const double slope = testing::everywhere(modes.shapes[i]).dot(f);
    VectorXd left = testing::product(K, theta[p]) - lambda * Mtheta,
             right = slope * testing::product(M, modes.raw[i]) - f;
    for (PetscInt dof : constrained) left[dof] = right[dof] = 0;
    CHECK((left - right).cwiseAbs().maxCoeff() < 1e-7 * f.cwiseAbs().maxCoeff());
    CHECK(std::abs(testing::everywhere(modes.raw[i]).dot(Mtheta)) <
          1e-8 * std::sqrt(testing::everywhere(theta[p]).dot(Mtheta)));
  }
}

TEST_CASE("full derivatives in space are the derivatives of the modes of the deformed body") {
  // (K + eta dK/deta_j) phi = omega^2 M phi, the tangent's part of first order in eta: differences of a dense solve
  const SpatiallyConstrained body(body_of(What::beams, PETSC_COMM_SELF, Spread::last), Kind::clamped, root_of(true));
  const fem::Structure& s = body.structure;
  const reduction::Modes modes = body.modes(2);
  reduction::Pairs which;
  const reduction::Columns theta =
      reduction::full_derivatives(s, body.frame, body.holding, body.statics, modes, {{0, 0}, {0, 1}, {1, 1}}, which);
  REQUIRE(theta.size() == 4);
  const MatrixXd K = testing::dense(s, fem::stiffness(s, {})), M = testing::dense(s, fem::mass(s, {}));
  const auto first_order = [&](const petsc::VecHandle& along) {
    MatrixXd dK(s.dofs(), s.dofs());
    for (Eigen::Index c = 0; c < dK.cols(); ++c)
      dK.col(c) =
          testing::everywhere(fem::stiffness_derivative(s, testing::field_of(s, VectorXd::Unit(dK.rows(), c)), along));
    return dK;
  };
  std::vector<int> free;
  for (int dof = 0; dof < s.dofs(); ++dof)
    if (!std::count(body.holding.constrained.begin(), body.holding.constrained.end(), dof)) free.push_back(dof);
  for (std::size_t p = 0; p < theta.size(); ++p) {
    const auto [i, j] = which[p];
    const MatrixXd dK = first_order(modes.shapes[j]);
    const auto mode = [&, i = i](double eta) -> VectorXd {
      const Eigen::MatrixXd vectors = testing::eigenvectors((K + eta * dK)(free, free), M(free, free));
      VectorXd phi = VectorXd::Zero(s.dofs());
      phi(free) = vectors.col(i);
      return phi.dot(testing::everywhere(modes.raw[i])) < 0 ? VectorXd(-phi) : phi;
    };
    INFO(i << "," << j);
    CHECK(testing::relative_error(testing::everywhere(theta[p]), testing::derivative(mode, 0, 1e-4)) < 2e-4);
  }
}

TEST_CASE("full derivatives in space have the same energies on any partition") {
  const bool beams = GENERATE(false, true);
  const auto energies = [&](MPI_Comm comm, Spread spread) {
    const SpatiallyConstrained body(body_of(kind_of(beams), comm, spread), Kind::clamped, root_of(beams));
    reduction::Pairs which;
    const petsc::MatHandle K = fem::stiffness(body.structure, {});
    std::vector<double> all;
    for (const auto& theta : reduction::full_derivatives(body.structure, body.frame, body.holding, body.statics,
                                                         body.modes(3), reduction::all_pairs(3), which))
      all.push_back(testing::form(K, theta, theta));
    return all;
  };
  const auto found = energies(PETSC_COMM_WORLD, Spread::shuffled), expected = energies(PETSC_COMM_SELF, Spread::last);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-8));
}
