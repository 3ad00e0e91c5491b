#include "rims.h"

#include <algorithm>

#include "floe/math/rotation.h"
#include "floe/plan/ground_axes.h"
#include "floe/scene/joint_events.h"

namespace floe::plan {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Kind = Joint::Kind;

/// Directions that the joint holds, of displacements and of rotations; its axis is z.
struct Held {
  std::vector<int> displacements, rotations;
};

Held held_by(Kind kind) {
  switch (kind) {
    case Kind::revolute:
      return {{0, 1, 2}, {0, 1}};
    case Kind::cylindrical:
      return {{0, 1}, {0, 1}};
    case Kind::prismatic:
      return {{0, 1}, {0, 1, 2}};
    case Kind::spherical:
    case Kind::universal:  // one rotation more, about an axis that neither place has alone
      return {{0, 1, 2}, {}};
    case Kind::planar:
      return {{2}, {0, 1}};
    default:
      return {};
  }
}

Matrix3d axes_about(const Vector3d& axis) {
  Matrix3d W;
  W.col(2) = axis;
  W.col(0) = axis.unitOrthogonal();
  W.col(1) = axis.cross(W.col(0));
  return W;
}

}  // namespace

std::map<PetscInt, Rim> fixed_rims(const Scene& scene, const Body& body, const fem::Structure& structure,
                                   const mesh::NodeSets& places, const MeshAxes& mesh) {
  struct Rows {
    std::vector<int> joints;
    MatrixXd J = MatrixXd(0, 6);
  };
  std::map<std::pair<PetscInt, std::string>, Rows> found;
  const Point& rotated = body.initial.rotation;
  const Matrix3d to_axes = mesh.axes.transpose() * math::rotation({rotated[0], rotated[1], rotated[2]}).transpose();
  const double extent = fem::extent(structure);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& joint = scene.joints[j];
    const Held constrained = held_by(joint.kind);
    if (constrained.displacements.empty() || joint.first.body == joint.second.body || is_switched(scene, joint.name))
      continue;
    for (const Place* at : {&joint.first, &joint.second}) {
      if (body.rigid || body.reduced || at->body != body.name) continue;
      const Anchor place = spatial_place(body, structure, places, *at, mesh);
      const auto leads = [](const AveragingWeight& weight) { return weight.share > 0; };
      const auto independent_node = std::find_if(place.averaging_weights.begin(), place.averaging_weights.end(), leads);
      if (std::count_if(place.averaging_weights.begin(), place.averaging_weights.end(), leads) != 1) continue;
      const std::optional<Vector3d> line = line_of(structure.mesh, place);
      if (!joint.axis_given && !line && joint.kind != Kind::spherical) continue;
      const Point& axis = joint.axis;
      const Vector3d along = joint.axis_given ? to_axes * Vector3d(axis[0], axis[1], axis[2]).normalized()
                                              : line.value_or(Vector3d::UnitZ());
      const Matrix3d W = axes_about(along), arm = independent_node->arm / extent;
      const Place& other = at == &joint.first ? joint.second : joint.first;
      Rows& rows = found[{independent_node->node, other.body}];
      rows.joints.push_back(static_cast<int>(j));
      const auto add = [&](const Eigen::Matrix<double, 1, 6>& row) {
        rows.J.conservativeResize(rows.J.rows() + 1, 6);
        rows.J.bottomRows<1>() = row;
      };
      for (int i : constrained.displacements)
        add((Eigen::Matrix<double, 1, 6>() << W.col(i).transpose(), W.col(i).transpose() * arm).finished());
      for (int i : constrained.rotations)
        add((Eigen::Matrix<double, 1, 6>() << Vector3d::Zero().transpose(), W.col(i).transpose()).finished());
    }
  }
  std::map<PetscInt, Rim> rims;
  for (const auto& [at, rows] : found) {
    const Eigen::JacobiSVD<MatrixXd> svd(rows.J);
    if (rows.joints.size() < 2 || (svd.singularValues().array() > 1e-6).count() < 6) continue;
    if (const auto [rim, fresh] = rims.emplace(at.first, Rim{at.second, rows.joints}); !fresh && at.second == "ground")
      rim->second = {at.second, rows.joints};  // the ground before bodies
  }
  return rims;
}

}  // namespace floe::plan
