#include <catch2/catch.hpp>
#include <cmath>

#include "corotational_chain.h"
#include "eigenvalues.h"

using Eigen::ArrayXd;
using Eigen::VectorXd;

namespace {

/// Angular frequencies about rest, ascending.
ArrayXd frequencies(const CorotationalChain& chain) {
  const VectorXd zero = chain.zero();
  const Eigen::VectorXd lambda = floe::testing::eigenvalues(chain.tangent(zero, zero, zero, {1, 0, 0}),
                                                            chain.tangent(zero, zero, zero, {0, 0, 1}));
  return lambda.array().sqrt();
}

}  // namespace

TEST_CASE("corotational cantilever: bending frequencies of the linear beam at order 4", "[corotational]") {
  const double exact[] = {3.5160152685, 22.034491565, 61.697214414};  // beta^2, EI = rhoA = L = 1
  const auto error = [&](int elements, int i) {
    return frequencies(CorotationalChain(elements, 1, {1e8, 1, 1, 0}))[i] / exact[i] - 1;
  };
  for (int i = 0; i < 3; ++i) {
    CHECK(std::log2(error(8, i) / error(16, i)) == Approx(4).margin(0.1));
    CHECK(error(32, i) < 1e-5);
  }
}

TEST_CASE("corotational cantilever: axial frequencies at order 2", "[corotational]") {
  const auto error = [](int elements) {  // first axial mode pi/2, below all bending for EA << EI
    return frequencies(CorotationalChain(elements, 1, {1, 1e4, 1, 0}))[0] / 1.5707963267948966 - 1;
  };
  CHECK(std::log2(error(8) / error(16)) == Approx(2).margin(0.05));
  CHECK(error(32) < 2e-4);
}

TEST_CASE("corotational cantilever: frequencies of the paper's beam, with and without rotary inertia",
          "[corotational]") {
  // L = 100, A = 70, I = 585, E = 16000, rho = 0.0078; the third bending frequency stands after the first axial one
  const CorotationalChain rotary(32, 100, {1.12e6, 9.36e6, .546, 4.563}), plain(32, 100, {1.12e6, 9.36e6, .546, 0});
  const ArrayXd with = frequencies(rotary), without = frequencies(plain);
  CHECK(with[0] == Approx(1.45295).margin(1e-5));
  CHECK(with[1] == Approx(9.00192).margin(2e-5));
  CHECK(with[3] == Approx(24.758).margin(6e-4));
  CHECK(with[4] == Approx(47.31).margin(6e-3));
  CHECK(without[0] == Approx(1.4558).margin(6e-5));
  CHECK(without[1] == Approx(9.1232).margin(6e-5));
  CHECK(without[3] == Approx(25.55).margin(6e-3));
}
