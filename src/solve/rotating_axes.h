#pragma once
#include "floe/solve/steady_rotation.h"
#include "gather_to_all.h"

namespace floe::solve {

/// A frame in space.
struct WorldFrame {
  Eigen::Index x;  ///< global index of the first of its three rotations; that of its place is three less
  Eigen::Quaterniond base;
};
/// Frames of all ranks, each once, in the order of their indices: frames at nodes of corotational bodies are
/// not present on every rank. Collective.
std::vector<WorldFrame> world_frames(const System& system);

/// What the rotation prescribes at a configuration whose attitudes are their own bases, by global index.
struct RotatingMotion {
  Eigen::VectorXd V, A;
  Sparse V_U, A_U, H;  ///< derivatives; see vibrations()
};
RotatingMotion rotating_motion(const RotatingSystem& rotating, double speed, const Eigen::VectorXd& U);

/// The matrices of small motions about a rotation, all by global index, the same on every rank.
struct RotatingTangent {
  Eigen::VectorXd F;  ///< residual
  Sparse M, C, K;     ///< without what does not depend on time scales:
  Sparse G;  ///< gradients of constraints in the multipliers' rows, their transposes, dofs that are constrained
};
/// Bases take over the rotations of U first. Collective.
RotatingTangent rotating_tangent(const RotatingSystem& rotating, double speed, Vec U);

/// Of each unknown, by global index: whether it is a multiplier. The same on every rank.
std::vector<char> multiplier_flags(const System& system);

/// sqrt(M_ii) of coordinates that have mass, else 0; and the greatest of a frame's rotation by one radian (1 if none).
struct MassScale {
  Eigen::VectorXd root;
  double rotation = 1;
};
MassScale mass_scale(const RotatingSystem& rotating, const Sparse& M);

/// A configuration to come back to.
class KeptState {
 public:
  KeptState(const System& system, Vec U);
  void restore(Vec U) const;
  /// From here to U, whose attitudes are their own bases: their rotations as rotation vectors.
  Eigen::VectorXd change_to(Vec U) const;

 private:
  const System& system_;
  petsc::VecHandle U_;
  std::vector<Eigen::Quaterniond> bases_;  // of the frames on this rank
  std::vector<WorldFrame> frames_;
};

/// The whole scene rotated about the axis; bases take over the rotations of U. Collective.
void rotate(const RotatingSystem& rotating, double angle, Vec U);
/// The matrix that rotates the rows of a vector that are in world axes, those of R, likewise.
Sparse row_rotation(const RotatingSystem& rotating, double angle);

}  // namespace floe::solve
