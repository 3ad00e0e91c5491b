#include "corotational_beam_chord.h"

#include <cmath>
#include <numbers>
#include <tuple>

namespace floe::reference::corotational {
namespace {

/// What a vector over q does to r2 - r1.
Eigen::Vector2d stretch(const Six& x) { return x.segment<2>(3) - x.head<2>(); }

/// The covector over q that acts on r2 - r1 as c.
Six on_nodes(const Eigen::Vector2d& c) { return {-c[0], -c[1], 0, c[0], c[1], 0}; }

/// A P
template <int rows>
Eigen::Matrix<double, rows, 6> times_P(double length, const Eigen::Matrix<double, rows, 7>& A) {
  Eigen::Matrix<double, rows, 6> AP;
  const Eigen::Matrix<double, rows, 1> rotating = (A.col(6) - A.col(4) - A.col(5)) / length;  // A p g, g = n'/l
  AP << A.col(0), A.col(1) - rotating, A.col(4), A.col(2), A.col(3) + rotating, A.col(5);
  return AP;
}

// beta = Im log(r2 - r1): its derivatives at r2 - r1 = l are Im (d/l), -Im (d/l)^2, 2 Im (d/l)^3 for a step d = (de,
// dn).
Eigen::Vector2d second(double length, const Eigen::Vector2d& d) {
  return -Eigen::Vector2d(d[1], d[0]) / (length * length);
}
Eigen::Vector2d third(double length, const Eigen::Vector2d& d) {
  return 2 * Eigen::Vector2d(2 * d[0] * d[1], d[0] * d[0] - d[1] * d[1]) / (length * length * length);
}

}  // namespace

Chord chord_at(const Eigen::Vector2d& undeformed, const Six& q) {
  const Eigen::Vector2d s = stretch(q), d = undeformed + s;
  const double length = d.norm(), mean = (q[2] + q[5]) / 2;
  // of the displacements alone: beside the undeformed chord, small ones would come in stairs of its round-off
  const double elongation = s.dot(undeformed + d) / (length + undeformed.norm());
  const Eigen::Vector2d e = d / length, n(-e[1], e[0]);
  const double rotation = std::atan2(undeformed[0] * s[1] - undeformed[1] * s[0], undeformed.dot(d));
  constexpr double whole = 2 * std::numbers::pi;
  const double beta = rotation + whole * std::round((mean - rotation) / whole);
  return {length, elongation, e, n, {q[2] - beta, q[5] - beta}};
}

Six on_chord(const Chord& chord, const Six& x) {
  const auto one = x.head<2>(), two = x.segment<2>(3);
  return {chord.e.dot(one), chord.n.dot(one), x[2], chord.e.dot(two), chord.n.dot(two), x[5]};
}

Six on_world(const Chord& chord, const Six& x) {
  Six world;
  world << chord.e * x[0] + chord.n * x[1], x[2], chord.e * x[3] + chord.n * x[4], x[5];
  return world;
}

SixSquare on_world(const Chord& chord, const SixSquare& matrix) {
  SixSquare rows, world;
  for (int i = 0; i < 6; ++i) rows.col(i) = on_world(chord, Six(matrix.col(i)));
  for (int i = 0; i < 6; ++i) world.row(i) = on_world(chord, Six(rows.row(i))).transpose();
  return world;
}

Rates extended_rates(const Chord& chord, const Six& v, const Six& a) {
  const auto extended = [&](const Six& x) {
    const double rotating = stretch(x)[1] / chord.length;
    return Seven{x[0], x[1], x[3], x[4], x[2] - rotating, x[5] - rotating, rotating};
  };
  Rates rates{extended(v), extended(a)};
  const double drift = stretch(v).dot(second(chord.length, stretch(v)));
  rates.acceleration[4] -= drift;
  rates.acceleration[5] -= drift;
  rates.acceleration[6] += drift;
  return rates;
}

Six reduced(const Chord& chord, const Seven& f) { return times_P<1>(chord.length, f.transpose()).transpose(); }

SixSquare reduced(const Chord& chord, const Six& v, const Six& a, const Seven& f, const SevenSquare& K,
                  const SevenSquare& C, const SevenSquare& M, const Eigen::Vector3d& weights) {
  const double w_q = weights[0], w_v = weights[1], w_a = weights[2], l = chord.length;
  const auto times_p = [](const SevenSquare& A) -> Seven { return A.col(6) - A.col(4) - A.col(5); };
  const Seven Cp = times_p(C), Mp = times_p(M);
  const Six Hv = on_nodes(second(l, stretch(v)));
  const Six rest = on_nodes(second(l, stretch(a)) + third(l, stretch(v)));

  Eigen::Matrix<double, 7, 6> inner = times_P<7>(l, w_q * K + w_v * C + w_a * M);
  inner.noalias() += (w_q * Cp + 2 * w_v * Mp) * Hv.transpose() + w_q * Mp * rest.transpose();
  SixSquare J = times_P<6>(l, inner.transpose()).transpose();

  const double h = w_q * (f[6] - f[4] - f[5]) / (l * l);  // H has -1/l^2 at (e, n) and (n, e) of r2 - r1
  for (const auto& [i, j, sign] : {std::tuple(0, 1, -1), {0, 4, 1}, {3, 1, 1}, {3, 4, -1}}) {
    J(i, j) += sign * h;
    J(j, i) += sign * h;
  }
  return J;
}

}  // namespace floe::reference::corotational
