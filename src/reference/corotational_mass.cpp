#include "corotational_mass.h"

#include <cmath>

#include "floe/fem/quadratic_beam.h"
#include "floe/fem/quadratic_shell.h"

namespace floe::reference {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Matrix3d none = Matrix3d::Zero();

struct Carry {
  const fem::Structure& structure;
  const fem::Mesh::Cell& cell;
  Density density;
  const Vector3d& at(int i) const { return structure.mesh.positions[cell.place[i]]; }

  std::vector<CarriedMass> operator()(const fem::SpatialBeam& beam) const {
    if (mesh::is_quadratic(cell.kind)) return of_curve(beam);
    const Vector3d along = at(1) - at(0), arm = (0.5 - 0.5 / std::sqrt(3.0)) * along;
    const double half = along.norm() / 2;
    if (density == Density::line) return {{0, half, arm, none}, {1, half, -arm, none}};
    const fem::SpatialBeamSection& s = beam.section;
    const Matrix3d E = fem::element_axes({at(0), at(1), beam.orientation});
    Matrix3d second = Matrix3d::Zero();
    second.bottomRightCorner<2, 2>() << s.rhoIz, s.rhoIyz, s.rhoIyz, s.rhoIy;
    const Vector3d off = E.rightCols<2>() * s.centroid;
    const Matrix3d spread = half * E * second * E.transpose();
    return {{0, half * s.rhoA, off + arm, spread}, {1, half * s.rhoA, off - arm, spread}};
  }
  std::vector<CarriedMass> of_curve(const fem::SpatialBeam& beam) const {
    const fem::SpatialBeamSection& s = beam.section;
    Matrix3d second = Matrix3d::Zero();
    second.bottomRightCorner<2, 2>() << s.rhoIz, s.rhoIyz, s.rhoIyz, s.rhoIy;
    std::vector<CarriedMass> all;
    for (const fem::BeamShare& own : fem::quadratic_beam_shares({at(0), at(1), at(2), beam.orientation})) {
      const int node = static_cast<int>(all.size());
      const Vector3d arm = own.centre - at(node);
      if (density == Density::line)
        all.push_back({node, own.length, arm, none});
      else
        all.push_back({node, own.length * s.rhoA, arm + own.axes.rightCols<2>() * s.centroid,
                       s.rhoA * own.spread + own.length * own.axes * second * own.axes.transpose()});
    }
    return all;
  }
  std::vector<CarriedMass> of_surface(const fem::ShellSection& section) const {
    std::vector<Vector3d> x;
    for (const int node : cell.places()) x.push_back(structure.mesh.positions[node]);
    std::vector<CarriedMass> all;
    for (const fem::NodeShare& own : fem::quadratic_shell_shares(x)) {
      const int node = static_cast<int>(all.size());
      const Vector3d arm = own.centre - at(node), z = own.normal;
      const double mass = section.mass * own.area, r = section.mass_radius;
      if (density == Density::line)
        all.push_back({node, own.area, arm, none});
      else
        all.push_back(
            {node, mass, arm + section.mass_centre * z, section.mass * own.spread + mass * r * r * z * z.transpose()});
    }
    return all;
  }
  std::vector<CarriedMass> operator()(const fem::ShellSection& section) const {
    if (mesh::is_quadratic(cell.kind)) return of_surface(section);
    std::vector<CarriedMass> all;
    if (cell.kind == fem::CellKind::triangle) {
      add_triangle(section, {0, 1, 2}, 1, all);
      return all;
    }
    for (const auto& corners : fem::quadrilateral_triangles) add_triangle(section, corners, 0.5, all);
    return all;
  }
  void add_triangle(const fem::ShellSection& section, const std::array<int, 3>& corners, double share,
                    std::vector<CarriedMass>& all) const {
    const Vector3d normal = (at(corners[1]) - at(corners[0])).cross(at(corners[2]) - at(corners[0])),
                   z = normal.normalized(), C = (at(corners[0]) + at(corners[1]) + at(corners[2])) / 3;
    const double third = share * normal.norm() / 6;
    Matrix3d spread = Matrix3d::Zero();
    for (int corner : corners) spread += 11. / 432 * (at(corner) - C) * (at(corner) - C).transpose();
    for (int corner : corners) {
      const Vector3d arm = 7. / 12 * (C - at(corner));
      if (density == Density::line) {
        all.push_back({corner, third, arm, none});
        continue;
      }
      const double mass = section.mass * third, r = section.mass_radius;
      all.push_back({corner, mass, arm + section.mass_centre * z, mass * (spread + r * r * z * z.transpose())});
    }
  }
  std::vector<CarriedMass> operator()(const fem::PointMass& point) const {
    if (density == Density::line) return {};
    return {{0, point.mass, point.offset, point.inertia.trace() / 2 * Matrix3d::Identity() - point.inertia}};
  }
  std::vector<CarriedMass> operator()(const fem::NodeSpring&) const { return {}; }
  std::vector<CarriedMass> operator()(const fem::BeamSection&) const { return {}; }  // of the plane
};

}  // namespace

std::vector<CarriedMass> carried_mass(const fem::Structure& structure, const fem::Mesh::Cell& cell, Density density) {
  return std::visit(Carry{structure, cell, density}, structure.sections[cell.part]);
}

}  // namespace floe::reference
