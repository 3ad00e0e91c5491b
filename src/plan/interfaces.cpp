#include "interfaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "floe/plan/place_weights.h"
#include "floe/plan/prepare_spatial.h"

namespace floe::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// The nodes of a place, one by one. Collective.
std::vector<Anchor> nodes_of(const PlannedBody& body, const Anchor& place) {
  std::vector<Anchor> all;
  const Place name;
  for (PetscInt node : place.nodes) {
    const mesh::NodeSets one{{name.name, {{node}}}};
    all.push_back(spatial_place(body.spec, body.structure, one, name, {body.origin, body.axes}));
    all.back().body = place.body;
  }
  return all;
}

/// Exponents of the monomials of a degree in three coordinates.
std::vector<std::array<int, 3>> monomials(int degree) {
  std::vector<std::array<int, 3>> all;
  for (int i = degree; i >= 0; --i)
    for (int j = degree - i; j >= 0; --j) all.push_back({i, j, degree - i - j});
  return all;
}

/// Weights times polynomials of the nodes' places, orthonormal with these weights: 1, then by degree those that are not
/// combinations of earlier ones on the nodes.
MatrixXd factors(const std::vector<std::array<Anchor, 2>>& pairs, const VectorXd& weights, int degree) {
  const auto n = static_cast<Index>(pairs.size());
  Eigen::Matrix3Xd x(3, n);
  for (Index i = 0; i < n; ++i) x.col(i) = pairs[i][0].x;
  x.colwise() -= (x * weights).eval();
  x /= std::max(std::sqrt((x.colwise().squaredNorm() * weights).value()), 1e-300);
  MatrixXd P(n, 0);
  for (int d = 0; d <= degree; ++d)
    for (const auto& powers : monomials(d)) {
      VectorXd p = VectorXd::Ones(n);
      for (int c = 0; c < 3; ++c) p.array() *= x.row(c).transpose().array().pow(powers[c]);
      for (int twice = 0; twice < 2; ++twice) p -= P * (P.transpose() * weights.cwiseProduct(p)).eval();
      const double size = std::sqrt(weights.dot(p.cwiseAbs2()));
      if (!(size > 1e-6)) continue;
      P.conservativeResize(Eigen::NoChange, P.cols() + 1);
      P.rightCols<1>() = p / size;
    }
  return weights.asDiagonal() * P;
}

/// Of the shells on both sides. Collective.
void find_normal(Plan& plan, std::size_t j) {
  std::array<Vector3d, 2> normals;
  for (const int side : {0, 1}) {
    const Anchor& place = plan.joints[j][side];
    const PlannedBody& body = plan.bodies[place.body];
    const std::optional<Vector3d> normal = common_normal(body.structure, place.nodes);
    if (!normal) return;
    normals[side] = body.attitude * *normal;
  }
  if (normals[0].cross(normals[1]).norm() > 1e-6) return;
  Interface& found = plan.interfaces[j];
  const PlannedBody& body = plan.bodies[plan.joints[j][0].body];
  Eigen::Matrix3Xd x(3, std::ssize(found.pairs));
  for (Index i = 0; i < x.cols(); ++i) x.col(i) = found.pairs[static_cast<std::size_t>(i)][0].x;
  x.colwise() -= x.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> inertia(x * x.transpose());
  Eigen::Matrix3d& axes = plan.joint_axes[j];
  axes.col(2) = found.normal = normals[0];
  axes.col(0) = (body.attitude * inertia.eigenvectors().col(2)).cross(normals[0]).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
}

}  // namespace

Anchor Interface::sum(int side, Index vector) const {
  Weights weights = means[static_cast<std::size_t>(side)];
  if (vector > 0) {
    std::vector<reduction::WeightedNode> own;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      own.push_back({pairs[i][side].nodes.front(), factors(static_cast<Index>(i), vector)});
    weights = std::make_shared<const std::vector<reduction::WeightedNode>>(std::move(own));
  }
  Anchor sum = pairs.front()[side];
  sum.nodes.clear(), sum.averaging_weights.clear(), sum.x.setZero(), sum.line = false;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [number, factor, arm, turn, twist] = (*weights)[i];
    const Eigen::Matrix3d rotation = factor * Eigen::Matrix3d::Identity() + twist;
    const Anchor& node = pairs[i][side];
    sum.nodes.push_back(number);
    sum.x += factor * node.x;
    for (const AveragingWeight& own : node.averaging_weights) {
      auto at = std::find_if(sum.averaging_weights.begin(), sum.averaging_weights.end(),
                             [&](const AveragingWeight& weight) { return weight.node == own.node; });
      if (at == sum.averaging_weights.end()) {
        sum.averaging_weights.push_back({own.node, 0, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()});
        at = sum.averaging_weights.end() - 1;
      }
      at->share += factor * own.share, at->arm += factor * own.arm, at->lead += factor * own.lead;
      at->rotation += rotation * own.rotation + turn * own.arm;
      at->turn += rotation * own.turn + turn * own.share;
    }
  }
  sum.weights = std::move(weights);
  sum.node = sum.averaging_weights.front().node;
  return sum;
}

void find_interfaces(Plan& plan) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    Interface& found = plan.interfaces.emplace_back();
    if (plan.scene.joints[j].edges != Joint::Edges::nodes) continue;
    auto& [first, second] = plan.joints[j];
    const PlannedBody& body = plan.bodies[first.body];
    const std::vector<Anchor> one = nodes_of(body, first), other = nodes_of(plan.bodies[second.body], second);
    std::array<std::vector<reduction::WeightedNode>, 2> means;
    VectorXd weights(static_cast<Index>(one.size()));
    for (const reduction::WeightedNode& at : place_weights(body.structure, first.nodes)) {
      const std::size_t i = found.pairs.size();
      found.pairs.push_back({one[i], other[i]});
      weights[static_cast<Index>(i)] = at.weight;
      for (const int side : {0, 1}) means[side].push_back({found.pairs[i][side].nodes.front(), at.weight});
    }
    found.factors = factors(found.pairs, weights, body.spec.reduction.interface_degree);
    for (const int side : {0, 1}) {
      if (found.factors.cols() == 1) set_rotation(plan.bodies[plan.joints[j][side].body].structure, means[side]);
      found.means[side] = std::make_shared<const std::vector<reduction::WeightedNode>>(std::move(means[side]));
    }
    const int degree = body.spec.reduction.interface_degree;
    if (degree > 0) find_normal(plan, j);
    if (!found.normal.isZero(0)) {
      const Index whole = found.factors.cols();
      found.factors = factors(found.pairs, weights, degree + 1);
      found.across = found.factors.cols() - whole;
    }
    first = found.sum(0, 0), second = found.sum(1, 0);
  }
}

}  // namespace floe::plan
