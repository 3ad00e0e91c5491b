#pragma once
#include <memory>
#include <optional>

#include "floe/dynamics/moving_axes.h"
#include "floe/dynamics/term.h"

namespace floe::dynamics {

/// Mass-proportional damping of inertia on its motion relative to axes f, or to the ground without them:
///
///   D = alpha/2 (v - Phi s)' M(q) (v - Phi s),   s = (R_f', omega_f),   forces alpha M (v - Phi s), -alpha Phi' M (v -
///   Phi s)
///
/// Phi(q) s is the rigid motion of all coordinates with f; elastic coordinates have none of it. M comes from a term of
/// inertia: its rows at v = 0 and a = v - Phi s. Twice D is the power dissipated; a rigid motion together with f has
/// none, and the forces have no resultant. Tangents are exact.
class RelativeDamping final : public Term {
 public:
  /// @param inertia  rows M(q) a where v = 0, and nothing else there
  /// @param moving   of its coordinates: which are positions and rotations
  /// @param alpha    [1/s]
  RelativeDamping(std::unique_ptr<const Term> inertia, std::vector<MovingAxes> moving, std::optional<MovingAxes> f,
                  double alpha);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;

 private:
  Eigen::VectorXd relative(const Motion& motion) const;

  std::unique_ptr<const Term> inertia_;
  std::vector<MovingAxes> moving_;
  std::optional<MovingAxes> f_;
  double alpha_;
  std::vector<int> coordinates_;
};

/// Conditions that say how axes f accompany other axes (R, A) and their elastic coordinates e: each row
///
///   c = b'A_f'(R - R_f) + sum_ij B_ij (A_f'A)_ij - c_0,   B = B_0 + sum_k B_k e_k
///
/// Mean axes of masses are of this form, and places that f holds to (their rotation by the skew part of A_f'A). Several
/// terms add to the same rows; c_0 makes a term's share zero at one configuration.
class AccompanyingAxes final : public Term {
 public:
  struct Row {
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    Eigen::MatrixXd B;  ///< 9 x (1 + k): the columns of B_0, B_1, ... below one another
    Row& operator+=(const Row& other);
    Row operator*(double factor) const;
  };
  /// @param elastic      local indices of e
  /// @param multipliers  local index of the first, one for each row
  AccompanyingAxes(const MovingAxes& axes, std::vector<int> elastic, const MovingAxes& f, int multipliers,
                   std::vector<Row> rows);
  const std::vector<int>& coordinates() const override { return coordinates_; }
  void residual(const Motion& motion, Eigen::VectorXd& r) const override;
  void tangent(const Motion& motion, Weights weights, Eigen::MatrixXd& J) const override;
  /// c_0 from the term's own coordinates.
  void begin_at(const Eigen::VectorXd& q);
  /// c_0 where f is at the origin, unrotated, with R and A as given and e = 0.
  void begin_at(const Eigen::Vector3d& R, const Eigen::Matrix3d& A);
  int rows() const { return static_cast<int>(rows_.size()); }

 private:
  MovingAxes axes_, f_;
  int elastic_;
  std::vector<Row> rows_;
  Eigen::VectorXd start_;
  std::vector<int> coordinates_;
};

}  // namespace floe::dynamics
