#include "spatial_beam_fields.h"

namespace floe::fem::spatial {
namespace {

using Row8 = Eigen::Matrix<double, 1, 8>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// What the quadratic part acts on, from own dofs: rotation vectors of both nodes, slopes of the chord.
Eigen::Matrix<double, 8, 12> rotations(double l) {
  Eigen::Matrix<double, 8, 12> y = Eigen::Matrix<double, 8, 12>::Zero();
  y.block<3, 3>(0, 3).setIdentity(), y.block<3, 3>(3, 9).setIdentity();
  y(6, 1) = y(7, 2) = -1 / l, y(6, 7) = y(7, 8) = 1 / l;
  return y;
}

/// The same field, which no translation changes, on `rotations`.
Row8 of_rotations(const Row12& own, double l) {
  Row8 row;
  row << own.segment<3>(3), own.segment<3>(9), l * own[7], l * own[8];
  return row;
}

/// P with 1/2 y'P y = (a y)(b y).
Matrix8 product(const Row8& a, const Row8& b) { return a.transpose() * b + b.transpose() * a; }

/// A strain on own dofs: L q + 1/2 y'P y.
struct Strain {
  Row12 L = Row12::Zero();
  Matrix8 P = Matrix8::Zero();
};

/// The strain of what own dofs are at second order, linear in them: C and S move by exp(theta), slopes are those of the
/// rotated axis, v' = rz + 1/2 rx ry and w' = -ry + 1/2 rx rz.
Strain of_own(const Row12& L, const BeamFrame& f) {
  Strain strain{L, Matrix8::Zero()};
  for (int node = 0; node < 2; ++node) {
    const Row8 x = Row8::Unit(3 * node), y = Row8::Unit(3 * node + 1), z = Row8::Unit(3 * node + 2);
    const Matrix8 xy = product(x, y) / 2, xz = product(x, z) / 2, yz = product(y, z) / 2, xx = product(x, x) / 2,
                  yy = product(y, y) / 2, zz = product(z, z) / 2;
    const auto own = L.segment<6>(6 * node);
    strain.P += own[0] * (f.C[0] * xy + f.C[1] * xz);
    strain.P += own[1] * (f.S[1] * yz - f.S[0] * (xx + zz));
    strain.P += own[2] * (f.S[0] * yz - f.S[1] * (xx + yy));
    strain.P += own[5] * xy - own[4] * xz;
  }
  return strain;
}

StrainPoint point_of(const Strain& first, const Strain& second, const Eigen::Matrix2d& D, const BeamFrame& f) {
  Eigen::MatrixXd L(2, 12);
  L << to_body<1>(first.L, f), to_body<1>(second.L, f);
  return {f.length, D, L, to_body<8>(rotations(f.length), f), {first.P, second.P}};
}

}  // namespace

std::vector<StrainPoint> second_order_strains(const BeamFrame& f, const SpatialBeamSection& section, bool wagner) {
  const double l = f.length;
  const auto field = [&](const Row12& own) { return of_rotations(own, l); };
  Strain eps = of_own(stretch_rate(l), f);
  for (const BeamStation& g : beam_gauss3) {  // slopes squared have degree 4
    const Row8 v = field(centroid_slope_y(g.at, f)), w = field(centroid_slope_z(g.at, f));
    eps.P += g.weight / 2 * (product(v, v) + product(w, w));
  }
  const Row8 rate = field(twist_rate(l));
  if (wagner) eps.P += (section.EIy + section.EIz) / section.EA / 2 * product(rate, rate);

  Strain tau = of_own(twist_rate(l), f);
  for (const BeamStation& g : beam_gauss3) {
    const Row8 v = field(slope_y(g.at, f) - f.shear.row(0)), w = field(slope_z(g.at, f) - f.shear.row(1));
    tau.P += g.weight / 2 * (product(w, field(curvature_y(g.at, f))) - product(v, field(curvature_z(g.at, f))));
  }

  // mean and odd part, v'' = mean + (2 s - 1) odd, of the cubics without shear, which its own odd strain takes: shear
  // is condensed in that one's stiffness; `bent` is what curves the line with shear
  const ShearRows D = -6 / (l * l) * antisymmetric(l), bent = D + 6 / l * f.shear;
  Row12 mean_v = Row12::Zero(), mean_w = Row12::Zero();
  mean_v[5] = mean_w[10] = -1 / l, mean_v[11] = mean_w[4] = 1 / l;
  Strain mean_z = of_own(mean_v, f), mean_y = of_own(mean_w, f), odd_z = of_own(D.row(0), f),
         odd_y = of_own(D.row(1), f);
  const Row8 phi = field(twist(0.5)), half = field(twist(1)) - phi;  // twist = phi + (2 s - 1) half
  const auto add = [&](double sign, const Row8& mean, int other, Strain& to_mean, Strain& to_odd) {
    to_mean.P += sign * (product(phi, mean) + product(half, field(bent.row(other))) / 3);
    to_odd.P += sign * (product(phi, field(D.row(other))) + product(half, mean));
  };
  add(1, field(mean_w), 1, mean_z, odd_z);
  add(-1, field(mean_v), 0, mean_y, odd_y);

  const Eigen::Matrix2d stretch_and_twist = Eigen::Vector2d(section.EA, section.GJ).asDiagonal();
  Eigen::Matrix2d EI;
  EI << section.EIz, section.EIyz, section.EIyz, section.EIy;
  const Eigen::Matrix2d odd =
      section.shears() ? Eigen::Matrix2d(l * l * l / 36 * antisymmetric_stiffness(section, l)) : EI / 3;
  return {point_of(eps, tau, stretch_and_twist, f), point_of(mean_z, mean_y, EI, f), point_of(odd_z, odd_y, odd, f)};
}

}  // namespace floe::fem::spatial
