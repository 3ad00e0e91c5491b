#pragma once
#include <vector>

#include "floe/dynamics/spatial_marker.h"
#include "floe/fem/reference_frame.h"

namespace floe::assembly {

using FrameKind = fem::ReferenceFrame::Kind;

/// The floating frame of a whole body from places of it: of a body in several frames, whose parts have their own, and
/// of corotational beams, which have none. By its kind, with r_i the places and X_i the same in the undeformed body:
///
///   pinned     places a, b: origin r_a, x axis along r_b - r_a
///   clamped    place a: its position and its axes
///   mean_axis  centres of mass of equal parts, which are fixed to their mean-axis frames at angles theta_i: with
///              d_i = r_i - mean r and D_i = X_i - mean X,
///              sum_i D_i x A' d_i + k^2 sin(theta_i - theta) = 0, k the radius of gyration of a part; what a part
///              deforms adds to it with the square of the rotations between the frames only
struct FrameByPlaces {
  FrameKind kind;
  std::vector<dynamics::Marker> places;
  std::vector<Eigen::Vector2d> undeformed;             ///< X_i; pinned: a alone
  double gyration = 0;                                 ///< k^2 [m2]
  Eigen::Vector2d of_probe = Eigen::Vector2d::Zero();  ///< the undeformed place, from the origin in the frame's axes
};

/// The displacement of a place from this frame, in its axes [m].
/// @param at  where the place is. @param q  all coordinates of the system's last rank
Eigen::Vector2d deflection(const FrameByPlaces& frame, const Eigen::VectorXd& q, const Eigen::Vector2d& at);

/// The same in space, undeformed positions and deflections in the axes of the mesh; the axes of each place are those of
/// the mesh, carried by it. Pinned: the frame rotates about the line from a to b with place a (no component of the
/// rotation vector of a relative to the frame along that line); mean_axis: centres of mass r_i of parts of masses m_i,
/// which are rotated by R_i and have the second moments C_i about these, with d_i = r_i - mean r and D_i = X_i - mean
/// X, means by mass: A is the rotation nearest to sum_i m_i d_i D_i' + R_i C_i (the mean axes of parts that are rigid,
/// at any rotations), of parts on one line about it the one nearest to their rotations.
struct SpatialFrameByPlaces {
  FrameKind kind;
  std::vector<dynamics::SpatialMarker> places;
  std::vector<Eigen::Vector3d> undeformed;
  std::vector<double> masses = {};            ///< [kg]
  std::vector<Eigen::Matrix3d> moments = {};  ///< [kg m2], axes of the mesh
  Eigen::Vector3d of_probe = Eigen::Vector3d::Zero();
};

Eigen::Vector3d deflection(const SpatialFrameByPlaces& frame, const Eigen::VectorXd& q, const Eigen::Vector3d& at);

}  // namespace floe::assembly
