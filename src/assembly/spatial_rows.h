#pragma once
#include <array>
#include <functional>
#include <map>

#include "floe/assembly/model.h"
#include "floe/dynamics/constraint_rows.h"
#include "floe/dynamics/spatial_joint.h"

namespace floe::assembly {

/// The constraint rows of a scene in space at its start, and which of them say something that the others do not.
///
/// A row is left out if its gradient depends on those of the rows before it, and if it stays met when the bodies deform
/// and move as these allow. Rank-local.
class SpatialRows {
 public:
  /// @param start  local coordinates at the start
  SpatialRows(const Plan& plan, const Eigen::VectorXd& start) : plan_(plan), all_(start) {}
  void add(int joint, const std::array<dynamics::SpatialMarker, 2>& places,
           const dynamics::SpatialConstraint& constraint);
  /// Of each joint added, the rows that stand.
  /// @param notes  a line for each joint that loses rows
  /// @param undetermined  receives the joints whose multipliers the rows do not determine
  /// @throws InputError  a row that depends on others is not met: joints contradict one another
  std::vector<std::vector<int>> independent(std::string& notes, std::vector<int>& undetermined) const;

 private:
  /// A frame's six coordinates among those seen; directions of change rotate it about the first place that joints have
  /// on it, so that places far away from the frame have gradients of a common size: dR = about dx.
  struct Frame {
    std::array<Eigen::Index, 6> at;
    Eigen::Matrix3d about;
  };
  /// C and its gradient with scaled coordinates; rotations count in radians, lengths in parts of the extent.
  int seen(int coordinate);
  /// Of each coordinate: for frames the extent and a radian; else what moves a place by a hundredth of these; 0 where
  /// columns move places by round-off alone.
  Eigen::VectorXd scales() const;
  /// Changes of the coordinates of which gradients count the amounts, as columns.
  Eigen::MatrixXd directions() const;
  Eigen::VectorXd values(const Eigen::VectorXd& q, double t, Eigen::MatrixXd* gradient) const;
  Eigen::VectorXd allowed(const Eigen::VectorXd& q, double t, const std::vector<Eigen::Index>& kept) const;
  void check_left_out(const std::vector<Eigen::Index>& kept) const;
  void follow_drives(const Eigen::VectorXd& start, double end, const std::vector<Eigen::Index>& kept,
                     const std::function<void(Eigen::Index, const std::string&)>& complain) const;
  int joint_of(Eigen::Index row) const { return joints_[rows_.term_of(row)]; }

  const Plan& plan_;
  const Eigen::VectorXd& all_;  // coordinates at the start
  // Of each coordinate that a joint sees:
  std::map<int, int> number_;          // by its local index
  std::vector<double> start_, reach_;  // a unit moves one of the places by so many extents and radians at most
  double greatest_reach_ = 0;          // of elastic coordinates
  std::vector<char> moves_;            // of a frame; others are elastic
  std::vector<double> unit_;           // of each row
  dynamics::ConstraintRows rows_;      // over these coordinates
  std::vector<int> joints_, counts_;   // of each of their terms
  std::map<int, Frame> frames_;        // by the local index of R
};

}  // namespace floe::assembly
