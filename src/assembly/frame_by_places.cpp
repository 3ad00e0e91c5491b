#include "floe/assembly/frame_by_places.h"

#include <cmath>

#include "floe/math/rotation.h"

namespace floe::assembly {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

Eigen::VectorXd own(const std::vector<int>& coordinates, const Eigen::VectorXd& q) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(coordinates.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = q[coordinates[i]];
  return values;
}

Vector3d pose_of(const dynamics::Marker& place, const Eigen::VectorXd& q) {
  const Eigen::VectorXd at = own(place.coordinates, q), none = Eigen::VectorXd::Zero(at.size());
  dynamics::Pose pose;
  dynamics::pose(place, at, none, none, pose);
  return pose.y;
}

dynamics::SpatialPose pose_of(const dynamics::SpatialMarker& place, const Eigen::VectorXd& q) {
  const Eigen::VectorXd at = own(place.coordinates, q), none = Eigen::VectorXd::Zero(at.size());
  dynamics::SpatialPose pose;
  dynamics::pose(place, at, none, none, pose, dynamics::EvaluationLevel::position);
  return pose;
}

template <class Vector>
Vector mean(const std::vector<Vector>& all) {
  Vector sum = Vector::Zero();
  for (const Vector& one : all) sum += one;
  return sum / static_cast<double>(all.size());
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Axes {
  Vector2d origin;
  double angle;
};

Axes mean_axes(const FrameByPlaces& frame, const Eigen::VectorXd& q) {
  std::vector<Vector2d> at;
  double s = 0, c = 0;
  for (const dynamics::Marker& place : frame.places) {
    const Vector3d pose = pose_of(place, q);
    at.emplace_back(pose.head<2>());
    s += frame.gyration * std::sin(pose[2]), c += frame.gyration * std::cos(pose[2]);
  }
  const Vector2d r = mean(at), X = mean(frame.undeformed);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vector2d D = frame.undeformed[i] - X, d = at[i] - r;
    s += cross(D, d), c += D.dot(d);
  }
  return {r, std::atan2(s, c)};
}

/// Axes whose `axis` is along `direction`, by the least rotation from those given.
Matrix3d swung(const Matrix3d& from, const Vector3d& axis, const Vector3d& direction) {
  return math::rotation_between(from * axis, direction).toRotationMatrix() * from;
}

struct SpatialAxes {
  Vector3d origin;
  Matrix3d axes;
};

SpatialAxes mean_axes(const SpatialFrameByPlaces& frame, const Eigen::VectorXd& q) {
  constexpr double about_the_line = 1e-9;  // of the moments: parts on one line by their own rotations
  std::vector<Vector3d> at;
  std::vector<Matrix3d> D;
  Vector3d r = Vector3d::Zero(), X = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < frame.places.size(); ++i) {
    const dynamics::SpatialPose pose = pose_of(frame.places[i], q);
    at.push_back(pose.p), D.push_back(pose.D);
    r += frame.masses[i] * pose.p, X += frame.masses[i] * frame.undeformed[i], mass += frame.masses[i];
  }
  r /= mass, X /= mass;
  Matrix3d sum = Matrix3d::Zero(), turned = Matrix3d::Zero();
  for (std::size_t i = 0; i < at.size(); ++i) {
    sum += frame.masses[i] * (at[i] - r) * (frame.undeformed[i] - X).transpose() + D[i] * frame.moments[i];
    turned += frame.masses[i] / mass * D[i];
  }
  return {r, math::nearest_rotation(sum + about_the_line * sum.norm() * turned)};
}

}  // namespace

Vector2d deflection(const FrameByPlaces& frame, const Eigen::VectorXd& q, const Vector2d& at) {
  Axes axes;
  if (frame.kind == FrameKind::mean_axis) {
    axes = mean_axes(frame, q);
  } else {
    const Vector3d a = pose_of(frame.places.front(), q);
    axes = {a.head<2>(), a[2]};
    if (frame.kind == FrameKind::pinned) {
      const Vector2d chord = pose_of(frame.places.back(), q).head<2>() - axes.origin;
      axes.angle = std::atan2(chord.y(), chord.x());
    }
  }
  return Eigen::Rotation2Dd(-axes.angle) * (at - axes.origin) - frame.of_probe;
}

Vector3d deflection(const SpatialFrameByPlaces& frame, const Eigen::VectorXd& q, const Vector3d& at) {
  SpatialAxes axes;
  if (frame.kind == FrameKind::mean_axis) {
    axes = mean_axes(frame, q);
  } else {
    const dynamics::SpatialPose a = pose_of(frame.places.front(), q);
    axes = {a.p, a.D};
    if (frame.kind == FrameKind::pinned)
      axes.axes = swung(a.D, (frame.undeformed.back() - frame.undeformed.front()).normalized(),
                        pose_of(frame.places.back(), q).p - a.p);
  }
  return axes.axes.transpose() * (at - axes.origin) - frame.of_probe;
}

}  // namespace floe::assembly
