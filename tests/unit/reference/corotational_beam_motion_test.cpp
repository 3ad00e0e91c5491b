#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "corotational_chain.h"
#include "dense_generalized_alpha.h"

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

struct Sample {
  Vector2d tip;  ///< displacement
  double energy;
};

/// Motion from rest under a load on the unknowns, sampled `count` times every `interval`.
std::vector<Sample> run(const CorotationalChain& chain, const std::function<void(double, VectorXd&)>& load, double step,
                        double interval, int count) {
  const auto residual = [&](double t, const VectorXd& q, const VectorXd& v, const VectorXd& a) {
    VectorXd force = chain.zero();
    load(t, force);
    return VectorXd(chain.residual(q, v, a) - force);
  };
  const auto tangent = [&](const VectorXd& q, const VectorXd& v, const VectorXd& a, const Vector3d& w) {
    return chain.tangent(q, v, a, {w[0], w[1], w[2]});
  };
  DenseGeneralizedAlpha motion(chain.size(), step, 0.8, residual, tangent);
  std::vector<Sample> samples;
  const long every = std::lround(interval / step);
  for (int i = 0; i < count; ++i) {
    for (long k = 0; k < every; ++k) motion.step();
    samples.push_back({motion.q.tail<3>().head<2>(), chain.energy(motion.q, motion.v)});
  }
  return samples;
}

void check_tip(const Vector2d& tip, const Vector2d& expected, double margin) {
  CHECK(tip[0] == Approx(expected[0]).margin(margin));
  CHECK(tip[1] == Approx(expected[1]).margin(margin));
}

/// The paper's cantilever to t = 1.5.
std::vector<Sample> paper_cantilever(int elements, double step, double rhoI, double interval) {
  const CorotationalChain chain(elements, 100, {1.12e6, 9.36e6, .546, rhoI});
  const auto load = [](double t, VectorXd& force) { force[force.size() - 2] = 2500 * std::sin(9.5 * t); };
  return run(chain, load, step, interval, static_cast<int>(std::lround(1.5 / interval)));
}

/// Distance of two histories of the tip.
double distance(const std::vector<Sample>& one, const std::vector<Sample>& two) {
  double sum = 0;
  for (size_t i = 0; i < one.size(); ++i) sum += (one[i].tip - two[i].tip).squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

// Expected tips: a geometrically exact beam, computed independently of this element, own error below 0.005.
TEST_CASE("corotational beams: the paper's cantilever", "[corotational]") {
  const auto rotary = paper_cantilever(20, 1e-3, 4.563, 0.5);
  check_tip(rotary[0].tip, {-.5488, 10.1357}, 0.005);
  check_tip(rotary[1].tip, {-5.9187, 20.0187}, 0.005);
  check_tip(rotary[2].tip, {-1.6595, 3.7311}, 0.005);

  const auto plain = paper_cantilever(20, 1e-3, 0, 0.5);
  check_tip(plain[0].tip, {-.5111, 9.9503}, 0.005);
  check_tip(plain[1].tip, {-6.0616, 19.9918}, 0.005);
  check_tip(plain[2].tip, {-1.4359, 3.7054}, 0.005);
}

TEST_CASE("corotational beams: the paper's cantilever converges at order 2 in mesh and in step", "[corotational]") {
  const auto order = [](const auto& coarse, const auto& middle, const auto& fine) {
    return std::log2(distance(coarse, middle) / distance(middle, fine));
  };
  const auto history = [](int elements, double step) { return paper_cantilever(elements, step, 4.563, 0.1); };
  CHECK(order(history(10, 5e-3), history(20, 5e-3), history(40, 5e-3)) == Approx(2).margin(0.2));
  CHECK(order(history(10, 5e-3), history(10, 2.5e-3), history(10, 1.25e-3)) == Approx(2).margin(0.1));
}

TEST_CASE("corotational beams: moment-driven arm", "[corotational]") {
  const CorotationalChain arm(10, 10, {4.8e4, 1e3, 1, 1. / 48}, 2);
  const auto triangle = [](double t, VectorXd& force) { force[0] = 80 * std::max(0., 1 - std::abs(t / 2.5 - 1)); };
  const auto samples = run(arm, triangle, 2.5e-3, 2.5, 4);
  check_tip(samples[0].tip + Vector2d(10, 0), {9.7245, 2.1598}, 0.001);
  check_tip(samples[1].tip + Vector2d(10, 0), {.6959, 9.9782}, 0.003);
  CHECK(samples[3].energy == Approx(samples[1].energy).epsilon(1e-3));  // no load after t = 5
}

TEST_CASE("corotational beams: flexible pendulum released from the horizontal", "[corotational]") {
  const CorotationalChain pendulum(16, 1, {1.2e4, 1, 1, 0}, 2, {0, -9.81});
  const auto samples = run(
      pendulum, [](double, VectorXd&) {}, 1e-3, 0.25, 4);
  check_tip(samples[0].tip + Vector2d(1, 0), {.90953, -.40740}, 2e-3);
  check_tip(samples[1].tip + Vector2d(1, 0), {-.05782, -.99742}, 2e-3);
  check_tip(samples[3].tip + Vector2d(1, 0), {-.98765, .05193}, 2e-3);
  for (const auto& sample : samples) CHECK(std::abs(sample.energy) < 1e-3 * 9.81 / 2);  // of the fall through L/2
}
