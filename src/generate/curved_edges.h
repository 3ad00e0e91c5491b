#pragma once
#include <optional>

#include "floe/generate/generate.h"
#include "floe/mesh/facet.h"

namespace floe::generate {

/// Curves between the nodes of flat shells (triangle, quadrilateral), on the surfaces whose polyhedra these are.
///
/// The arc through a and b that makes the angle phi_a with the chord d = b - a at a rises over the chord's middle by
///
///   h_a = |d| / 2 tan(phi_a / 2)
///
/// and from b by h_b; an edge by their harmonic mean 2 h_a h_b / (h_a + h_b): exact on circles, and 0 where the surface
/// is flat at an end (h_a h_b <= 0), so that flat walls remain flat beside a curved one.
///
/// The surface of an element at a node are the elements there to which it goes on from edge to edge, within 42 degrees
/// of it, on the other side of each edge: skins remain curved where webs meet them, folds and sharp edges are sharp.
/// Edges within it rise along its normal. The mean normal N_a of these elements (surface_normal) is the surface's at
/// the mean c of their middles; along the direction e in which the surface bends at the other end (N_b against the
/// element's normal; d where N_b is that, or does not bend along d),
///
///   sin phi_a = -d.N_a / |d| / k_a,   k_a = 1 - 2 (c - a).e / d.e
///
/// k is 1 where elements are alike around a node (3/4 to 4/3 count as 1), and small where they end across e. An end
/// with k < 1/2 has no phi, and the other end's h is taken; where neither has one, h is that of the middle of the
/// quadrilateral that two triangles form at the edge; at other elements the harmonic mean of both for k = 1. Along a
/// rim phi_a is that of the circle through a and the nodes beside it; corners of 42 degrees or more have none. Rims of
/// one element are arcs in their surface, too, by at most a quarter of its width, so that no element folds.
class CurvedEdges {
 public:
  /// @param whole  on every rank; must outlive this
  explicit CurvedEdges(const RawMesh& whole);

  /// From (a + b) / 2 to the middle of the curve [m]: the least vector that rises so over each of the edge's elements,
  /// over those of one surface on average. Rank-local.
  Eigen::Vector3d offset(PetscInt a, PetscInt b) const { return offset(a, b, true); }

 private:
  struct Corner {
    PetscInt cell;
    FacetCorner facet;
  };
  std::array<PetscInt, 2> beside(PetscInt cell, PetscInt node) const;
  FacetCorner facet(PetscInt cell, PetscInt node) const;
  bool go_on(PetscInt cell, PetscInt other, PetscInt node, PetscInt end) const;
  std::vector<Corner> surface(PetscInt cell, PetscInt node) const;
  double width(PetscInt cell, PetscInt a, PetscInt b) const;
  Eigen::Vector3d middle(PetscInt cell) const;
  Eigen::Vector3d from(PetscInt a, PetscInt b) const { return whole_.positions[b] - whole_.positions[a]; }

  struct Normal {
    Eigen::Vector3d axis, at;  ///< on the element's side; c from the node
  };
  Normal normal(PetscInt cell, PetscInt node) const;
  std::optional<Eigen::Vector3d> tangent_of_rim(PetscInt cell, PetscInt node, PetscInt other) const;
  double rise_of_rim(PetscInt cell, PetscInt a, PetscInt b, const Eigen::Vector3d& axis) const;
  double rise_inside(const std::vector<PetscInt>& shells, PetscInt cell, PetscInt a, PetscInt b, bool diagonals) const;
  std::optional<double> rise_of_diagonal(const std::vector<PetscInt>& shells, PetscInt cell, PetscInt a,
                                         PetscInt b) const;
  Eigen::Vector3d offset(PetscInt a, PetscInt b, bool diagonals) const;

  const RawMesh& whole_;
  std::vector<std::vector<PetscInt>> at_;  // flat shells at each node
};

}  // namespace floe::generate
