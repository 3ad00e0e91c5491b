// Edges of plates that move in their plane and remain straight (movable straight edges).
#include <catch2/catch.hpp>

#include "building.h"
#include "spatial_scenes.h"

using namespace floe;
using namespace floe::test;

namespace {

constexpr double pi = 3.14159265358979323846, nu = 0.3, thickness = 0.01;
const double E = 12 * (1 - nu * nu) / std::pow(thickness, 3);  // D = 1

/// A simply supported square plate of side 1 and unit mass per area under the pressure p; its edges x = 1 and y = 1 are
/// straight or free in the plane, the others immovable normally.
std::string plate(int elements, bool straight, double p, const std::string& keys = "") {
  return fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [$n, $n], cells: quadrilaterals}}
    section: {thickness: $h}
    material: {E: $E, nu: 0.3, rho: $rho}
    strains: von_karman
$keys
joints:
  a: {type: support, between: [ground, plate.left], hold: [x, z]}
  b: {type: support, between: [ground, plate.bottom], hold: [y, z]}
  c: {type: support, between: [ground, plate.right], hold: [z]$x}
  d: {type: support, between: [ground, plate.top], hold: [z]$y}
loads: {p: {type: pressure, body: plate, pressure: $p, follower: false}}
motion: {end: 1, step: 1}
probes:
  c: {at: {body: plate, node: [0.5, 0.5, 0]}}
  corner: {at: {body: plate, node: [1, 0, 0]}}
  middle: {at: {body: plate, node: [1, 0.5, 0]}}
)yaml",
              {{"n", std::to_string(elements)},
               {"h", number(thickness)},
               {"E", number(E)},
               {"rho", number(1 / thickness)},
               {"keys", keys},
               {"x", straight ? ", straight: [x]" : ""},
               {"y", straight ? ", straight: [y]" : ""},
               {"p", number(p)}});
}

/// Levy's double series (NACA Report 737, 1942) for edges that are straight, free of shear and of mean normal force: w
/// = sum W_k sin(m pi x) sin(n pi y), Airy's function of the cosine series of the Gaussian curvature,
///
///   c_pq of w,xy^2 - w,xx w,yy,   F_pq = E h c_pq / (pi^4 s^2),   U = 1/8 D pi^4 sum (m^2 + n^2)^2 W^2
///                                                                   + 1/2 E h sum n_pq c_pq^2 / (pi^4 s^2),   s = p^2
///                                                                   + q^2.
class Levy {
 public:
  /// Odd m, n below 2 `terms`; D = 1.
  explicit Levy(int terms) : E_h_(12 * (1 - nu * nu) / std::pow(thickness, 2)) {
    for (int m = 1; m < 2 * terms; m += 2)
      for (int n = 1; n < 2 * terms; n += 2) modes_.push_back({m, n});
    const int points = 8 * terms, most = 4 * terms;
    for (int p = 0; p <= most; p += 2)
      for (int q = 0; q <= most; q += 2)
        if (p + q > 0)
          curvatures_.push_back({(p ? 0.5 : 1) * (q ? 0.5 : 1), double(p * p + q * q), bilinear(p, q, points)});
  }

  /// Deflection of the centre under the pressure p.
  double centre(double pressure) const {
    const Eigen::Index N = static_cast<Eigen::Index>(modes_.size());
    Eigen::VectorXd W = Eigen::VectorXd::Zero(N), K(N), load(N), shape(N);
    for (Eigen::Index k = 0; k < N; ++k) {
      const auto [m, n] = modes_[k];
      K[k] = std::pow(pi, 4) * std::pow(m * m + n * n, 2) / 4;
      load[k] = 4 / (pi * pi * m * n);
      shape[k] = std::sin(m * pi / 2) * std::sin(n * pi / 2);
    }
    for (int step = 1; step <= 10; ++step)
      for (int iteration = 0; iteration < 50; ++iteration) {
        Eigen::VectorXd r = K.cwiseProduct(W) - step / 10. * pressure * load;
        Eigen::MatrixXd J = K.asDiagonal();
        for (const Curvature& c : curvatures_) {
          const double k = E_h_ * c.norm / (std::pow(pi, 4) * c.s * c.s);
          const Eigen::VectorXd gradient = 2 * c.B * W;
          const double value = W.dot(c.B * W);
          r += k * value * gradient;
          J += k * (gradient * gradient.transpose() + 2 * value * c.B);
        }
        W -= J.ldlt().solve(r);
        if (r.norm() < 1e-12 * pressure) break;
      }
    return shape.dot(W);
  }

 private:
  struct Curvature {
    double norm, s;
    Eigen::MatrixXd B;  // c = W' B W
  };

