#include "floe/fem/piece_rows.h"

#include <algorithm>
#include <cmath>

#include "cells.h"
#include "floe/fem/flat_body.h"
#include "floe/fem/quadratic_shell.h"
#include "floe/fem/transform.h"
#include "floe/math/rotation.h"
#include "shell_triangle.h"

namespace floe::fem {
namespace {

/// R with R'R = S, for S symmetric positive semi-definite: by the eigenvalues of S with a diagonal of ones, for rows of
/// displacements and of rotations have units of their own.
Eigen::MatrixXd root(const Eigen::MatrixXd& S) {
  if (S.size() == 1) return S.cwiseSqrt();
  const Eigen::VectorXd size = S.diagonal().cwiseMax(0).cwiseSqrt(),
                        inverse = size.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * S * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose() *
         size.asDiagonal();
}

/// The same, upper triangular; a direction without stiffness but for round-off has none.
Eigen::Matrix3d root3(Eigen::Matrix3d S) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  const double least = 1e-14 * S.trace();
  for (int i = 0; i < 3; ++i) {
    if (!(S(i, i) > least)) continue;
    R.row(i).tail(3 - i) = S.row(i).tail(3 - i) / std::sqrt(S(i, i));
    S -= R.row(i).transpose() * R.row(i);
  }
  return R;
}

/// Terms of e from the symmetric matrices P of a strain point, D^(1/2) applied.
std::vector<StrainRows::Term> terms_of(const StrainPoint& point, const Eigen::MatrixXd& half) {
  std::vector<StrainRows::Term> terms;
  const int slopes = static_cast<int>(point.G.rows()), strains = static_cast<int>(point.P.size());
  for (int p = 0; p < slopes; ++p)
    for (int q = p; q < slopes; ++q) {
      Eigen::VectorXd of_strains(strains);
      for (int s = 0; s < strains; ++s) of_strains[s] = point.P[s](p, q);
      if (of_strains.isZero(0)) continue;
      StrainRows::Term term{p, q, {}};
      Eigen::Map<Eigen::VectorXd>(term.C.data(), strains) = half * of_strains;
      terms.push_back(term);
    }
  return terms;
}

/// A node's own rotations by its dofs, in the axes of the pieces.
PieceRows::Spin spin_of(const Structure& structure, int node, int at) {
  const Eigen::Matrix3d own = spin_of(structure.mesh, node)->own();
  const FlatBody* flat = flat_body(structure);
  if (!flat) return {at, own};
  constexpr double round_off = 1e-14;
  Eigen::Matrix3d S = flat->axes.transpose() * own * flat->axes;
  if ((own.transpose() * flat->axes.col(2)).norm() < round_off) S.row(2).setZero();  // an axis in the plane
  return {at, S};
}

/// Adds a strain, or where none of it is of second order rows of bending.
/// @param measure  the weight, where the strain is of the membrane
void add_strain(const StrainPoint& point, double measure, bool linear_apart, PieceParts parts, PieceRows& piece) {
  const bool linear = linear_apart && point.G.rows() == 0;
  if (!(linear ? parts.bending : parts.strain)) return;
  const Eigen::MatrixXd half = std::sqrt(point.weight) * root(point.D);
  if (!linear) return piece.strain.push_back({half * point.L, point.G, measure, terms_of(point, half)});
  const Eigen::Index before = piece.bending.rows();
  piece.bending.conservativeResize(before + point.L.rows(), point.L.cols());
  piece.bending.bottomRows(point.L.rows()) = half * point.L;
}

/// The maps of a cell of one that is flat, in the plane's axes: what moves in the plane and what moves out of it have
/// nothing in common to the bit where the cell follows nobody.
ElementMaps in_plane(const FlatBody& flat, const Structure& structure, const Mesh::Cell& cell) {
  if (!cell.follows()) {
    std::vector<Eigen::Vector3d> x;
    for (const int node : cell.places()) x.push_back(flat.positions[node]);
    return quadratic_shell(x, std::get<ShellSection>(flat.sections[cell.part]));
  }
  ElementMaps maps = structure.maps(cell);
  const auto dofs = static_cast<Eigen::Index>(6 * cell.nodes().size());
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(dofs, dofs);
  for (Eigen::Index i = 0; i < dofs; i += 3) T.block<3, 3>(i, i) = flat.axes;
  maps = transformed(maps, T);
  for (body::MassPoint& point : maps.mass)
    point.x = flat.axes.transpose() * point.x, point.N = flat.axes.transpose() * point.N;
  for (body::RotatingMass& mass : maps.rotary) mass.rotate(flat.axes.transpose());
  return maps;
}

/// Mass points as samples; of a shell two of a pair, one below its centre of mass and one above, as sample and pair.
void add_masses(const std::vector<body::MassPoint>& points, bool pairs, std::vector<MassRows>& out) {
  for (std::size_t i = 0; i < points.size(); i += pairs ? 2 : 1) {
    const body::MassPoint &one = points[i], &two = points[pairs ? i + 1 : i];
    out.push_back({one.mass, false, Eigen::Vector3d::Zero(), {}});
    MassRows& sample = out.back();
    sample.N.setZero(3, one.N.cols());
    sample.N.topRows(one.N.rows()) = pairs ? Eigen::MatrixXd((one.N + two.N) / 2) : one.N;
    sample.x.head(one.x.size()) = pairs ? Eigen::VectorXd((one.x + two.x) / 2) : one.x;
    if (!pairs) continue;
    sample.mass = 2 * one.mass;
    out.push_back({2 * one.mass, true, Eigen::Vector3d((two.x - one.x) / 2), (two.N - one.N) / 2});
  }
}

/// Points, lines and shells of second order, from their maps.
void generic_piece(const Structure& structure, const Mesh::Cell& cell, PieceParts parts, PieceRows& piece) {
  const FlatBody* flat = mesh::is_shell(cell.kind) ? flat_body(structure) : nullptr;
  piece.nodes = 0;
  for (int node : cell.nodes()) piece.node[piece.nodes++] = node;
  for (int i = 0; i < static_cast<int>(cell.places().size()); ++i)
    if (cell.line[i] >= 0) piece.spins.push_back(spin_of(structure, cell.place[i], i));
  if (parts.bending || parts.strain || parts.mass) {
    const ElementMaps maps = flat ? in_plane(*flat, structure, cell) : structure.maps(cell);
    const bool shell = mesh::is_shell(cell.kind);
    if (parts.bending && !shell) piece.bending = root(maps.bending);
    for (std::size_t i = 0; i < maps.membrane.size(); ++i) {
      const bool measured = !shell || i < quadratic_membrane_points(cell.places().size());
      add_strain(maps.membrane[i], measured ? maps.membrane[i].weight : 0, shell, parts, piece);
    }
    const auto* section = std::get_if<ShellSection>(&structure.sections[cell.part]);
    if (parts.mass) add_masses(maps.mass, section && section->mass_radius > 0, piece.mass);
    for (const body::RotatingMass& mass : maps.rotary)
      if (parts.mass) piece.rotary.push_back({mass, mass.rotation});
  }
  if (!parts.line) return;
  std::vector<body::MassPoint> line = structure.line(cell);
  if (flat)
    for (body::MassPoint& point : line) {
      point.x = flat->axes.transpose() * point.x, point.N = flat->axes.transpose() * point.N;
      for (Eigen::Index i = 0; i < point.N.cols(); i += 3)
        point.N.middleCols<3>(i) = (point.N.middleCols<3>(i) * flat->axes).eval();
    }
  add_masses(line, false, piece.line);
}

/// Rows of a triple of deformations (shell::Deformation).
shell::Rows18 rows_of(const shell::Geometry& g, const shell::Deformations& d, double share, int k) {
  return (std::sqrt(share * g.area) * root3(d.stiffness[k])).lazyProduct(d.rows.middleRows<3>(3 * k));
}

/// Adds what rotations of the corners do at second order.
void add_rotations(const shell::Geometry& g, Strains strains, StrainRows& rows) {
  shell::add_rotations(g, strains, rows.L, rows.G, [&](int p, int q, const Eigen::Vector3d& C) {
    rows.terms.push_back({p, q, {C[0], C[1], C[2]}});
  });
}

void strain(const shell::Geometry& g, const shell::Deformations& d, const ShellSection& section, double share,
            std::vector<StrainRows>& out) {
  out.emplace_back();
  StrainRows& rows = out.back();
  rows.weight = share * g.area;
  const Eigen::Matrix3d half = std::sqrt(rows.weight) * root3(section.A);
  rows.L = half.lazyProduct(d.rows.middleRows<3>(3 * shell::mean_strain));
  const int gradients = shell::gradient_rows(section);
  rows.G.resize(gradients, 18);
  rows.G.setZero();
  shell::set_gradients(g, section, rows.G);
  for (int x = 0; x < gradients; x += 2) {
    rows.terms.push_back({x, x, {half(0, 0), half(1, 0), half(2, 0)}});
    rows.terms.push_back({x, x + 1, {half(0, 2), half(1, 2), half(2, 2)}});
    rows.terms.push_back({x + 1, x + 1, {half(0, 1), half(1, 1), half(2, 1)}});
  }
}

void samples(const shell::Geometry& g, const Eigen::Vector3d& centroid, const ShellSection& section, double share,
             PieceParts parts, PieceRows& piece) {
  const double third = share * g.area / 3, z = section.mass_centre, r = section.mass_radius;
  for (int k = 0; k < 3; ++k) {
    const shell::Middle middle = shell::middle(g, k);
    const Eigen::Vector3d at(middle.at.x(), middle.at.y(), 0);
    shell::Rows18 N = middle.rows.topRows<3>(), rotation = shell::Rows18::Zero();
    rotation.topRows<2>() = middle.rows.bottomRows<2>();
    N = g.axes.lazyProduct(N).eval(), rotation = g.axes.lazyProduct(rotation).eval();
    if (parts.line) piece.line.push_back({third, false, centroid + g.axes * at, N});
    if (!parts.mass) continue;
    const Eigen::Vector3d normal = g.axes.col(2);
    shell::Rows18 centre = N;
    centre += g.axes.leftCols<2>().lazyProduct(z * middle.arms);
    piece.mass.push_back({section.mass * third, false, centroid + g.axes * at + z * normal, centre});
    if (r > 0) piece.mass.push_back({section.mass * third, true, r * normal, r * rotation});
  }
}

/// @param normals  of the surface at the corners
void triangle_piece(const Structure& structure, const std::array<int, 3>& nodes, const shell::Normals& normals,
                    double share, const Mesh::Cell& cell, PieceParts parts, PieceRows& piece) {
  std::copy(nodes.begin(), nodes.end(), piece.node.begin());
  piece.nodes = 3;
  const FlatBody* flat = flat_body(structure);
  const ShellSection section =
      on_curved_surface(std::get<ShellSection>((flat ? flat->sections : structure.sections)[cell.part]), cell.rise);
  const auto& at = flat ? flat->positions : structure.mesh.positions;
  const shell::Geometry g = shell::geometry({at[nodes[0]], at[nodes[1]], at[nodes[2]]}, section.axis, normals);
  if (parts.bending || parts.strain) {
    const shell::Deformations d = shell::deformations(g, section);
    if (parts.strain) strain(g, d, section, share, piece.strain);
    for (const int k : {shell::mean_curvature, shell::edge_bending, shell::drilling}) {
      const bool squared = k == shell::drilling || section.strains == Strains::second_order;
      if (squared && parts.strain) piece.strain.push_back({rows_of(g, d, share, k), SmallRows(0, 18), 0, {}});
      if (squared || !parts.bending) continue;
      piece.bending.conservativeResize(piece.bending.rows() + 3, 18);
      piece.bending.bottomRows(3) = rows_of(g, d, share, k);
    }
    for (StrainRows& rows : piece.strain) add_rotations(g, section.strains, rows);
  }
  if (parts.mass || parts.line)
    samples(g, (at[nodes[0]] + at[nodes[1]] + at[nodes[2]]) / 3, section, share, parts, piece);
}

/// Calls with all rows of a piece.
template <class Act>
void each_rows(PieceRows& piece, Act&& act) {
  if (piece.bending.size() > 0) act(piece.bending);
  for (StrainRows& point : piece.strain) act(point.L), act(point.G);
  for (auto* samples : {&piece.mass, &piece.line})
    for (MassRows& sample : *samples) act(sample.N);
  for (RotaryRows& mass : piece.rotary) act(mass.rotation);
}

/// Where the piece has the node, with all its dofs; it is added where it has not.
int place_of(int node, PieceRows& piece) {
  const auto rotations = [&](int at) {
    return std::any_of(piece.spins.begin(), piece.spins.end(), [&](const auto& spin) { return spin.at == at; });
  };
  for (int at = 0; at < piece.nodes; ++at)
    if (piece.node[at] == node && !rotations(at)) return at;
  piece.node[piece.nodes++] = node;
  each_rows(piece, [&](auto& rows) {
    const Eigen::Index before = rows.cols();
    rows.conservativeResize(Eigen::NoChange, 6 * piece.nodes);
    rows.rightCols(rows.cols() - before).setZero();
  });
  return piece.nodes - 1;
}

/// Adds the second-order motion of the mass that corner `at` moves.
void rotate_mass(const Eigen::Vector3d& arm, int at, int led, PieceRows& piece) {
  body::RotatingForms forms;
  for (const MassRows& sample : piece.mass) {
    body::RotatingForms of;
    of.add(sample.mass, sample.x, sample.N.middleCols<3>(6 * at), arm);
    for (int a = 0; a < 3; ++a) {
      if (!sample.pair) forms.first[a] += of.first[a];
      for (int b = 0; b < 3; ++b) forms.moments[a][b] += of.moments[a][b];
    }
  }
  if (forms.empty()) return;
  piece.rotary.push_back({forms, {}});
  piece.rotary.back().rotation.setZero(3, 6 * piece.nodes);
  piece.rotary.back().rotation.middleCols<3>(6 * led + 3).setIdentity();
}

/// Adds the second-order motion of corner `at`, 1/2 theta x (theta x arm), to mass and strains: before its rows are
/// those of the node that it follows.
/// @param led      the node with theta among the piece's
/// @param strains  projects the rotations that count in strains
void rotate_arm(const Eigen::Vector3d& arm, int at, int led, const Eigen::Matrix3d& strains, PieceRows& piece) {
  if (arm.isZero(0)) return;
  rotate_mass(arm, at, led, piece);
  for (StrainRows& point : piece.strain) {
    const Eigen::Index first = point.G.rows(), rows = point.L.rows();
    std::array<Eigen::Matrix3d, 3> P;
    bool any = false;
    for (Eigen::Index s = 0; s < rows; ++s) {
      P[s] = strains * math::arm_form(point.L.row(s).segment<3>(6 * at).transpose(), arm) * strains;
      any = any || !P[s].isZero(0);
    }
    if (!any) continue;
    point.G.conservativeResize(first + 3, Eigen::NoChange);
    point.G.bottomRows(3).setZero();
    point.G.block<3, 3>(first, 6 * led + 3).setIdentity();
    for (int p = 0; p < 3; ++p)
      for (int q = p; q < 3; ++q) {
        StrainRows::Term term{static_cast<int>(first) + p, static_cast<int>(first) + q, {}};
        for (Eigen::Index s = 0; s < rows; ++s) term.C[s] = P[s](p, q);
        point.terms.push_back(term);
      }
  }
}

/// Corner `at` of the piece as a node with rotations of its own.
void spin_about(const Eigen::Vector3d& arm, int independent_node, PieceRows::Spin spin, const Eigen::Matrix3d& strains,
                PieceRows& piece) {
  piece.spins.push_back(spin);
  const int led = place_of(independent_node, piece);
  rotate_arm(arm, spin.at, led, strains, piece);
  const Eigen::Matrix<double, 6, 6> T = spin_arm(arm, spin.own);
  each_rows(piece, [&](auto& rows) {
    const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> own = rows.template middleCols<6>(6 * spin.at);
    rows.template middleCols<6>(6 * led) += own * T;
    rows.template middleCols<3>(6 * spin.at).setZero();
    rows.template middleCols<3>(6 * spin.at + 3) = own.template rightCols<3>() * spin.own;
  });
}

bool is_second_order(const Structure& structure, const Mesh::Cell& cell) {
  const auto* shell = std::get_if<ShellSection>(&structure.sections[cell.part]);
  return shell && shell->strains == Strains::second_order;
}

/// The piece on the dofs of the nodes that move its corners.
/// @param of  its corners among the cell's
void follow(const Structure& structure, const Mesh::Cell& cell, const std::array<int, 3>& of, PieceRows& piece) {
  const FlatBody* flat = flat_body(structure);
  const auto& at = flat ? flat->positions : structure.mesh.positions;
  const Eigen::Matrix3d strains =
      is_second_order(structure, cell) ? Eigen::Matrix3d::Identity() : slopes_of_arms(cell, at);
  for (int i = 0; i < 3; ++i) {
    const int moved = cell.moved[of[i]];
    if (moved == piece.node[i]) continue;
    const Eigen::Vector3d arm = at[piece.node[i]] - at[moved];
    rotate_arm(arm, i, i, strains, piece);
    const Eigen::Matrix<double, 6, 6> T = rigid_arm(arm);
    each_rows(piece, [&](auto& rows) {
      rows.template middleCols<6>(6 * i) = (rows.template middleCols<6>(6 * i) * T).eval();
    });
    piece.node[i] = moved;
  }
  for (int i = 0; i < 3; ++i) {
    if (cell.line[of[i]] < 0) continue;
    const int node = cell.place[of[i]], independent_node = cell.moved[cell.line[of[i]]];
    spin_about(at[node] - at[independent_node], independent_node, spin_of(structure, node, i), strains, piece);
  }
}

}  // namespace

