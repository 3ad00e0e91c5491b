#pragma once
#include <array>
#include <vector>

#include "floe/fem/structure.h"

namespace floe::fem {

/// Rows on the dofs of a piece, in the order of its nodes.
using SmallRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
inline constexpr int most_strains = 10;  ///< of a point

/// A strain point with its weight and stiffness in the rows: U = 1/2 |eps|^2, eps(q) = L q + 1/2 e(q, q),
///
///   e_r(a, b) = sum_p C_r,pp a_p b_p + sum_(p<q) C_r,pq (a_p b_q + a_q b_p),   a_p = (G a)_p
struct StrainRows {
  SmallRows L;  ///< s x dofs
  SmallRows G;  ///< g x dofs
  double
      weight;  ///< that the rows of L hold the root of [m], [m2]; 0: not of a membrane, the body's measure is without
  /// A product of two slopes in the strain: C of slopes p and q.
  struct Term {
    int p, q;  ///< p <= q
    std::array<double, most_strains> C;
  };
  std::vector<Term> terms;  ///< C, of each row
};

/// A sample of mass: displacement N q at x; as body::MassPoint, or a pair of opposite halves about another sample, at x
/// and -x from it and moving by N q and -N q besides: that one counts in second moments only.
struct MassRows {
  double mass;
  bool pair;
  Eigen::Vector3d x;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> N;
};

/// Mass that moves to second order, as body::RotatingMass.
struct RotaryRows : body::RotatingForms {
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> rotation;
};

/// An element or, of a quadrilateral, one of its triangles: what products of many columns are made of.
struct PieceRows {
  std::array<int, 2 * mesh::most_nodes>
      node{};  ///< local: its nodes, or what moves them; then independent nodes of line hinges
  int nodes = 0;
  /// Nodes with rotations of their own (Mesh::Spin): theta = own dofs besides that of the independent node, nothing
  /// else of them counts.
  struct Spin {
    int at;  ///< among the piece's
    Eigen::Matrix3d own;
  };
  std::vector<Spin> spins;
  SmallRows bending;  ///< U_b = 1/2 |bending q|^2; none with strains of second order: they are strains then
  std::vector<StrainRows> strain;
  std::vector<MassRows> mass;
  std::vector<RotaryRows> rotary;  ///< made with mass
  std::vector<MassRows> line;      ///< Structure::line
};

/// Which of them to make.
struct PieceParts {
  bool bending = false, strain = false, mass = false, line = false;
};

/// The pieces of a cell, in the plane's axes where the body is flat (flat_body), whose energies and inertia constants
/// add up to those of Structure::maps.
/// @param pieces  receives them; its memory is used again
void piece_rows(const Structure& structure, const Mesh::Cell& cell, PieceParts parts, std::vector<PieceRows>& pieces);

}  // namespace floe::fem
