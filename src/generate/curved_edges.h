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
/// The surface of an element at a node are the elements there within 42 degrees of it: skins remain curved where webs
/// meet them, and folds are sharp. Edges within it rise along its normal: sin phi_a = -d.N / |d| with the mean normal N
/// of these elements (surface_normal), which is the surface's at the mean c of their middles, at x = (c - a).d / |d|^2
/// of the chord. At rims and folds x is not 0, and 1 - 2 x less than 1: where less than 1/3 the other end's h is taken
/// (edges across), where less than 0.8 the middle of the quadrilateral that the triangles form (diagonals). Along a rim
/// phi_a is that of the circle through a and the nodes beside it, along the normal and in the surface; corners of 42
/// degrees or more have none, the other end's is taken.
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
  std::vector<Corner> surface(PetscInt cell, PetscInt node) const;
  Eigen::Vector3d middle(PetscInt cell) const;
  Eigen::Vector3d from(PetscInt a, PetscInt b) const { return whole_.positions[b] - whole_.positions[a]; }

  struct Slope {
    double sine = 0, known = 0;  ///< sin phi at an end, and 1 - 2 x
  };
  Slope slope(PetscInt cell, PetscInt node, PetscInt other) const;
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
