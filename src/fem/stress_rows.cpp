#include "floe/fem/stress_rows.h"

#include <algorithm>
#include <cmath>

#include "floe/fem/quadratic_beam.h"
#include "floe/fem/transform.h"
#include "floe/math/rotation.h"

namespace floe::fem {
namespace {

/// Strains (xx, yy, 2 xy) in axes rotated by `angle` about the normal.
Eigen::Matrix3d turned_strain(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d T;
  T << c * c, s * s, c * s, s * s, c * c, -c * s, -2 * c * s, 2 * c * s, c * c - s * s;
  return T;
}

void add_terms(const ShellSample& sample, const Eigen::Matrix<double, 6, 6>& rotation, int first, ShellRows& rows) {
  const int gradients = static_cast<int>(sample.G.rows());
  for (int p = 0; p < gradients; ++p)
    for (int q = p; q < gradients; ++q) {
      Eigen::Matrix<double, 6, 1> P;
      for (int i = 0; i < 6; ++i) P[i] = sample.P[static_cast<std::size_t>(i)](p, q);
      if (P.isZero(0)) continue;
      P = (p == q ? 0.5 : 1.) * (rotation * P);
      ShellRows::Term& term = rows.terms.emplace_back(ShellRows::Term{first + p, first + q, {}});
      std::copy(P.data(), P.data() + 6, term.C.begin());
    }
}

}  // namespace

ShellRows shell_rows(const std::vector<ShellSample>& samples, std::span<const std::size_t> chosen,
                     const Eigen::Vector3d& axis, int corners) {
  ShellRows out;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double shares = 0;
  Eigen::Index gradients = 0;
  for (const std::size_t i : chosen) {
    const ShellSample& one = samples[i];
    normal += one.share * one.axes.col(2), out.at += one.share * one.at, shares += one.share;
    gradients += one.G.rows();
  }
  out.at /= shares;
  out.axes.col(2) = normal.normalized();
  out.axes.col(0) = (axis - out.axes.col(2).dot(axis) * out.axes.col(2)).normalized();
  out.axes.col(1) = out.axes.col(2).cross(out.axes.col(0));
  out.rows = SmallRows::Zero(6 + gradients, 6 * corners);
  Eigen::Index next = 6;
  for (const std::size_t i : chosen) {
    const ShellSample& one = samples[i];
    const Eigen::Vector3d own = one.axes.col(0);
    const double angle = -std::atan2(out.axes.col(1).dot(own), out.axes.col(0).dot(own));
    Eigen::Matrix<double, 6, 6> rotation = Eigen::Matrix<double, 6, 6>::Zero();
    rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = one.share / shares * turned_strain(angle);
    const Eigen::MatrixXd L = rotation * one.L;
    for (std::size_t c = 0; c < one.corners.size(); ++c) {
      const auto from = static_cast<Eigen::Index>(6 * c), to = static_cast<Eigen::Index>(6 * one.corners[c]);
      out.rows.block(0, to, 6, 6) += L.middleCols(from, 6);
      out.rows.block(next, to, one.G.rows(), 6) = one.G.middleCols(from, 6);
    }
    add_terms(one, rotation, static_cast<int>(next - 6), out);
    next += one.G.rows();
  }
  return out;
}

SmallRows shell_strains(const ShellRows& of, const Eigen::Ref<const SmallRows>& values) {
  SmallRows s = values.topRows(6);
  Eigen::RowVectorXd product;
  for (const ShellRows::Term& term : of.terms) {
    product = values.row(6 + term.p).cwiseProduct(values.row(6 + term.q));
    for (int i = 0; i < 6; ++i)
      if (const double c = term.C[static_cast<std::size_t>(i)]; c != 0) s.row(i) += c * product;
  }
  return s;
}

Eigen::Vector3d surface_axis(const ShellSection& section, const Eigen::Matrix3d& mesh_axes,
                             const Eigen::Vector3d& normal) {
  if (!section.axis.isZero(0)) return section.axis.normalized();
  const Eigen::Vector3d x = mesh_axes.col(0);
  return (x - normal.dot(x) * normal).norm() > 0.1 ? x : Eigen::Vector3d(mesh_axes.col(1));
}

SmallRows layer_strain(const ShellSection& section, double z, const Eigen::Ref<const SmallRows>& s) {
  return s.topRows(3) + (z * Eigen::Matrix3d::Identity() - section.coupling) * s.bottomRows(3);
}

BeamForces::BeamForces(const Structure& structure, const Mesh::Cell& cell, bool linear)
    : plane_(structure.dimension() == 2), linear_(linear), rotation_vectors_(false) {
  const auto x = [&](int i) -> const Eigen::Vector3d& { return structure.mesh.positions[cell.place[i]]; };
  if (plane_) {
    const auto& section = std::get<BeamSection>(structure.sections[cell.part]);
    maps_ = planar_beam(x(0).head<2>(), x(1).head<2>(), section, structure.strain);
    const Eigen::Vector3d along = (x(1) - x(0)).normalized();
    axes_[0] << along, Eigen::Vector3d(-along.y(), along.x(), 0), Eigen::Vector3d::UnitZ();
    axes_[1] = axes_[0];
    return;
  }
  const auto& beam = std::get<SpatialBeam>(structure.sections[cell.part]);
  rotation_vectors_ = beam.strain.strains == Strains::second_order && !linear_;
  if (cell.kind == CellKind::line) {
    const BeamPlace place{x(0), x(1), beam.orientation};
    maps_ = spatial_beam(place, beam.section, beam.strain);
    if (beam.releases.any()) maps_ = transformed(maps_, released(place, beam.section, beam.releases));
    axes_[0] = axes_[1] = element_axes(place);
  } else {
    const BeamCurve curve{x(0), x(1), x(2), beam.orientation};
    maps_ = quadratic_beam(curve, beam.section, beam.strain);
    const auto shares = quadratic_beam_shares(curve);
    axes_ = {shares[0].axes, shares[1].axes};
  }
}

BeamForces::Ends BeamForces::operator()(const Eigen::VectorXd& q) const {
  Eigen::VectorXd f = maps_.bending * q;
  for (const StrainPoint& point : maps_.membrane) {
    if (linear_) {
      f += point.weight * (point.L.transpose() * (point.D * (point.L * q)));
      continue;
    }
    const Eigen::VectorXd slope = point.G * q;
    const Eigen::VectorXd sigma = point.D * (point.L * q + 0.5 * point.bilinear(slope, slope));
    f += point.weight * (point.L.transpose() * sigma);
    for (std::size_t s = 0; s < point.P.size(); ++s)
      f += point.weight * sigma[static_cast<Eigen::Index>(s)] * (point.G.transpose() * (point.P[s] * slope));
  }
  Ends ends;
  for (int i = 0; i < 2; ++i) {
    const double sign = i == 0 ? -1 : 1;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force, theta = force;
    if (plane_) {
      force.head<2>() = f.segment<2>(3 * i), moment[2] = f[3 * i + 2], theta[2] = q[3 * i + 2];
    } else {
      force = f.segment<3>(6 * i), moment = f.segment<3>(6 * i + 3), theta = q.segment<3>(6 * i + 3);
    }
    const Eigen::Matrix3d rotation = linear_ ? Eigen::Matrix3d::Identity() : math::rotation(theta);
    if (rotation_vectors_)  // conjugate to changes of theta: the spin in rotated axes is T dtheta
      moment = rotation * math::rotation_tangent(theta).transpose().inverse() * moment;
    const Eigen::Matrix3d section = rotation * axes_[static_cast<std::size_t>(i)];
    ends.force[static_cast<std::size_t>(i)] = sign * (section.transpose() * force);
    ends.moment[static_cast<std::size_t>(i)] = sign * (section.transpose() * moment);
  }
  return ends;
}

std::array<double, 2> fibre_stress(const Section& section, const StressPoints& points, const Eigen::Vector3d& force,
                                   const Eigen::Vector3d& moment) {
  double mean = 0, least = 0, greatest = 0;
  if (const auto* planar = std::get_if<BeamSection>(&section)) {
    mean = points.E * force[0] / planar->EA;
    for (const Eigen::Vector2d& fibre : points.fibres) {
      const double bend = -points.E * moment[2] / planar->EI * fibre[0];
      least = std::min(least, bend), greatest = std::max(greatest, bend);
    }
    return {mean + least, mean + greatest};
  }
  const SpatialBeamSection& of = std::get<SpatialBeam>(section).section;
  const double N = force[0], My = moment[1] - of.centroid[1] * N, Mz = moment[2] + of.centroid[0] * N;
  mean = points.E * N / of.EA;
  Eigen::Matrix2d EI;
  EI << of.EIyz, of.EIy, of.EIz, of.EIyz;
  const Eigen::Vector2d b = EI.inverse() * Eigen::Vector2d(My, -Mz);
  if (points.radius > 0) {
    const double bend = points.E * points.radius * b.norm();
    return {mean - bend, mean + bend};
  }
  for (const Eigen::Vector2d& fibre : points.fibres) {
    const double bend = points.E * fibre.dot(b);
    least = std::min(least, bend), greatest = std::max(greatest, bend);
  }
  return {mean + least, mean + greatest};
}

double torsion_stress(const Section& section, const StressPoints& points, const Eigen::Vector3d& force,
                      const Eigen::Vector3d& moment) {
  const auto* beam = std::get_if<SpatialBeam>(&section);
  if (!beam || points.W == 0) return 0;
  const Eigen::Vector2d& centre = beam->section.shear_centre;
  return (moment[0] - centre[0] * force[2] + centre[1] * force[1]) / points.W;
}

}  // namespace floe::fem
