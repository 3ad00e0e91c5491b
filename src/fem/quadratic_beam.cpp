#include "floe/fem/quadratic_beam.h"

#include <algorithm>
#include <cmath>

#include "floe/error.h"
#include "floe/math/rotation.h"
#include "spatial_beam_fields.h"

namespace floe::fem {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr Index beam_nodes = 3, beam_dofs = 18;
using Row18 = Eigen::Matrix<double, 1, beam_dofs>;
using Matrix24 = Eigen::Matrix<double, 24, 24>;

/// The line at a station r in [-1, 1], its nodes at -1, 1, 0.
struct Station {
  Vector3d N, dN;  // of the nodes; d/ds
  double stretch;  // ds/dr
  Vector3d at, tangent;
  std::array<Vector3d, 2> D, dD;  // section axes y, z and their d/ds
};

struct Curve {
  std::array<Vector3d, 3> node;
  std::array<Matrix3d, 3> axes;  // of the sections at the nodes: tangent, y, z

  explicit Curve(const BeamCurve& of) : node{of.from, of.to, of.middle} {
    for (int i = 0; i < 3; ++i) {
      const double r = i == 0 ? -1 : i == 1 ? 1 : 0;
      const Vector3d t = rate(r), chord = of.to - of.from;
      if (!(t.dot(chord) > 0)) throw InputError("a beam element of second order has no length or is folded");
      axes[static_cast<std::size_t>(i)] = element_axes({of.from, of.from + t, of.orientation});
    }
  }
  static Vector3d shape(double r) { return {r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r}; }
  static Vector3d shape_rate(double r) { return {r - 0.5, r + 0.5, -2 * r}; }
  Vector3d rate(double r) const {
    const Vector3d d = shape_rate(r);
    return d[0] * node[0] + d[1] * node[1] + d[2] * node[2];
  }
  Station station(double r) const {
    Station at;
    at.N = shape(r), at.dN = shape_rate(r);
    const Vector3d along = rate(r);
    at.stretch = along.norm();
    at.dN /= at.stretch;
    at.tangent = along / at.stretch;
    at.at.setZero();
    for (int a : {0, 1}) at.D[a].setZero(), at.dD[a].setZero();
    for (int i = 0; i < 3; ++i) {
      at.at += at.N[i] * node[i];
      for (int a : {0, 1}) at.D[a] += at.N[i] * axes[i].col(1 + a), at.dD[a] += at.dN[i] * axes[i].col(1 + a);
    }
    return at;
  }
  /// row += t.(sum f_i u_i), t.(sum f_i theta_i x D_a,i)
  void add_displacement(Eigen::Ref<Row18> row, const Vector3d& t, const Vector3d& f) const {
    for (Index i = 0; i < beam_nodes; ++i) row.segment<3>(6 * i) += f[i] * t.transpose();
  }
  void add_director(Eigen::Ref<Row18> row, int a, const Vector3d& t, const Vector3d& f) const {
    for (Index i = 0; i < beam_nodes; ++i)
      row.segment<3>(6 * i + 3) += f[i] * Vector3d(axes[i].col(1 + a)).cross(t).transpose();
  }
};

enum Strain { eps, b_y, b_z, tau, gamma_y, gamma_z, strain_count };
/// Rows of G: u', d_y, d_z, d_y', d_z' and the rotation vectors of the nodes.
enum Row { of_u = 0, of_d = 3, of_d_rate = 9, of_theta = 15, row_count = 24 };

struct BeamStrains {
  Eigen::Matrix<double, strain_count, beam_dofs, Eigen::RowMajor> L;
  std::array<Matrix24, strain_count> P;
};

/// a.C b of three rows each.
void multiply_rows(Matrix24& P, Index a, Index b, const Matrix3d& C) {
  P.block<3, 3>(a, b) += C, P.block<3, 3>(b, a) += C.transpose();
}

BeamStrains strains_at(const Curve& curve, const Station& at) {
  BeamStrains s;
  s.L.setZero();
  for (Matrix24& P : s.P) P.setZero();
  const auto rotated = [&](Strain strain, int a, const Vector3d& t, const Vector3d& f) {  // t.(sum f_i d_a,i)
    curve.add_director(s.L.row(strain), a, t, f);
    for (Index i = 0; i < beam_nodes; ++i) {
      const Matrix3d product = t * curve.axes[i].col(1 + a).transpose();
      s.P[strain].block<3, 3>(of_theta + 3 * i, of_theta + 3 * i) +=
          f[i] * ((product + product.transpose()) / 2 - product.trace() * Matrix3d::Identity());
    }
  };
  const Matrix3d one = Matrix3d::Identity(), along = at.tangent * at.tangent.transpose();
  curve.add_displacement(s.L.row(eps), at.tangent, at.dN);
  s.P[eps].block<3, 3>(of_u, of_u).setIdentity();
  for (int a : {0, 1}) {
    const Strain b = a == 0 ? b_y : b_z, gamma = a == 0 ? gamma_y : gamma_z;
    rotated(b, a, at.tangent, at.dN);
    curve.add_displacement(s.L.row(b), at.dD[a], at.dN);
    multiply_rows(s.P[b], of_u, of_d_rate + 3 * a, one - along);
    rotated(gamma, a, at.tangent, at.N);
    curve.add_displacement(s.L.row(gamma), at.D[a], at.dN);
    multiply_rows(s.P[gamma], of_u, of_d + 3 * a, one - 2. / 3 * along);
  }
  rotated(tau, 0, at.D[1] / 2, at.dN), rotated(tau, 1, at.dD[0] / 2, at.N);
  rotated(tau, 1, -at.D[0] / 2, at.dN), rotated(tau, 0, -at.dD[1] / 2, at.N);
  multiply_rows(s.P[tau], of_d_rate, of_d + 3, one / 2), multiply_rows(s.P[tau], of_d_rate + 3, of_d, -one / 2);
  return s;
}

MatrixXd gradients(const Curve& curve, const Station& at) {
  MatrixXd G = MatrixXd::Zero(row_count, beam_dofs);
  for (Index i = 0; i < beam_nodes; ++i) {
    G.block<3, 3>(of_u, 6 * i) = at.dN[i] * Matrix3d::Identity();
    for (int a : {0, 1}) {
      const Matrix3d rotation = -math::skew(curve.axes[i].col(1 + a));
      G.block<3, 3>(of_d + 3 * a, 6 * i + 3) = at.N[i] * rotation;
      G.block<3, 3>(of_d_rate + 3 * a, 6 * i + 3) = at.dN[i] * rotation;
    }
    G.block<3, 3>(of_theta + 3 * i, 6 * i + 3).setIdentity();
  }
  return G;
}

/// Strains at the centroid and the shear centre from those on the line of the nodes.
MatrixXd to_centres(const SpatialBeamSection& section) {
  MatrixXd M = MatrixXd::Identity(strain_count, strain_count);
  M(eps, b_y) = section.centroid[0], M(eps, b_z) = section.centroid[1];
  M(gamma_y, tau) = -section.shear_centre[1], M(gamma_z, tau) = section.shear_centre[0];
  return M;
}

MatrixXd stiffness_of(const SpatialBeamSection& section, double length) {
  MatrixXd D = MatrixXd::Zero(strain_count, strain_count);
  D(eps, eps) = section.EA, D(tau, tau) = section.GJ;
  D(b_y, b_y) = section.EIz, D(b_z, b_z) = section.EIy, D(b_y, b_z) = D(b_z, b_y) = section.EIyz;
  const double bending = std::max({section.EIy, section.EIz, 1e-8 * section.EA * length * length});
  const double rigid = 12e4 * bending / (length * length);
  for (int a : {0, 1}) D(gamma_y + a, gamma_y + a) = std::isfinite(section.GA[a]) ? section.GA[a] : rigid;
  return D;
}

/// Strain eps_C alone, with squares of slopes.
StrainPoint von_karman_point(const Curve& curve, const Station& at, const SpatialBeamSection& section, double weight,
                             const MatrixXd& L, bool wagner) {
  MatrixXd G = MatrixXd::Zero(wagner ? 3 : 2, beam_dofs), P = MatrixXd::Identity(G.rows(), G.rows());
  Row18 slope_y = Row18::Zero(), slope_z = Row18::Zero();
  curve.add_displacement(slope_y, at.D[0], at.dN), curve.add_displacement(slope_z, at.D[1], at.dN);
  G.row(0) = slope_y - section.centroid[1] * L.row(tau), G.row(1) = slope_z + section.centroid[0] * L.row(tau);
  if (wagner) G.row(2) = L.row(tau), P(2, 2) = (section.EIy + section.EIz) / section.EA;
  return {weight, MatrixXd::Constant(1, 1, section.EA), L.row(eps), G, {P}};
}

StrainPoint second_order_point(const Curve& curve, const Station& at, const SpatialBeamSection& section, double weight,
                               const BeamStrains& s, const MatrixXd& M, const MatrixXd& L, const MatrixXd& D,
                               bool wagner) {
  StrainPoint point{weight, D, L, gradients(curve, at), {}};
  for (Index i = 0; i < strain_count; ++i) {
    MatrixXd P = MatrixXd::Zero(row_count, row_count);
    for (Index j = 0; j < strain_count; ++j) P += M(i, j) * s.P[static_cast<std::size_t>(j)];
    point.P.push_back(P);
  }
  if (!wagner) return point;
  point.G.conservativeResize(row_count + 1, Eigen::NoChange);
  point.G.row(row_count) = L.row(tau);
  for (MatrixXd& P : point.P) P.conservativeResizeLike(MatrixXd::Zero(row_count + 1, row_count + 1));
  point.P[eps](row_count, row_count) = (section.EIy + section.EIz) / section.EA;
  return point;
}

MatrixXd displacement(const Curve& curve, const Station& at, const Eigen::Vector2d& arm) {
  const MatrixXd G = gradients(curve, at);
  MatrixXd N = arm[0] * G.middleRows<3>(of_d) + arm[1] * G.middleRows<3>(of_d + 3);
  for (Index i = 0; i < beam_nodes; ++i) N.middleCols<3>(6 * i) += at.N[i] * Matrix3d::Identity();
  return N;
}

void add_mass(const Curve& curve, const SpatialBeamSection& section, ElementMaps& maps) {
  const std::vector<spatial::SectionPoint> points = spatial::section_points(section);
  for (const spatial::BeamStation& g : spatial::beam_gauss3) {
    const Station at = curve.station(2 * g.at - 1);
    const double length = 2 * g.weight * at.stretch;
    for (const spatial::SectionPoint& point : points) {
      const Eigen::Vector2d arm = section.centroid + point.arm;
      maps.mass.push_back({section.rhoA * length * point.share, at.at + arm[0] * at.D[0] + arm[1] * at.D[1],
                           displacement(curve, at, arm)});
    }
    Eigen::Matrix<double, 3, 2> D;
    D << at.D[0], at.D[1];
    const Eigen::Matrix2d second =
        (Eigen::Matrix2d() << section.rhoIz, section.rhoIyz, section.rhoIyz, section.rhoIy).finished();
    MatrixXd rotation = MatrixXd::Zero(3, beam_dofs);
    for (Index i = 0; i < beam_nodes; ++i) rotation.middleCols<3>(6 * i + 3) = at.N[i] * Matrix3d::Identity();
    const Vector3d arm = D * section.centroid;
    body::RotatingForms forms(length * D * second * D.transpose());
    forms.add(section.rhoA * length, at.at + arm, Matrix3d::Identity(), arm);
    if (!forms.empty()) maps.rotary.emplace_back(forms, rotation);
  }
}

}  // namespace

