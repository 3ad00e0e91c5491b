#pragma once
#include <vector>

#include "floe/dynamics/system.h"

namespace floe::solve {
using namespace dynamics;

/// A frame as a rigid body with the mass that moves with it.
struct FrameInertia {
  int first = 0,
      rotations = 0;  ///< local index of the origin's coordinates, and of the angles or the attitude after them
  double radius = 0;  ///< of gyration about the mass centre [m]
  Eigen::MatrixXd centre_shift;  ///< what the mass centre moves by as the frame rotates about its origin [m/rad]
};

/// Of the frames that this rank owns, from M, which is assembled into J. Collective.
std::vector<FrameInertia> frame_inertias(const System& system, double t, Vec U, Vec V, Mat J);

/// |U|, and where frames could be: rotated by 1 rad and moved by their radii. Where joints meet and springs end is
/// known to eps of that. Collective.
petsc::VecHandle sizes_of_places(const System& system, const std::vector<FrameInertia>& frames, Vec U);

/// How far a step d of a configuration U goes, in plain units, the greatest of
///  - rotations of frames, attitudes and nodes in world axes [rad],
///  - moves of the mass centres of frames over their radii of gyration, or over what the search moved them by, and
///  - |d| / |U| in the norm of |J_ii| (share_of), which deformations enter; nothing where d is no more than what 64 eps
///    of the places of frames make of it, as in a configuration without load.
/// Where a mesh lies far from its frame's origin all of its stiffnesses are beside that of the arm in the last norm,
/// and so are soft springs beside stiff ones: it alone does not tell.
/// @param before  the search began there;  @param solver  of J. Collective: one solve where d is not short.
double plain_size(const System& system, const std::vector<FrameInertia>& frames, KSP solver, Mat J, Vec d, Vec U,
                  Vec before);

/// By what factor errors of a tangent feed themselves in Newton's steps: an estimate of the spectral radius of J^-1 E,
/// E what a step changes the tangent by (from J to `next`) and 64 eps |J| of round-off, with signs that change.
///
/// Where it is small, the step tells how far the equilibrium is. At one J says nothing in some direction: there it is
/// round-off, whose inverse is chance, or stiffness of forces that the step takes away. No scaling of rows or columns
/// enters. Power iteration, four solves. Source: Rump 2003, BIT 43 (singular matrices within componentwise errors).
///
/// @param solver  of J. Collective.
double gain_of_errors(const System& system, KSP solver, Mat J, Mat next);

}  // namespace floe::solve
