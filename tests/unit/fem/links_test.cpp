#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

#include "floe/fem/assembly.h"
#include "floe/fem/element_stiffness.h"
#include "floe/fem/reference_frame.h"
#include "floe/fem/transform.h"
#include "spatial_structures.h"

using namespace floe;
using testing::Spread;

namespace {

/// q of all nodes from the linked ones, by original dofs: rows of dependent nodes say how their independent nodes move
/// them; those on hinge lines rotate by themselves about the axis besides, theta = (1 - e e') theta_independent + e
/// phi.
Eigen::MatrixXd following(const std::vector<mesh::DependentNode>& dependent_nodes) {
  const mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_SELF);
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(6 * raw.node_count, 6 * raw.node_count);
  for (const mesh::DependentNode& f : dependent_nodes) {
    const Eigen::Vector3d e(f.axis[0], f.axis[1], f.axis[2]);
    Eigen::Matrix<double, 6, 6> by_independent_node =
        fem::rigid_arm(Eigen::Vector3d(raw.positions[f.node] - raw.positions[f.independent_node]));
    by_independent_node.bottomRightCorner<3, 3>() -= e * e.transpose();
    T.block<6, 6>(6 * f.node, 6 * f.node).setZero();
    if (f.spins()) T.block<3, 1>(6 * f.node + 3, 6 * f.node + 3 + fem::spin_slot(e)) = e;
    T.block<6, 6>(6 * f.node, 6 * f.independent_node) = by_independent_node;
  }
  return T;
}

/// K q and M q of a structure with dependent nodes are T' K0 T q and T' M0 T q of the free nodes, and its nodes move by
/// T q.
void check_image(const fem::Structure& s, const fem::Structure& free, const Eigen::MatrixXd& T,
                 const Eigen::VectorXd& q) {
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {}), K0 = fem::stiffness(free, {}),
                         M0 = fem::mass(free, {});
  for (const auto& [with, without] : {std::pair<Mat, Mat>(K, K0), {M, M0}}) {
    const Eigen::VectorXd expected = T.transpose() * testing::product_in_originals(free, without, T * q),
                          found = testing::product_in_originals(s, with, q);
    CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-11 * expected.cwiseAbs().maxCoeff());
  }
  const petsc::VecHandle field = testing::field_of_originals(s, q);
  petsc::Values own(field);
  const Eigen::VectorXd all = T * q;
  for (int node = 0; node < s.mesh.owned_nodes; ++node) {
    const Eigen::VectorXd at = all.segment<6>(6 * s.mesh.original_node(node));
    CHECK((fem::nodal_motion(s, own.begin(), node) - at).norm() < 1e-13);
  }
}

}  // namespace

TEST_CASE("rigid links: K and M are those of the free nodes, seen by the dofs that move them") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed);
  const fem::Structure s = testing::linked_structure(PETSC_COMM_WORLD, spread),
                       free = testing::mixed_structure(PETSC_COMM_WORLD, spread);
  const Eigen::MatrixXd T = following(testing::mixed_links());
  testing::Random random(3);
  for (int trial = 0; trial < 3; ++trial) {
    check_image(s, free, T, random.vector(s.dofs()));
  }
}

TEST_CASE("rigid links: bodies keep their rigid motions, and followers are held") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::last);
  const fem::Structure s = testing::linked_structure(PETSC_COMM_WORLD, spread),
                       free = testing::mixed_structure(PETSC_COMM_WORLD, spread);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {}), M0 = fem::mass(free, {});
  const auto rigid = fem::rigid_motions(s), whole = fem::rigid_motions(free);
  for (int i = 0; i < 6; ++i) {
    CHECK(testing::product(K, rigid[i]).cwiseAbs().maxCoeff() < 1e-10);
    for (int j = 0; j < 6; ++j)
      CHECK(testing::form(M, rigid[i], rigid[j]) == Approx(testing::form(M0, whole[i], whole[j])).margin(1e-12));
  }
  const fem::ReferenceFrame frame = fem::reference_frame(s, fem::ReferenceFrame::Kind::mean_axis, 0, 0);
  const fem::Holding holding = fem::holding(s, frame, {});
  CHECK(holding.left.cols() == 6);
  CHECK(holding.constrained == testing::dofs_of(s, {2, 9, 13}, {0, 1, 2, 3, 4, 5}));
}

TEST_CASE("hinge lines: K and M are those of the free nodes, seen by the line and the turns of its nodes") {
  const bool links = GENERATE(false, true);
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed);
  const fem::Structure s = testing::hinged_structure(PETSC_COMM_WORLD, spread, links),
                       free = testing::mixed_structure(PETSC_COMM_WORLD, spread);
  const std::vector<mesh::DependentNode> dependent_nodes = testing::mixed_lines(links);
  CHECK(std::count_if(dependent_nodes.begin(), dependent_nodes.end(), [](const auto& f) { return f.spins(); }) == 4);
  const Eigen::MatrixXd T = following(dependent_nodes);
  const petsc::MatHandle K = fem::stiffness(s, {});
  testing::Random random(3);
  for (int trial = 0; trial < 3; ++trial) {
    const Eigen::VectorXd q = random.vector(s.dofs());
    check_image(s, free, T, q);
    const petsc::VecHandle field = testing::field_of_originals(s, q);
    const auto elements = std::make_shared<fem::ElementStiffness>(s);
    const petsc::VecHandle by_pieces = fem::field(s);
    elements->multiply(field, by_pieces);
    const Eigen::VectorXd expected = testing::product_in_originals(s, K, q);
    CHECK((testing::in_original_order(s, by_pieces) - expected).norm() < 1e-11 * expected.norm());
    std::vector<petsc::VecHandle> fields;
    fields.push_back(testing::field_of_originals(s, q)),
        fields.push_back(testing::field_of_originals(s, random.vector(s.dofs())));
    const Eigen::VectorXd slow = testing::in_original_order(s, fem::stiffness_derivative(s, fields[0], fields[1])),
                          fast = testing::in_original_order(s, fem::stiffness_derivatives(s, fields, {{0, 1}})[0]);
    CHECK((fast - slow).norm() < 1e-11 * slow.norm());
  }
}

TEST_CASE("hinge lines: bodies keep their rigid motions, and followers are held but for their turns") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::last);
  const fem::Structure s = testing::hinged_structure(PETSC_COMM_WORLD, spread, true),
                       free = testing::mixed_structure(PETSC_COMM_WORLD, spread);
  const petsc::MatHandle K = fem::stiffness(s, {}), M = fem::mass(s, {}), M0 = fem::mass(free, {});
  const auto rigid = fem::rigid_motions(s), whole = fem::rigid_motions(free);
  for (int i = 0; i < 6; ++i) {
    CHECK(testing::product(K, rigid[i]).cwiseAbs().maxCoeff() < 1e-10);
    for (int j = 0; j < 6; ++j)
      CHECK(testing::form(M, rigid[i], rigid[j]) == Approx(testing::form(M0, whole[i], whole[j])).margin(1e-12));
  }
  const fem::ReferenceFrame frame = fem::reference_frame(s, fem::ReferenceFrame::Kind::mean_axis, 0, 0);
  const fem::Holding holding = fem::holding(s, frame, {});
  CHECK(holding.left.cols() == 6);
  std::size_t constrained = 0;
  for (const mesh::DependentNode& f : testing::mixed_lines(true)) constrained += f.spins() ? 5 : 6;
  CHECK(holding.constrained.size() == constrained);
}
