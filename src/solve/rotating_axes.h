#pragma once
#include <Eigen/Dense>

#include "floe/solve/steady_rotation.h"

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
  /// A block of a matrix that has few: its rows and columns are those of three or two unknowns.
  struct Block {
    Eigen::Index row, column;
    Eigen::MatrixXd values;
  };
  using Blocks = std::vector<Block>;

  Eigen::VectorXd V, A;
  Blocks V_U, A_U, H;  ///< derivatives; see vibrations()
};
RotatingMotion rotating_motion(const RotatingSystem& rotating, double speed, const Eigen::VectorXd& U);

/// X += Y B.
void add_product(const Eigen::MatrixXd& Y, const RotatingMotion::Blocks& B, Eigen::MatrixXd& X);

/// The matrices of small motions about a rotation, all by global index, the same on every rank.
struct RotatingTangent {
  Eigen::VectorXd F;        ///< residual
  Eigen::MatrixXd M, C, K;  ///< without what does not depend on time scales:
  Eigen::MatrixXd
      G;  ///< gradients of constraints in the multipliers' rows, their transposes, dofs that are constrained
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
MassScale mass_scale(const RotatingSystem& rotating, const Eigen::MatrixXd& M);

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
/// Rows of a vector (or of the columns of a matrix) that are in world axes, those of R, rotated likewise.
void rotation_rows(const RotatingSystem& rotating, double angle, Eigen::Ref<Eigen::MatrixXd> rows);

}  // namespace floe::solve
