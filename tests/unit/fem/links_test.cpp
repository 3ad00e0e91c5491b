#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

#include "floe/fem/assembly.h"
#include "floe/fem/element_stiffness.h"
#include "floe/fem/flat_body.h"
#include "floe/fem/reference_frame.h"
#include "floe/fem/transform.h"
#include "spatial_structures.h"

using namespace floe;
using testing::Spread;

namespace {

Eigen::Matrix3d own_rotations(const mesh::DependentNode& f) {
  if (!f.spins()) return Eigen::Matrix3d::Zero();
  return fem::Mesh::Spin{0, Eigen::Vector3d(f.axis[0], f.axis[1], f.axis[2]), f.others}.own();
}

/// q of all nodes from the linked ones, by original dofs: rows of dependent nodes say how their independent nodes move
/// them; those with rotations of their own have these besides, theta = (1 - S S') theta_independent + S phi.
Eigen::MatrixXd following(const std::vector<mesh::DependentNode>& dependent_nodes) {
  const mesh::RawMesh raw = testing::mixed_mesh(PETSC_COMM_SELF);
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(6 * raw.node_count, 6 * raw.node_count);
  for (const mesh::DependentNode& f : dependent_nodes) {
    const Eigen::Matrix3d S = own_rotations(f);
    Eigen::Matrix<double, 6, 6> by_independent_node =
        fem::rigid_arm(Eigen::Vector3d(raw.positions[f.node] - raw.positions[f.independent_node]));
    by_independent_node.bottomRightCorner<3, 3>() -= S * S.transpose();
    T.block<6, 6>(6 * f.node, 6 * f.node).setZero();
    T.block<3, 3>(6 * f.node + 3, 6 * f.node + 3) = S;
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

TEST_CASE("own rotations of dependent nodes: K and M are those of the free nodes, seen by the dofs that move them") {
  const std::vector<mesh::DependentNode> dependent_nodes =
      GENERATE(testing::mixed_lines(false), testing::mixed_lines(true), testing::mixed_loose());
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::reversed);
  const fem::Structure s = testing::structure_with(PETSC_COMM_WORLD, spread, dependent_nodes),
                       free = testing::mixed_structure(PETSC_COMM_WORLD, spread);
  CHECK(std::count_if(dependent_nodes.begin(), dependent_nodes.end(), [](const auto& f) { return f.spins(); }) > 2);
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

TEST_CASE("bodies keep their rigid motions, and followers are held but for their own rotations") {
  const std::vector<mesh::DependentNode> dependent_nodes = GENERATE(testing::mixed_lines(true), testing::mixed_loose());
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled, Spread::last);
  const fem::Structure s = testing::structure_with(PETSC_COMM_WORLD, spread, dependent_nodes),
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
  for (const mesh::DependentNode& f : dependent_nodes)
    constrained += 6 - static_cast<std::size_t>(own_rotations(f).squaredNorm() + 0.5);
  CHECK(holding.constrained.size() == constrained);
}

TEST_CASE("own rotations are orthonormal, each by a dof") {
  const Eigen::Vector3d e = Eigen::Vector3d(0.2, -0.9, 0.4).normalized();
  for (const Eigen::Vector3d& axis : {e, Eigen::Vector3d(-e), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0)})
    for (const bool others : {false, true}) {
      const Eigen::Matrix3d S = fem::Mesh::Spin{0, axis, others}.own(), P = axis * axis.transpose(),
                            expected = others ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() - P) : P;
      CHECK((S * S.transpose() - expected).norm() < 1e-14);
      const Eigen::Matrix3d gram = S.transpose() * S;
      CHECK((gram - Eigen::Matrix3d(gram.diagonal().asDiagonal())).norm() < 1e-14);
      CHECK(S.col(fem::spin_slot(axis)).isZero(0) == others);
    }
}

TEST_CASE("own rotations in a flat body: the products of many columns are those of K") {
  const Spread spread = GENERATE(Spread::metis, Spread::shuffled);
  const bool oblique = GENERATE(false, true);
  const generate::Plate plate{{0, 0, 0}, {0.8, 0, 0.6}, {0, 1, 0}, 3, 2};
  const mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
  std::vector<mesh::DependentNode> links{{1, 0, {}, true},
                                         {4, 0, {0.8, 0, 0.6}},
                                         {5, 0, {-0.6, 0, 0.8}},
                                         {6, 0, {0.8, 0, 0.6}, true},
                                         {8, 0, {-0.6, 0, 0.8}, true}};
  if (oblique) links.push_back({9, 0, {1, 0, 0}});
  const fem::Structure s(fem::mesh_of(raw, testing::ranks_of(raw, spread), links),
                         {fem::shell_section({{fem::isotropic(500, 0.3, 4), 0.1, 0}})}, fem::MembraneStrain::averaged);
  CHECK((fem::flat_body(s) == nullptr) == oblique);
  testing::Random random(3);
  const Eigen::VectorXd q = random.vector(s.dofs());
  const petsc::VecHandle by_pieces = fem::field(s);
  fem::ElementStiffness(s).multiply(testing::field_of_originals(s, q), by_pieces);
  const Eigen::VectorXd expected = testing::product_in_originals(s, fem::stiffness(s, {}), q);
  CHECK((testing::in_original_order(s, by_pieces) - expected).norm() < 1e-11 * expected.norm());
}