void piece_rows(const Structure& structure, const Mesh::Cell& cell, PieceParts parts, std::vector<PieceRows>& pieces) {
  pieces.resize(cell.kind == CellKind::quadrilateral ? 4 : 1);
  for (PieceRows& piece : pieces)
    piece.bending.resize(0, 0), piece.strain.clear(), piece.mass.clear(), piece.rotary.clear(), piece.line.clear(),
        piece.spins.clear();
  if (parts.strain && is_second_order(structure, cell)) parts.bending = true;
  const auto& c = cell.place;
  if (cell.kind == CellKind::triangle) {
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    triangle_piece(structure, {c[0], c[1], c[2]}, {none, none, none}, 1, cell, parts, pieces[0]);
  } else if (cell.kind == CellKind::quadrilateral) {
    const FlatBody* flat = flat_body(structure);
    const auto& at = flat ? flat->positions : structure.mesh.positions;
    for (int k = 0; k < 4; ++k) {
      const auto& of = quadrilateral_triangles[k];
      const shell::Normals normals = shell::corner_normals({at[c[0]], at[c[1]], at[c[2]], at[c[3]]}, k);
      triangle_piece(structure, {c[of[0]], c[of[1]], c[of[2]]}, normals, 0.5, cell, parts, pieces[k]);
    }
  } else {
    generic_piece(structure, cell, parts, pieces[0]);
  }
  if (!cell.follows() || !mesh::is_shell(cell.kind) || mesh::is_quadratic(cell.kind)) return;
  if (cell.kind == CellKind::triangle) return follow(structure, cell, {0, 1, 2}, pieces[0]);
  for (int k = 0; k < 4; ++k) follow(structure, cell, quadrilateral_triangles[k], pieces[k]);
}

}  // namespace floe::fem
