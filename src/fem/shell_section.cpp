#include "floe/fem/shell_section.h"

#include <algorithm>
#include <cmath>

#include "floe/error.h"
#include "floe/fem/section_points.h"

namespace floe::fem {
namespace {

void require(bool good, const char* fault) {
  if (!good) throw InputError(fault);
}

void check_ply(const Ply& ply) {
  const ShellMaterial& m = ply.material;
  require(std::isfinite(ply.thickness) && ply.thickness > 0, "a shell's thickness must be positive");
  require(std::isfinite(ply.angle), "a ply's angle must be finite");
  require(std::isfinite(m.E1) && std::isfinite(m.E2) && std::isfinite(m.G12) && m.E1 > 0 && m.E2 > 0 && m.G12 > 0,
          "a shell's moduli must be positive");
  require(m.nu12 * m.nu12 < m.E1 / m.E2, "a shell's Poisson ratio must satisfy nu12^2 < E1 / E2");
  require(std::isfinite(m.density) && m.density >= 0, "a shell's density must not be negative");
}

bool is_isotropic(const ShellMaterial& m) {
  return m.E1 == m.E2 && std::abs(m.G12 - m.E1 / (2 + 2 * m.nu12)) <= 1e-12 * m.G12;
}

/// Plane-stress stiffness of a ply in the section's axes, T Q T' with the stress transformation T.
Eigen::Matrix3d stiffness(const Ply& ply) {
  const Eigen::Matrix3d Q = plane_stress(ply.material);
  if (ply.angle == 0) return Q;
  const double c = std::cos(ply.angle), s = std::sin(ply.angle);
  Eigen::Matrix3d T;
  T << c * c, s * s, -2 * c * s, s * s, c * c, 2 * c * s, c * s, -c * s, c * c - s * s;
  return T * Q * T.transpose();
}

/// beta_0 = 256 det E / W - 3/2: the in-plane bending energy of a pair of triangles, averaged over its directions, is
/// that of the exact solution. Kept positive, for rank. Source: Felippa 2003, anisotropic materials.
double higher_order(const Eigen::Matrix3d& A) {
  const Eigen::Matrix3d E = A / A.trace();
  const double a = E(0, 0), b = E(0, 1), c = E(0, 2), d = E(1, 1), e = E(1, 2), f = E(2, 2);
  const double W = -6 * b * b * b + 5 * a * a * d - 5 * b * b * d - d * (75 * c * c + 14 * c * e + 3 * e * e) +
                   2 * b * (7 * c * c + 46 * c * e + 7 * e * e) -
                   a * (5 * b * b + 3 * c * c - 6 * b * d - 5 * d * d + 14 * c * e + 75 * e * e) +
                   (3 * a * a + 82 * a * d + 3 * d * d - 4 * (6 * b * b + 5 * c * c - 6 * c * e + 5 * e * e)) * f +
                   4 * (5 * a - 6 * b + 5 * d) * f * f;
  return std::max(256 * E.determinant() / W - 1.5, 0.01);
}

/// Whether a stiffness is the same in all directions: (a, b, 0; b, a, 0; 0, 0, (a - b) / 2).
bool is_isotropic(const Eigen::Matrix3d& S) {
  Eigen::Matrix3d same;
  same << S(0, 0), S(0, 1), 0, S(0, 1), S(0, 0), 0, 0, 0, (S(0, 0) - S(0, 1)) / 2;
  return (S - same).norm() <= 1e-9 * S.norm();
}

}  // namespace

Eigen::Matrix3d plane_stress(const ShellMaterial& m) {
  const double nu21 = m.nu12 * m.E2 / m.E1, d = 1 - m.nu12 * nu21;
  Eigen::Matrix3d Q;
  Q << m.E1 / d, m.nu12 * m.E2 / d, 0, m.nu12 * m.E2 / d, m.E2 / d, 0, 0, 0, m.G12;
  return Q;
}

ShellMaterial isotropic(double E, double nu, double density) {
  require(nu > -1 && nu <= 0.5, "Poisson's ratio must lie between -1 and 0.5");
  return {E, E, nu, E / (2 + 2 * nu), density};
}

ShellSection shell_section(const std::vector<Ply>& plies, double offset, const Eigen::Vector3d& axis) {
  require(!plies.empty(), "a shell needs a ply");
  require(std::isfinite(offset) && axis.allFinite(), "a shell's offset and axis must be finite");
  double thickness = 0, shear = 0;
  bool directed = false;
  for (const Ply& ply : plies) {
    check_ply(ply);
    thickness += ply.thickness;
    shear += 5. / 6 * ply.material.G12 * ply.thickness;
    directed = directed || !is_isotropic(ply.material);
  }
  require(!directed || axis.norm() > 0, "an orthotropic shell needs an axis");

  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), B = A, D = A;  // about the middle of the stack
  double mass = 0, first = 0, second = 0, bottom = -thickness / 2;
  for (const Ply& ply : plies) {
    const Eigen::Matrix3d Q = stiffness(ply);
    const double h = ply.thickness, z = bottom + h / 2, zz = z * z + h * h / 12;
    A += Q * h;
    B += Q * (h * z);
    D += Q * (h * zz);
    mass += ply.material.density * h;
    first += ply.material.density * h * z;
    second += ply.material.density * h * zz;
    bottom += h;
  }
  ShellSection section;
  section.A = A;
  const Eigen::Matrix3d C = A.inverse() * B, Ds = D - B * C;
  section.coupling = C + offset * Eigen::Matrix3d::Identity();
  section.bending = (Ds + Ds.transpose()) / 2;
  section.shear = shear;
  section.higher_order = higher_order(A);
  section.mass = mass;
  const double centre = mass > 0 ? first / mass : 0;
  section.mass_centre = offset + centre;
  section.mass_radius = mass > 0 ? std::sqrt(second / mass - centre * centre) : 0;
  section.axis = axis;
  return section;
}

