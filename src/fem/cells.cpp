#include "cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "floe/error.h"
#include "floe/fem/point_mass.h"
#include "floe/fem/quadratic_beam.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/fem/shell.h"
#include "floe/fem/spatial_beam_fixed.h"
#include "floe/fem/transform.h"
#include "floe/petsc/error.h"

namespace floe::fem {
namespace {

/// The nodes of a cell, as the elements want them.
struct Corners {
  const Mesh& mesh;
  const Mesh::Cell& cell;
  MembraneStrain strain;
  const Eigen::Vector3d& operator[](int i) const { return mesh.positions[cell.place[i]]; }
  Eigen::Vector2d planar(int i) const { return mesh.positions[cell.place[i]].head<2>(); }
  TriangleNodes triangle() const { return {(*this)[0], (*this)[1], (*this)[2]}; }
  QuadrilateralNodes quadrilateral() const { return {(*this)[0], (*this)[1], (*this)[2], (*this)[3]}; }
  bool three() const { return cell.kind == CellKind::triangle; }
  bool quadratic() const { return mesh::is_quadratic(cell.kind); }
  std::vector<Eigen::Vector3d> all() const {
    std::vector<Eigen::Vector3d> x;
    for (const int node : cell.places()) x.push_back(mesh.positions[node]);
    return x;
  }
};

BeamPlace place_of(const Corners& at, const SpatialBeam& beam) { return {at[0], at[1], beam.orientation}; }
BeamCurve curve_of(const Corners& at, const SpatialBeam& beam) { return {at[0], at[1], at[2], beam.orientation}; }

ElementMaps maps_of(const Corners& at, const BeamSection& section) {
  return planar_beam(at.planar(0), at.planar(1), section, at.strain);
}
ElementMaps maps_of(const Corners& at, const SpatialBeam& beam) {
  if (at.quadratic()) return quadratic_beam(curve_of(at, beam), beam.section, beam.strain);
  const ElementMaps rigidly_joined = spatial_beam(place_of(at, beam), beam.section, beam.strain);
  if (beam.releases.none()) return rigidly_joined;
  ElementMaps maps = transformed(rigidly_joined, released(place_of(at, beam), beam.section, beam.releases));
  if (beam.alone.any()) maps.bending += rod_rotations(place_of(at, beam), beam.section, beam.releases, beam.alone);
  return maps;
}
ElementMaps maps_of(const Corners& at, const ShellSection& section) {
  if (at.quadratic()) return quadratic_shell(at.all(), section);
  const ShellSection scaled = on_curved_surface(section, at.cell.rise);
  return at.three() ? shell_triangle(at.triangle(), scaled) : shell_quadrilateral(at.quadrilateral(), scaled);
}
ElementMaps maps_of(const Corners& at, const PointMass& point) {
  return point_mass(at[0], point.mass, point.inertia, point.offset);
}
ElementMaps maps_of(const Corners& at, const NodeSpring& spring) { return node_spring(at[0], at[1], spring); }

Eigen::MatrixXd sums_of(const ElementMaps& maps, double k, double m) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(maps.bending.rows(), maps.bending.cols());
  if (k != 0) A += k * maps.stiffness();
  if (m != 0) A += m * maps.mass_matrix();
  return A;
}
template <class Section>
Eigen::MatrixXd matrix_of(const Corners& at, const Section& section, double k, double m) {
  return sums_of(maps_of(at, section), k, m);
}
Eigen::MatrixXd matrix_of(const Corners& at, const SpatialBeam& beam, double k, double m) {
  if (at.quadratic() || beam.releases.any()) return sums_of(maps_of(at, beam), k, m);
  Matrix12 A = Matrix12::Zero();
  if (k != 0) A += k * stiffness(fixed_spatial_beam(place_of(at, beam), beam.section, beam.strain.wagner));
  if (m != 0) A += m * spatial_beam_mass(place_of(at, beam), beam.section);
  return A;
}
Eigen::MatrixXd matrix_of(const Corners& at, const ShellSection& section, double k, double m) {
  const auto sum = [&](auto A, auto stiffness, auto mass, const auto& nodes) {
    const ShellSection scaled = on_curved_surface(section, at.cell.rise);
    A.setZero();
    if (k != 0) A += k * stiffness(nodes, scaled);
    if (m != 0) A += m * mass(nodes, scaled);
    return Eigen::MatrixXd(A);
  };
  if (at.quadratic()) return sums_of(quadratic_shell(at.all(), section), k, m);
  if (at.three())
    return sum(Eigen::Matrix<double, 18, 18>(), shell_triangle_stiffness, shell_triangle_mass, at.triangle());
  return sum(Eigen::Matrix<double, 24, 24>(), shell_quadrilateral_stiffness, shell_quadrilateral_mass,
             at.quadrilateral());
}

std::vector<body::MassPoint> line_of(const Corners& at, const BeamSection& section) {
  return planar_beam_line(at.planar(0), at.planar(1), section);
}
std::vector<body::MassPoint> line_of(const Corners& at, const SpatialBeam& beam) {
  if (at.quadratic()) return quadratic_beam_line(curve_of(at, beam));
  const std::vector<body::MassPoint> line = spatial_beam_line(place_of(at, beam), beam.section);
  if (beam.releases.none()) return line;
  return transformed(line, released(place_of(at, beam), beam.section, beam.releases));
}
std::vector<body::MassPoint> line_of(const Corners& at, const ShellSection&) {
  std::vector<body::MassPoint> points;
  if (at.quadratic()) {
    for (const CurvedPoint& point : quadratic_shell_surface(at.all()))
      points.push_back({point.at.area, point.at.x, point.at.N});
    return points;
  }
  for (const SurfacePoint& point :
       at.three() ? shell_triangle_surface(at.triangle()) : shell_quadrilateral_surface(at.quadrilateral()))
    points.push_back({point.area, point.x, point.N});
  return points;
}
std::vector<body::MassPoint> line_of(const Corners&, const PointMass&) { return {}; }
std::vector<body::MassPoint> line_of(const Corners& at, const NodeSpring& spring) { return maps_of(at, spring).mass; }

/// Elements of second order, by their place where they cannot be.
template <class Make>
void check_curved(const Corners& at, Make&& make) {
  try {
    make();
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}, the one at ({:.6g}, {:.6g}, {:.6g})", error.what(), at[0].x(), at[0].y(), at[0].z()));
  }
}
void check_of(const Corners&, const BeamSection&) {}
void check_of(const Corners& at, const SpatialBeam& beam) {
  if (at.quadratic())
    check_curved(at, [&] { quadratic_beam(curve_of(at, beam), beam.section, beam.strain); });
  else
    element_axes(place_of(at, beam));
}
void check_of(const Corners& at, const ShellSection& section) {
  if (at.quadratic())
    check_curved(at, [&] { quadratic_shell(at.all(), section); });
  else if (at.three())
    shell_triangle_strain(at.triangle(), section);
  else
    for (const auto& corner : quadrilateral_triangles)
      shell_triangle_strain({at[corner[0]], at[corner[1]], at[corner[2]]}, section);
}
void check_of(const Corners& at, const PointMass& point) { maps_of(at, point); }
void check_of(const Corners& at, const NodeSpring& spring) { maps_of(at, spring); }