  /// By the midpoint rule, exact for these trigonometric polynomials.
  Eigen::MatrixXd bilinear(int p, int q, int points) const {
    const Eigen::Index N = static_cast<Eigen::Index>(modes_.size());
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(N, N);
    for (int i = 0; i < points; ++i)
      for (int j = 0; j < points; ++j) {
        const double x = (i + 0.5) / points * pi, y = (j + 0.5) / points * pi;
        Eigen::VectorXd xy(N), xx(N), yy(N);
        for (Eigen::Index k = 0; k < N; ++k) {
          const auto [m, n] = modes_[k];
          xy[k] = m * n * std::cos(m * x) * std::cos(n * y);
          xx[k] = -m * m * std::sin(m * x) * std::sin(n * y), yy[k] = -n * n * std::sin(m * x) * std::sin(n * y);
        }
        const double weight = std::pow(pi, 4) * (p ? 2 : 1) * (q ? 2 : 1) * std::cos(p * x) * std::cos(q * y);
        B += weight / (points * points) * (xy * xy.transpose() - (xx * yy.transpose() + yy * xx.transpose()) / 2);
      }
    return B;
  }

  double E_h_;
  std::vector<std::array<int, 2>> modes_;
  std::vector<Curvature> curvatures_;
};

/// Levy's pressures are p a^4 / (E h^4).
double pressure(double levy) { return levy * E * std::pow(thickness, 4); }

}  // namespace

// One term of the series: k_3/k_1 = 3/8 (1 - nu^2) of W/h, from which W + k_3 W^3 = 4 p / (pi^2 K).
TEST_CASE("movable straight edges: the series in its limits, and its convergence") {
  const double p = pressure(50), W = Levy(1).centre(p), K = std::pow(pi, 4);
  CHECK(W + 3. / 8 * (1 - nu * nu) * std::pow(W, 3) / std::pow(thickness, 2) == Approx(4 / (pi * pi) * p / K));
  CHECK(Levy(3).centre(p) == Approx(Levy(4).centre(p)).epsilon(2e-3));
  CHECK(Levy(4).centre(1e-6) / 1e-6 == Approx(0.00406235).epsilon(1e-3));  // Navier
}

TEST_CASE("movable straight edges: large deflection of a simply supported square plate, full-order and reduced") {
  const Levy levy(4);
  for (const double load : {12.1, 56.9, 161.}) {
    INFO(load);
    const double p = pressure(load), expected = levy.centre(p);
    const History coarse = rest(plate(8, true, p), Formulation::nlffr),
                  fine = rest(plate(16, true, p), Formulation::nlffr);
    CHECK((4 * fine["c.z"].back() - coarse["c.z"].back()) / 3 == Approx(expected).epsilon(1e-2));
    CHECK(fine["c.z"].back() == Approx(expected).epsilon(2e-2));
    CHECK(fine["corner.x"].back() < 0);
    CHECK(fine["corner.x"].back() == Approx(fine["middle.x"].back()).epsilon(1e-3));
    // edges that are free in the plane: the corners pull in less
    const History free = rest(plate(16, false, p), Formulation::nlffr);
    CHECK(free["c.z"].back() > fine["c.z"].back());
    CHECK(std::abs(free["corner.x"].back() / free["middle.x"].back() - 1) > 0.1);
    const History reduced = rest(plate(16, true, p, "    reduction: {modes: 6}"), Formulation::vm_md);
    CHECK(reduced["c.z"].back() == Approx(fine["c.z"].back()).epsilon(2e-2));
    CHECK(reduced["corner.x"].back() == Approx(reduced["middle.x"].back()).epsilon(1e-3));
  }
}

TEST_CASE("movable straight edges: refused along the edge and at single nodes") {
  const auto refused = [](const std::string& place, const std::string& straight) {
    return testing::complaint(fill(R"yaml(
bodies:
  plate:
    mesh: {plate: {along: [1, 0, 0], across: [0, 1, 0], elements: [2, 2]}}
    section: {thickness: 0.01}
    material: {E: 1e9, nu: 0.3, rho: 1000}
joints:
  a: {type: fixed, between: [ground, plate.left]}
  c: {type: support, between: [ground, $place], straight: [$straight]}
)yaml",
                                   {{"place", place}, {"straight", straight}}),
                              Formulation::nlffr);
  };
  CHECK(refused("plate.right", "x") == "");
  CHECK_THAT(refused("plate.right", "y"), Catch::Contains("joints.c.straight: direction y is not normal to the edge"));
  CHECK_THAT(refused("plate.right", "x, z"), Catch::Contains("joints.c.straight: direction z is normal to the shell; "
                                                             "expected one in its plane (hold: [z] keeps the edge"));
  CHECK_THAT(refused("{body: plate, node: [1, 1, 0]}", "x"),
             Catch::Contains("joints.c.straight: its place is no edge of three nodes or more"));
}