ShellSection stiffness_section(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B, const Eigen::Matrix3d& D,
                               double mass, const Eigen::Vector3d& axis) {
  require(A.allFinite() && B.allFinite() && D.allFinite() && axis.allFinite(), "a shell's stiffness must be finite");
  require(std::isfinite(mass) && mass >= 0, "a shell's mass per area must not be negative");
  require(A.llt().info() == Eigen::Success, "a shell's membrane stiffness A is not positive definite");
  const Eigen::Matrix3d C = A.inverse() * B, Ds = D - B * C;
  const Eigen::Matrix3d bending = (Ds + Ds.transpose()) / 2;
  require(bending.llt().info() == Eigen::Success,
          "a shell's bending stiffness D - B A^-1 B is not positive definite (a section of membranes alone?)");
  const bool directed = !(is_isotropic(A) && is_isotropic(B) && is_isotropic(D));
  require(!directed || axis.norm() > 0, "a shell whose stiffness differs by direction needs an axis");
  ShellSection section;
  section.A = A, section.coupling = C, section.bending = bending;
  section.shear = 5. / 6 * A(2, 2);
  section.higher_order = higher_order(A);
  section.mass = mass, section.mass_centre = 0;
  section.mass_radius = std::sqrt((bending(0, 0) + bending(1, 1)) / (A(0, 0) + A(1, 1)));
  section.axis = directed ? axis : Eigen::Vector3d::Zero();
  return section;
}

ShellSection on_curved_surface(ShellSection section, double rise) {
  const double thickness_squared = 12 * section.bending.trace() / section.A.trace();
  const double eta = 1 / (1 + 100 * rise * rise / thickness_squared);
  section.higher_order *= eta;
  section.drilling = std::min(section.drilling * std::pow(eta, 1. / 12), 50 * std::sqrt(eta));
  return section;
}

std::vector<ShellLayer> shell_layers(const std::vector<Ply>& plies, double offset) {
  double z = offset;
  for (const Ply& ply : plies) z -= ply.thickness / 2;
  std::vector<ShellLayer> layers;
  for (const Ply& ply : plies) {
    layers.push_back({stiffness(ply), z, z + ply.thickness});
    z += ply.thickness;
  }
  return layers;
}

std::vector<Eigen::Vector2d> rectangle_corners(double width, double height) {
  const double y = width / 2, z = height / 2;
  return {{y, z}, {-y, z}, {-y, -z}, {y, -z}};
}

}  // namespace floe::fem