bool belongs(CellKind kind, const BeamSection&) { return kind == CellKind::line; }
bool belongs(CellKind kind, const SpatialBeam&) { return mesh::is_line(kind); }
bool belongs(CellKind kind, const ShellSection&) { return mesh::is_shell(kind); }
bool belongs(CellKind kind, const PointMass&) { return kind == CellKind::point; }
bool belongs(CellKind kind, const NodeSpring&) { return kind == CellKind::spring; }

}  // namespace

Eigen::MatrixXd following(const Mesh& mesh, const Mesh::Cell& cell) {
  const auto corners = cell.places(), nodes = cell.nodes();
  const Eigen::Index n = mesh.dimension == 2 ? 3 : 6, size = n * static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(n * static_cast<Eigen::Index>(corners.size()), size);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (cell.line[i] >= 0) {
      const Eigen::Matrix3d S = spin_of(mesh, corners[i])->own();
      const Eigen::Index own = 6 * static_cast<Eigen::Index>(i);
      T.block<6, 6>(own, own).setZero();
      T.block<3, 3>(own + 3, own + 3) = S;
      T.block<6, 6>(own, 6 * static_cast<Eigen::Index>(cell.line[i])) =
          spin_arm(mesh.positions[corners[i]] - mesh.positions[nodes[cell.line[i]]], S);
      continue;
    }
    const Eigen::Vector3d arm = mesh.positions[corners[i]] - mesh.positions[nodes[i]];
    const Eigen::Index at = n * static_cast<Eigen::Index>(i);
    if (n == 3)
      T.block<3, 3>(at, at) = rigid_arm(Eigen::Vector2d(arm.head<2>()));
    else
      T.block<6, 6>(at, at) = rigid_arm(arm);
  }
  return T;
}