ElementMaps quadratic_beam(const BeamCurve& place, const SpatialBeamSection& section, const SpatialBeamStrain& strain) {
  check(section);
  const Curve curve(place);
  const double length = (place.to - place.from).norm(), gauss = 1 / std::sqrt(3.0);
  const MatrixXd M = to_centres(section), D = stiffness_of(section, length);
  ElementMaps maps;
  maps.bending = MatrixXd::Zero(beam_dofs, beam_dofs);
  for (const double r : {-gauss, gauss}) {
    const Station at = curve.station(r);
    const BeamStrains s = strains_at(curve, at);
    const MatrixXd L = M * s.L;
    if (strain.strains == Strains::second_order) {
      maps.membrane.push_back(second_order_point(curve, at, section, at.stretch, s, M, L, D, strain.wagner));
      continue;
    }
    maps.membrane.push_back(von_karman_point(curve, at, section, at.stretch, L, strain.wagner));
    const MatrixXd linear = L.bottomRows<strain_count - 1>();
    maps.bending +=
        at.stretch * linear.transpose() * D.bottomRightCorner<strain_count - 1, strain_count - 1>() * linear;
  }
  add_mass(curve, section, maps);
  return maps;
}

std::vector<body::MassPoint> quadratic_beam_line(const BeamCurve& place) {
  const Curve curve(place);
  std::vector<body::MassPoint> points;
  for (const spatial::BeamStation& g : spatial::beam_gauss3) {
    const Station at = curve.station(2 * g.at - 1);
    points.push_back({2 * g.weight * at.stretch, at.at, displacement(curve, at, Eigen::Vector2d::Zero())});
  }
  return points;
}

