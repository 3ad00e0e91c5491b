#pragma once
#include "floe/fem/assembly.h"

namespace floe::fem {

/// Where the floating frame sits on a body: r conditions (3 in the plane, 6 in space) that make the elastic
/// displacement unique.
///
///   pinned     u_a = v_a = 0, v_b = 0: origin at node a, x axis through node b (both on the x axis of the mesh);
///              in space also w_a = w_b = 0 and no rotation of a about x
///   clamped    u_a = 0, rotation_a = 0: origin and axes at node a
///   mean_axis  Phi_r' M q = 0: q is M-orthogonal to the rigid motions (Tisserand, Buckens)
///
/// As functionals c(q) = f' q (r) with rigid motions Phi_r: the projector P = 1 - Phi_r (f' Phi_r)^-1 f' takes any
/// displacement to the frame (it subtracts the rigid motion), its transpose takes any load to a self-equilibrated one.
struct ReferenceFrame {
  enum class Kind { pinned, clamped, mean_axis } kind = Kind::pinned;
  Conditions conditions;                      ///< dofs at zero; none for mean_axis
  std::vector<petsc::VecHandle> rigid;        ///< Phi_r
  std::vector<petsc::VecHandle> functionals;  ///< f
  Eigen::MatrixXd inverse;                    ///< (f' Phi_r)^-1, r x r
};

/// @param a, b  global nodes (b: pinned only). @throws InputError if the conditions leave a rigid motion free.
/// Collective.
ReferenceFrame reference_frame(const Structure& structure, ReferenceFrame::Kind kind, PetscInt a, PetscInt b);

/// q <- P q. Collective.
void to_frame(const ReferenceFrame& frame, Vec q);
/// f <- P' f. Collective.
void balance(const ReferenceFrame& frame, Vec f);

/// How a body is constrained by its joints to the ground, seen in the linear displacements of the body in space.
struct Holding {
  Conditions constrained;  ///< dofs that joints hold
  Conditions
      statics;  ///< constrained, and frame conditions besides until no rigid motion is left: K is regular under these
  Eigen::MatrixXd left;  ///< rigid motions that the joints leave free, as combinations of ReferenceFrame::rigid
};

/// @param constrained  dofs that the joints hold, global, ascending. Collective.
Holding holding(const Structure& structure, const ReferenceFrame& frame, Conditions constrained);

}  // namespace floe::fem
