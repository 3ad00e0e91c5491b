#include "floe/fem/missing_stiffness.h"

#include <algorithm>

#include "assemble_cells.h"
#include "floe/fem/quadratic_beam.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/fem/spatial_beam_fixed.h"
#include "shell_triangle.h"
#include "spatial_beam_fields.h"

namespace floe::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Calls with (dofs among the corners', nodes) of the triangles of a shell element.
template <class Act>
void each_triangle(const Structure& structure, const Mesh::Cell& cell, Act&& act) {
  const auto triangle = [&](const std::array<int, 3>& of) {
    TriangleNodes nodes;
    std::array<int, 18> dofs{};
    for (int i = 0; i < 3; ++i) {
      nodes[i] = structure.mesh.positions[cell.place[of[i]]];
      for (int d = 0; d < 6; ++d) dofs[6 * i + d] = 6 * of[i] + d;
    }
    act(dofs, nodes);
  };
  if (cell.kind == CellKind::triangle) return triangle({0, 1, 2});
  for (const std::array<int, 3>& of : quadrilateral_triangles) triangle(of);
}

/// Of a strain point at displacements on the dofs of its maps.
VectorXd stress_of(const StrainPoint& at, const VectorXd& q) {
  const VectorXd slope = at.G * q;
  return at.weight * at.D * (at.L * q + 0.5 * at.bilinear(slope, slope));
}

/// Of second-order strains at von Karman's forces, less what those have themselves.
/// @param maps  the element's own, on the dofs that move it
MatrixXd curved_in_plane(const Structure& structure, const Mesh::Cell& cell, ShellSection section,
                         const ElementMaps& maps, const VectorXd& q, const VectorXd& own) {
  std::vector<Vector3d> x;
  for (const int node : cell.places()) x.push_back(structure.mesh.positions[node]);
  const ElementMaps known = quadratic_shell(x, section);
  section.strains = Strains::second_order;
  const ElementMaps all = quadratic_shell(x, section);
  MatrixXd A = MatrixXd::Zero(own.size(), own.size());
  for (std::size_t i = 0; i < quadratic_membrane_points(x.size()); ++i) {
    const StrainPoint &at = known.membrane[i], &full = all.membrane[i];
    const VectorXd stress = stress_of(maps.membrane[i], q);
    for (std::size_t s = 0; s < at.P.size(); ++s)
      A += stress[static_cast<Eigen::Index>(s)] *
           (full.G.transpose() * full.P[s] * full.G - at.G.transpose() * at.P[s] * at.G);
  }
  return A;
}

/// @param q    on the dofs that move the element, of its corners `own`
MatrixXd in_plane(const Structure& structure, const Mesh::Cell& cell, const ShellSection& section, const VectorXd& q,
                  const VectorXd& own) {
  MatrixXd A = MatrixXd::Zero(own.size(), own.size());
  if (section.strains == Strains::second_order) return A;
  const ElementMaps maps = structure.maps(cell);
  if (mesh::is_quadratic(cell.kind)) return curved_in_plane(structure, cell, section, maps, q, own);
  std::size_t at = 0;  // a triangle has two strain points, the first one of the membrane
  each_triangle(structure, cell, [&](const std::array<int, 18>& dofs, const TriangleNodes& nodes) {
    const shell::Geometry g = shell::geometry(nodes, section.axis);
    const Vector3d N = stress_of(maps.membrane[at], q);
    at += 2;
    const Eigen::Matrix2d force = (Eigen::Matrix2d() << N[0], N[2], N[2], N[1]).finished();
    const Eigen::Matrix3d projector = g.axes.leftCols<2>() * g.axes.leftCols<2>().transpose();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A.block<3, 3>(dofs[6 * i], dofs[6 * j]) += g.gradient[i].dot(force * g.gradient[j]) * projector;
  });
  return A;
}

/// A += c (a'b + b'a): twice the quadratic form c a b.
void add_product(Matrix12& A, double c, const spatial::Row12& a, const spatial::Row12& b) {
  const Matrix12 product = a.transpose() * b;
  A += c * (product + product.transpose());
}

BeamPlace place_of(const Structure& structure, const Mesh::Cell& cell, const SpatialBeam& beam) {
  return {structure.mesh.positions[cell.place[0]], structure.mesh.positions[cell.place[1]], beam.orientation};
}

/// 2 S per length on the element's own dofs, at one station.
Matrix12 coupling_at(double s, const spatial::BeamFrame& frame, const SpatialBeamSection& section, const Vector12& q) {
  using spatial::Row12;
  const Row12 phi = spatial::twist(s), rate = spatial::twist_rate(frame.length);
  const Row12 v1 = spatial::slope_y(s, frame), w1 = spatial::slope_z(s, frame);
  const Row12 v2 = spatial::curvature_y(s, frame), w2 = spatial::curvature_z(s, frame);
  const double f = phi * q, dv = v1 * q, dw = w1 * q, ddv = v2 * q, ddw = w2 * q;
  // first variations of the curvatures and the twist rate at q: linear ones and what is missing
  Eigen::Matrix<double, 3, 12> linear, more;
  linear << v2, w2, rate;
  more << ddw * phi + f * w2, -(ddv * phi + f * v2), 0.5 * (ddv * w1 + dw * v2 - ddw * v1 - dv * w2);
  Eigen::Matrix3d EI = Eigen::Matrix3d::Zero();
  EI.topLeftCorner<2, 2>() << section.EIz, section.EIyz, section.EIyz, section.EIy;
  EI(2, 2) = section.GJ;
  const Matrix12 crossed = linear.transpose() * EI * more;
  Matrix12 A = crossed + crossed.transpose() + more.transpose() * EI * more;
  const Vector3d M = EI * (linear * q);  // second variations
  add_product(A, M[0], phi, w2);
  add_product(A, -M[1], phi, v2);
  add_product(A, M[2] / 2, w1, v2);
  add_product(A, -M[2] / 2, v1, w2);
  return A;
}

/// Tangent of second-order strains less that of von Karman's, without the changes of eps.
MatrixXd curved_coupling(const Structure& structure, const Mesh::Cell& cell, SpatialBeam beam, const VectorXd& q) {
  const auto& at = structure.mesh.positions;
  const BeamCurve curve{at[cell.place[0]], at[cell.place[1]], at[cell.place[2]], beam.orientation};
  beam.section.EA = std::numeric_limits<double>::min();
  beam.strain.wagner = false, beam.strain.strains = Strains::second_order;
  const ElementMaps maps = quadratic_beam(curve, beam.section, beam.strain);
  return maps.tangent(q) - maps.stiffness();
}

MatrixXd coupling(const Structure& structure, const Mesh::Cell& cell, SpatialBeam beam, const VectorXd& q) {
  if (cell.kind == CellKind::line3) return curved_coupling(structure, cell, beam, q);
  const BeamPlace place = place_of(structure, cell, beam);
  const spatial::BeamFrame frame = spatial::beam_frame(place, beam.section);
  Eigen::Matrix<double, 12, 12> to_own = Matrix12::Zero();
  to_own.topLeftCorner<6, 6>() = frame.node, to_own.bottomRightCorner<6, 6>() = frame.node;
  const Vector12 own = to_own * q;
  Matrix12 A = Matrix12::Zero();
  for (const spatial::BeamStation& g : spatial::beam_gauss3)
    A += g.weight * frame.length * coupling_at(g.at, frame, beam.section, own);
  const VectorXd force = fixed_spatial_beam(place, beam.section, beam.strain.wagner).bending * q;
  const VectorXd moments = MatrixXd(to_own.transpose()).partialPivLu().solve(force);
  for (int node = 0; node < 12; node += 6) {  // slopes at the nodes from their rotation vectors
    const double y = moments[node + 4] / 2, z = moments[node + 5] / 2;
    A(node + 3, node + 4) += z, A(node + 4, node + 3) += z;
    A(node + 3, node + 5) -= y, A(node + 5, node + 3) -= y;
  }
  return to_own.transpose() * A * to_own;
}

/// sum w G'(sigma P) G of `maps`, sigma the membrane forces at q of `own`, which has the same points.
MatrixXd stressed(const ElementMaps& maps, const ElementMaps& own, const VectorXd& q) {
  MatrixXd A = MatrixXd::Zero(q.size(), q.size());
  for (std::size_t g = 0; g < maps.membrane.size(); ++g) {
    const StrainPoint& at = maps.membrane[g];
    const VectorXd stress = stress_of(own.membrane[g], q);
    for (std::size_t s = 0; s < at.P.size(); ++s)
      A += stress[static_cast<Eigen::Index>(s)] * at.G.transpose() * at.P[s] * at.G;
  }
  return A;
}

/// What the axial force at q, which these strains have, does on the Wagner term.
MatrixXd tension(const Structure& structure, const Mesh::Cell& cell, SpatialBeam beam, const VectorXd& q) {
  const auto maps = [&](bool wagner) {
    beam.strain.wagner = wagner;
    if (cell.kind != CellKind::line3) return spatial_beam(place_of(structure, cell, beam), beam.section, beam.strain);
    const auto& at = structure.mesh.positions;
    const BeamCurve curve{at[cell.place[0]], at[cell.place[1]], at[cell.place[2]], beam.orientation};
    return quadratic_beam(curve, beam.section, beam.strain);
  };
  const ElementMaps without = maps(false), with = maps(true);
  return stressed(with, without, q) - stressed(without, without, q);
}

/// What `matrix_of` gives for the elements with a section of this kind, on the dofs of their nodes; null: there are
/// none.
template <class Section, class MatrixOf>
petsc::MatHandle of_kind(const Structure& structure, MatrixOf&& matrix_of) {
  const bool there = std::any_of(structure.sections.begin(), structure.sections.end(),
                                 [](const auto& section) { return std::holds_alternative<Section>(section); });
  if (!there) return {};
  return assemble_cells(structure, {}, 0, [&](const Mesh::Cell& cell) -> MatrixXd {
    const Section* section = std::get_if<Section>(&structure.sections[cell.part]);
    const auto size = static_cast<Eigen::Index>(structure.dofs_per_node * cell.nodes().size());
    if (!section) return MatrixXd::Zero(size, size);
    if (!cell.follows()) return matrix_of(cell, *section, MatrixXd::Identity(size, size));
    const MatrixXd T = following(structure.mesh, cell);
    return T.transpose() * matrix_of(cell, *section, T) * T;
  });
}

}  // namespace

