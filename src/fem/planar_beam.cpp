#include "floe/fem/planar_beam.h"

#include <array>
#include <cmath>

namespace floe::fem {
namespace {

struct GaussPoint {
  double at, weight;  // on [0, 1]
};

/// Exact to degree 5, 7 and 9 (three, four and five points). Source: Abramowitz & Stegun, table 25.4.
std::array<GaussPoint, 3> gauss3() {
  const double a = std::sqrt(0.6) / 2;
  return {{{0.5 - a, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + a, 5.0 / 18}}};
}
std::array<GaussPoint, 4> gauss4() {
  const double r = std::sqrt(1.2);
  const double a = std::sqrt((3 - 2 * r) / 7) / 2, b = std::sqrt((3 + 2 * r) / 7) / 2;
  const double wa = (18 + std::sqrt(30.0)) / 72, wb = (18 - std::sqrt(30.0)) / 72;
  return {{{0.5 - b, wb}, {0.5 - a, wa}, {0.5 + a, wa}, {0.5 + b, wb}}};
}

std::array<GaussPoint, 5> gauss5() {
  const double r = 2 * std::sqrt(10.0 / 7);
  const double a = std::sqrt(5 - r) / 6, b = std::sqrt(5 + r) / 6;
  const double wa = (322 + 13 * std::sqrt(70.0)) / 1800, wb = (322 - 13 * std::sqrt(70.0)) / 1800;
  return {{{0.5 - b, wb}, {0.5 - a, wa}, {0.5, 64.0 / 225}, {0.5 + a, wa}, {0.5 + b, wb}}};
}

using Row6 = Eigen::Matrix<double, 1, 6>;

/// Hermite cubics of v and their derivatives with respect to x at s = x / l, on (u1, v1, r1, u2, v2, r2).
Row6 deflection(double s, double l) {
  return (Row6() << 0, 1 - 3 * s * s + 2 * s * s * s, l * s * (1 - s) * (1 - s), 0, 3 * s * s - 2 * s * s * s,
          l * s * s * (s - 1))
      .finished();
}
Row6 slope(double s, double l) {
  return (Row6() << 0, 6 * s * (s - 1) / l, 1 - 4 * s + 3 * s * s, 0, 6 * s * (1 - s) / l, s * (3 * s - 2)).finished();
}
/// What shear adds to them, on gamma.
double sway(double s, double l) { return l * s * (1 - s) * (1 - 2 * s); }
double sway_slope(double s) { return 1 - 6 * s + 6 * s * s; }
Row6 antisymmetric(double l) { return (Row6() << 0, -1, -l / 2, 0, 1, -l / 2).finished(); }

Row6 stretch(double s) { return (Row6() << 1 - s, 0, 0, s, 0, 0).finished(); }

struct Axes {
  double length;
  Eigen::Matrix2d rotation;              // element axes in body axes
  Eigen::Matrix<double, 6, 6> to_local;  // dofs
  Row6 shear = Row6::Zero();             // gamma on local dofs
};

Row6 slope(double s, const Axes& axes) { return slope(s, axes.length) + sway_slope(s) * axes.shear; }

/// 12 EI / (GA l^2).
double softness(const BeamSection& section, double l) { return 12 * section.EI / (section.GA * l * l); }

Axes axes_of(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const BeamSection& section) {
  Axes axes;
  const Eigen::Vector2d d = to - from;
  axes.length = d.norm();
  const Eigen::Vector2d e = d / axes.length;
  axes.rotation << e.x(), -e.y(), e.y(), e.x();
  axes.to_local.setZero();
  for (int node = 0; node < 2; ++node) {
    axes.to_local.block<2, 2>(3 * node, 3 * node) = axes.rotation.transpose();
    axes.to_local(3 * node + 2, 3 * node + 2) = 1;
  }
  const double phi = softness(section, axes.length);
  if (phi > 0) axes.shear = phi / (1 + phi) / axes.length * antisymmetric(axes.length);
  return axes;
}

/// Of an even bending, and of an odd one, against which shear gives way.
Eigen::Matrix<double, 6, 6> bending_stiffness(const BeamSection& section, double l) {
  const double odd = 1 / (1 + softness(section, l));
  Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero();
  const int v[4] = {1, 2, 4, 5};
  const double c = 12 * odd, d = 6 * odd * l, near = (3 * odd + 1) * l * l, far = (3 * odd - 1) * l * l;
  const double k[4][4] = {{c, d, -c, d}, {d, near, -d, far}, {-c, -d, c, -d}, {d, far, -d, near}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) K(v[i], v[j]) = section.EI / (l * l * l) * k[i][j];
  return K;
}

body::MassPoint sample(double mass, double s, double y, const Eigen::Vector2d& from, const Axes& axes) {
  const double l = axes.length;
  Eigen::Matrix<double, 2, 6> N;
  N << stretch(s) - y * (slope(s, axes) - axes.shear), deflection(s, l) + sway(s, l) * axes.shear;
  return {mass, from + axes.rotation * Eigen::Vector2d(s * l, y), axes.rotation * N * axes.to_local};
}

}  // namespace

ElementMaps planar_beam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const BeamSection& section,
                        MembraneStrain strain) {
  const Axes axes = axes_of(from, to, section);
  const double l = axes.length;
  ElementMaps maps;
  maps.bending = axes.to_local.transpose() * bending_stiffness(section, l) * axes.to_local;

  const Row6 linear = (Row6() << -1 / l, 0, 0, 1 / l, 0, 0).finished();
  const Eigen::MatrixXd L = linear * axes.to_local, D = Eigen::MatrixXd::Constant(1, 1, section.EA);
  if (strain == MembraneStrain::averaged) {
    StrainPoint whole{l, D, L, Eigen::MatrixXd(3, 6), {Eigen::MatrixXd::Zero(3, 3)}};
    int row = 0;
    for (const GaussPoint& g : gauss3()) {
      whole.G.row(row) = slope(g.at, axes) * axes.to_local;
      whole.P[0](row, row) = g.weight;
      ++row;
    }
    maps.membrane.push_back(std::move(whole));
  } else {
    for (const GaussPoint& g : gauss5())  // v'^4 has degree 8
      maps.membrane.push_back({g.weight * l, D, L, slope(g.at, axes) * axes.to_local, {Eigen::MatrixXd::Ones(1, 1)}});
  }

  if (section.rhoI > 0)
    for (const GaussPoint& g : gauss4()) {
      const double moment = section.rhoI * g.weight * l;
      Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
      second.topLeftCorner<2, 2>() = moment * axes.rotation.col(1) * axes.rotation.col(1).transpose();
      maps.rotary.emplace_back(body::RotatingForms(second), Eigen::MatrixXd::Zero(3, 6));
      maps.rotary.back().rotation.row(2) = (slope(g.at, axes) - axes.shear) * axes.to_local;
    }
  const double radius = section.rhoA > 0 ? std::sqrt(section.rhoI / section.rhoA) : 0;
  for (const GaussPoint& g : gauss4()) {
    const double mass = section.rhoA * g.weight * l;
    if (radius > 0) {
      maps.mass.push_back(sample(mass / 2, g.at, radius, from, axes));
      maps.mass.push_back(sample(mass / 2, g.at, -radius, from, axes));
    } else {
      maps.mass.push_back(sample(mass, g.at, 0, from, axes));
    }
  }
  return maps;
}

std::vector<body::MassPoint> planar_beam_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                              const BeamSection& section) {
  const Axes axes = axes_of(from, to, section);
  std::vector<body::MassPoint> line;
  for (const GaussPoint& g : gauss4()) line.push_back(sample(g.weight * axes.length, g.at, 0, from, axes));
  return line;
}

}  // namespace floe::fem