std::vector<RigidArm> rigid_arms(const Mesh& mesh, const Mesh::Cell& cell) {
  std::vector<RigidArm> arms;
  const auto corners = cell.places(), nodes = cell.nodes();
  const std::size_t d = static_cast<std::size_t>(mesh.dimension), n = 3 * (d - 1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t by = cell.line[i] >= 0 ? static_cast<std::size_t>(cell.line[i]) : i;
    const Eigen::Vector3d arm = mesh.positions[corners[i]] - mesh.positions[nodes[by]];
    if (!arm.isZero(0)) arms.push_back({static_cast<Eigen::Index>(n * i), static_cast<Eigen::Index>(n * by + d), arm});
  }
  return arms;
}

namespace {

/// Whether all strains of elements of the section are of second order, so that they take the arms of rigid links.
bool second_order(const Section& section) {
  if (const auto* shell = std::get_if<ShellSection>(&section)) return shell->strains == Strains::second_order;
  if (const auto* spring = std::get_if<NodeSpring>(&section)) return spring->kind != mesh::SpringKind::linear;
  const auto* beam = std::get_if<SpatialBeam>(&section);
  return beam && beam->strain.strains == Strains::second_order;
}

/// Of the products of rotations that arms have added to strains those about axes in the plane remain.
/// @param own  before
void keep_slopes(const Eigen::Matrix3d& in_plane, const ElementMaps& own, ElementMaps& maps) {
  for (std::size_t i = 0; i < maps.membrane.size(); ++i) {
    const Eigen::Index before = own.membrane[i].G.rows();
    StrainPoint& point = maps.membrane[i];
    bool slopes = false;
    for (Eigen::Index row = before; row < point.G.rows(); row += 3) {
      point.G.middleRows<3>(row) = (in_plane * point.G.middleRows<3>(row)).eval();
      for (const Eigen::MatrixXd& P : point.P)
        slopes = slopes || (in_plane * P.block<3, 3>(row, row) * in_plane).norm() > 1e-12 * P.norm();
    }
    if (before > 0 || slopes) continue;
    point.G.conservativeResize(0, Eigen::NoChange);  // bending, which remains linear
    for (Eigen::MatrixXd& P : point.P) P.resize(0, 0);
  }
}

}  // namespace

Eigen::Matrix3d slopes_of_arms(const Mesh::Cell& cell, const std::vector<Eigen::Vector3d>& x) {
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return x[cell.corners()[i]]; };
  const bool three = cell.corners().size() == 3;
  const Eigen::Vector3d normal = (at(2) - at(0)).cross(three ? at(0) - at(1) : at(3) - at(1)).normalized();
  return Eigen::Matrix3d::Identity() - normal * normal.transpose();
}

ElementMaps Structure::maps(const Mesh::Cell& cell) const {
  const Corners at{mesh, cell, strain};
  ElementMaps own = std::visit([&](const auto& section) { return maps_of(at, section); }, sections[cell.part]);
  if (!cell.follows()) return own;
  const auto* shell = std::get_if<ShellSection>(&sections[cell.part]);
  const bool slopes = shell && shell->strains == Strains::von_karman;
  ElementMaps maps =
      transformed(own, following(mesh, cell), rigid_arms(mesh, cell), slopes || second_order(sections[cell.part]));
  if (slopes) keep_slopes(slopes_of_arms(cell, mesh.positions), own, maps);
  return maps;
}