MissingStiffness missing_stiffness(const Structure& structure, Vec q) {
  const VectorXd all = structure.exchange.gather(q);
  const auto of_corners = [&](const Mesh::Cell& cell, const MatrixXd& T) -> VectorXd {
    return T * all(structure.cell_dofs(cell));
  };
  MissingStiffness missing;
  missing.in_plane =
      of_kind<ShellSection>(structure, [&](const Mesh::Cell& cell, const ShellSection& section, const MatrixXd& T) {
        return in_plane(structure, cell, section, all(structure.cell_dofs(cell)), of_corners(cell, T));
      });
  const auto of_beams = [&](auto&& missing_in, auto&& matrix) -> petsc::MatHandle {
    if (std::none_of(structure.sections.begin(), structure.sections.end(), [&](const Section& section) {
          const auto* beam = std::get_if<SpatialBeam>(&section);
          return beam && missing_in(*beam);
        }))
      return {};
    return of_kind<SpatialBeam>(
        structure, [&](const Mesh::Cell& cell, const SpatialBeam& beam, const MatrixXd& T) -> MatrixXd {
          const VectorXd own = of_corners(cell, T);
          if (!missing_in(beam)) return MatrixXd::Zero(own.size(), own.size());
          if (beam.releases.none()) return matrix(structure, cell, beam, own);
          const Matrix12 to_ends = released(place_of(structure, cell, beam), beam.section, beam.releases);
          return to_ends.transpose() * matrix(structure, cell, beam, to_ends * own) * to_ends;
        });
  };
  missing.coupling =
      of_beams([](const SpatialBeam& beam) { return beam.strain.strains == Strains::von_karman; }, coupling);
  missing.tension = of_beams([](const SpatialBeam& beam) { return !beam.strain.wagner; }, tension);
  return missing;
}

petsc::MatHandle initial_stress_stiffness(const Structure& structure, Vec q) {
  const VectorXd all = structure.exchange.gather(q);
  return assemble_cells(structure, {}, 0, [&](const Mesh::Cell& cell) {
    const ElementMaps maps = structure.maps(cell);
    const VectorXd own = all(structure.cell_dofs(cell));
    return stressed(maps, maps, own);
  });
}

}  // namespace floe::fem
