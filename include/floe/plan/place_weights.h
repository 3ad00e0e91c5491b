#pragma once
#include <optional>

#include "floe/reduction/place_set.h"

namespace floe::plan {

/// Length of the edges or area of the shells of a place.
struct PlaceMeasure {
  enum class Of { points, edges, areas } of = Of::points;
  double size = 0;  ///< [m], [m2]
};

/// Weights of the nodes in the mean of a place, and shares of them in a force there.
///
/// A force spread evenly over an edge or an area does the work f . int u ds / int ds, and as much as shares of it at
/// the nodes do, f . sum (w_i u_i + B_i theta_i):
///
///   area    every node is a corner of shell elements whose corners all belong to the place: thirds of their triangles
///           (a quadrilateral: the mean of both divisions into two)
///   edge    every node is an end of element edges between nodes of the place (edges of shells, beams): halves of their
///           lengths l, and B theta = l^2 / 12 A (theta x s), s towards the other end: the displacement across an edge
///           is cubic (Hermite, DKT; A = 1), in the plane of a shell quadratic (A = alpha of its section there, the
///           lumping of the OPT membrane: 3/2 on a flat surface). Interior edges of elements that belong to the place
///           as a whole do not count
///   points  else: equal weights
///
/// Hence sum w_i x_i is the centroid of the edge or area however its elements are graded, and even tension is exact.
///
/// Rotations are set by set_rotation().
///
/// @param nodes    global, without repetition, the same on all ranks
/// @param measure  receives what was found, if it is asked for
/// @return       in their order, the same on all ranks. Collective. Source: Felippa 2003 (alpha).
std::vector<reduction::WeightedNode> place_weights(const fem::Structure& structure, const std::vector<PetscInt>& nodes,
                                                   PlaceMeasure* measure = nullptr);

/// Those that a file gives, over their sum, or place_weights(). With given weights (RBE3) the place rotates by
/// displacements wherever its nodes are not on one line. Collective.
std::vector<reduction::WeightedNode> weights_of(const fem::Structure& structure, const mesh::NodeSet& place);

/// Which motion of its nodes the rotation of a place is, theta of set_rotation() or one made of it.
enum class RotationBy {
  nearest_motion,  ///< theta; without shells sum w_i theta_i
  displacements,   ///< RBE3: theta without shells, too, with B_i = 0 there
  shares  ///< of moments per length or area: each node by itself as far as it bends shells, the place as one about
          ///< normals; of flat ones (1 - n n') sum w_i theta_i + n n' theta
};

/// How the place rotates, `turn` and `twist`: as the rigid motion that is nearest to its nodes,
///
///   J theta = sum w_i (r_i x u_i + B_i theta_i),   J = sum w_i (r_i^2 1 - r_i r_i' + B_i),   r from the mean,
///
/// B_i = h^2/12 (1 - n n'), the mean over the shells at the node of thickness h and normal n: rotations that bend them
/// count as displacements at the radius of inertia of the section; drilling rotations, which follow the shells by a
/// small stiffness only, do not count. Along a straight edge it rotates by bending rotations, else by displacements.
/// Exact for rigid motions, to first order. Collective.
/// @param weights  their sum is 1
void set_rotation(const fem::Structure& structure, std::vector<reduction::WeightedNode>& weights,
                  RotationBy by = RotationBy::nearest_motion);

/// The normal that all elements at these nodes have, in the frame's axes: flat shells and nothing else; none: they have
/// not one. Collective.
std::optional<Eigen::Vector3d> common_normal(const fem::Structure& structure, const std::vector<PetscInt>& nodes);

/// Integrals of a shape, given at the nodes, over the edges or areas of a place: shares of a load of this density per
/// length or area, int N_i s. Not normalised; of either sign. Collective.
std::vector<reduction::WeightedNode> shaped_weights(const fem::Structure& structure, const std::vector<PetscInt>& nodes,
                                                    PlaceMeasure::Of of, const std::vector<double>& shape);

}  // namespace floe::plan
