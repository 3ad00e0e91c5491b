#include "floe/math/symmetric_forms.h"

#include <catch2/catch.hpp>

#include "random.h"

using namespace floe;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Three forms of rotations whose rows on the coordinates are given.
std::vector<MatrixXd> forms_of(testing::Random& random, const MatrixXd& rotations) {
  std::vector<MatrixXd> forms;
  for (int a = 0; a < 3; ++a) {
    const MatrixXd own = random.matrix(static_cast<int>(rotations.rows()), static_cast<int>(rotations.rows()));
    forms.emplace_back(rotations.transpose() * (own + own.transpose()) * rotations);
  }
  return forms;
}

}  // namespace

TEST_CASE("symmetric forms of low rank are multiplied by factors, with the same products") {
  testing::Random random(91);
  const auto [k, given, rank] = GENERATE(std::tuple(40, 1, 1), std::tuple(40, 3, 3), std::tuple(40, 7, 7),
                                         std::tuple(40, 9, 0), std::tuple(100, 16, 16), std::tuple(100, 17, 0));
  const std::vector<MatrixXd> forms = forms_of(random, random.matrix(given, k));
  math::SymmetricForms factored(forms);
  factored.factor();
  CHECK(factored.rank() == rank);  // r <= 16 and 16 r <= 3 k
  const VectorXd x = random.vector(k);
  Matrix3Xd plain, product;
  math::SymmetricForms(forms).multiply(x, plain);
  factored.multiply(x, product);
  CHECK((product - plain).norm() < 1e-13 * plain.norm());
  for (int a = 0; a < 3; ++a) CHECK((product.row(a).transpose() - forms[a] * x).norm() < 1e-13 * plain.norm());
}

TEST_CASE("symmetric forms that vanish, of full rank, or of no coordinates have no factors") {
  testing::Random random(92);
  const int k = GENERATE(0, 1, 5);
  math::SymmetricForms forms(forms_of(random, MatrixXd::Identity(k, k))),
      zero(std::vector<MatrixXd>(3, MatrixXd::Zero(k, k)));
  for (math::SymmetricForms* one : {&forms, &zero}) {
    one->factor();
    CHECK(one->rank() == 0);
    Matrix3Xd product;
    one->multiply(VectorXd::Ones(k), product);
    REQUIRE(product.cols() == k);
    for (int a = 0; a < 3; ++a)
      CHECK((product.row(a).transpose() - (*one)[a] * VectorXd::Ones(k)).norm() <= 1e-14 * product.norm());
  }
  math::SymmetricForms none;
  none.factor();
  CHECK(none.empty());
}