std::vector<Matrix3d> curve_axes(const std::vector<Vector3d>& nodes) {
  std::vector<Matrix3d> all;
  for (const double r : {-1., 1., 0.}) {
    const Vector3d d = Curve::shape_rate(r), t = (d[0] * nodes[0] + d[1] * nodes[1] + d[2] * nodes[2]).normalized();
    all.emplace_back();
    all.back() << t, t.unitOrthogonal(), t.cross(t.unitOrthogonal());
  }
  return all;
}

std::array<BeamShare, 3> quadratic_beam_shares(const BeamCurve& place) {
  const Curve curve(place);
  std::array<BeamShare, 3> shares;
  constexpr std::array<std::array<double, 2>, 3> parts{{{-1, -0.5}, {0.5, 1}, {-0.5, 0.5}}};
  for (std::size_t i = 0; i < 3; ++i) {
    BeamShare& own = shares[i];
    const auto [from, to] = parts[i];
    for (const spatial::BeamStation& g : spatial::beam_gauss3) {
      const Station at = curve.station(from + g.at * (to - from));
      const double length = g.weight * (to - from) * at.stretch;
      own.length += length, own.centre += length * at.at, own.spread += length * at.at * at.at.transpose();
    }
    own.centre /= own.length;
    own.spread -= own.length * own.centre * own.centre.transpose();
    own.axes = curve.axes[i];
  }
  return shares;
}

}  // namespace floe::fem