Eigen::MatrixXd Structure::matrix(const Mesh::Cell& cell, double k, double m) const {
  Eigen::MatrixXd own = std::visit(
      [&](const auto& section) {
        return matrix_of({mesh, cell, strain}, section, k, m);
      },
      sections[cell.part]);
  if (!cell.follows()) return own;
  const Eigen::MatrixXd T = following(mesh, cell);
  return T.transpose() * own * T;
}

std::vector<body::MassPoint> Structure::line(const Mesh::Cell& cell) const {
  std::vector<body::MassPoint> own = std::visit(
      [&](const auto& section) {
        return line_of({mesh, cell, strain}, section);
      },
      sections[cell.part]);
  return cell.follows() ? transformed(own, following(mesh, cell)) : own;
}

namespace {

void check_cell(const Structure& structure, const Mesh::Cell& cell) {
  const Corners at{structure.mesh, cell, structure.strain};
  std::visit(
      [&](const auto& section) {
        if (!belongs(cell.kind, section))
          throw InputError(
              fmt::format("the element at ({:.6g}, {:.6g}, {:.6g}) has a section of another kind: lines are "
                          "beams, triangles and quadrilaterals shells",
                          at[0].x(), at[0].y(), at[0].z()));
        check_of(at, section);
      },
      structure.sections[cell.part]);
}

using Place = std::array<double, 3>;
constexpr Place nowhere{PETSC_INFINITY, PETSC_INFINITY, PETSC_INFINITY};

/// The first fault of this rank's cells, by place.
std::pair<Place, std::string> first_fault(const Structure& structure) {
  std::pair<Place, std::string> first{nowhere, ""};
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    try {
      check_cell(structure, cell);
    } catch (const InputError& error) {
      const Eigen::Vector3d& at = structure.mesh.positions[static_cast<std::size_t>(cell.place[0])];
      first = std::min(first, {{at.x(), at.y(), at.z()}, error.what()});
    }
  }
  return first;
}

}  // namespace

void check_cells(const Structure& structure) {
  std::pair<Place, std::string> found;
  petsc::agree(structure.mesh.comm, [&] { found = first_fault(structure); });
  const Place mine = found.first;
  Place first = mine;  // of all ranks: x first, y among those of this x, then z
  for (std::size_t i = 0; i < 3; ++i) {
    double candidate = std::equal(first.begin(), first.begin() + i, mine.begin()) ? mine[i] : PETSC_INFINITY;
    MPI_Allreduce(MPI_IN_PLACE, &candidate, 1, MPI_DOUBLE, MPI_MIN, structure.mesh.comm);
    first[i] = candidate;
  }
  petsc::agree(structure.mesh.comm, [&] {
    if (!found.second.empty() && found.first == first) throw InputError(found.second);
  });
}

namespace {

Section rotate(const BeamSection& section, const Eigen::Matrix3d&) { return section; }
Section rotate(SpatialBeam beam, const Eigen::Matrix3d& R) {
  beam.orientation = R.transpose() * beam.orientation;
  return beam;
}
Section rotate(ShellSection section, const Eigen::Matrix3d& R) {
  section.axis = R.transpose() * section.axis;
  return section;
}
Section rotate(PointMass point, const Eigen::Matrix3d& R) {
  point.inertia = R.transpose() * point.inertia * R;
  point.offset = R.transpose() * point.offset;
  return point;
}
Section rotate(NodeSpring spring, const Eigen::Matrix3d& R) {
  spring.axes = R.transpose() * spring.axes;
  return spring;
}

}  // namespace

Section rotated(const Section& section, const Eigen::Matrix3d& rotation) {
  return std::visit([&](const auto& s) { return rotate(s, rotation); }, section);
}

}  // namespace floe::fem
