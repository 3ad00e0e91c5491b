#include "rotating_axes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "floe/petsc/all_ranks.h"
#include "gather_to_all.h"

namespace floe::solve {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using petsc::check;

std::vector<WorldFrame> world_frames(const System& system) {
  std::vector<double> mine;
  for (const auto& [first, attitude] : system.attitudes()) {
    const Eigen::Quaterniond& q = attitude->base;
    mine.insert(mine.end(), {double(system.coordinates().global()[first]), q.w(), q.x(), q.y(), q.z()});
  }
  const std::vector<double> all = petsc::of_all_ranks(system.comm(), mine);
  std::vector<WorldFrame> frames;
  for (std::size_t i = 0; i < all.size(); i += 5)
    frames.push_back({std::lround(all[i]), {all[i + 1], all[i + 2], all[i + 3], all[i + 4]}});
  const auto before = [](const WorldFrame& a, const WorldFrame& b) { return a.x < b.x; };
  const auto same = [](const WorldFrame& a, const WorldFrame& b) { return a.x == b.x; };
  std::stable_sort(frames.begin(), frames.end(), before);
  frames.erase(std::unique(frames.begin(), frames.end(), same), frames.end());
  return frames;
}

namespace {

Index global(const RotatingSystem& rotating, int local) { return rotating.system.coordinates().global()[local]; }

Matrix2d across(double factor) { return (Matrix2d() << 0, -factor, factor, 0).finished(); }

void add_planar(const RotatingSystem& rotating, double speed, const VectorXd& U, RotatingMotion& out) {
  const Matrix2d W = across(speed);
  for (int frame : rotating.planar_frames) {
    const Index R = global(rotating, frame);
    const Eigen::Vector2d arm = U.segment<2>(R) - rotating.axis.point.head<2>();
    out.V.segment<2>(R) = W * arm, out.V[R + 2] = speed;
    out.A.segment<2>(R) = W * W * arm;
    out.V_U.push_back({R, R, W});
    out.A_U.push_back({R, R, W * W});
    out.H.push_back({R, R, 2 * W});
  }
}

void add_spatial(const RotatingSystem& rotating, double speed, const VectorXd& U, RotatingMotion& out) {
  const Vector3d spin = speed * rotating.axis.direction;
  const Matrix3d W = math::skew(spin);
  for (const auto& [x, base] : world_frames(rotating.system)) {
    const Index R = x - 3;
    const Vector3d omega = base.conjugate() * spin, arm = U.segment<3>(R) - rotating.axis.point;
    const Matrix3d w = math::skew(omega);
    out.V.segment<3>(R) = W * arm, out.V.segment<3>(x) = omega;
    out.A.segment<3>(R) = W * W * arm;
    out.V_U.push_back({R, R, W});
    out.V_U.push_back({x, x, w});  // A -> A (I + ~dtheta): A'W -> A'W - dtheta x omega
    out.A_U.push_back({R, R, W * W});
    out.H.push_back({R, R, 2 * W});
    out.H.push_back({x, x, w});
  }
}

}  // namespace

RotatingMotion rotating_motion(const RotatingSystem& rotating, double speed, const VectorXd& U) {
  RotatingMotion out{VectorXd::Zero(U.size()), VectorXd::Zero(U.size()), {}, {}, {}};
  add_planar(rotating, speed, U, out);
  add_spatial(rotating, speed, U, out);
  return out;
}

void add_product(const MatrixXd& Y, const RotatingMotion::Blocks& B, MatrixXd& X) {
  for (const auto& block : B)
    X.middleCols(block.column, block.values.cols()) += Y.middleCols(block.row, block.values.rows()) * block.values;
}

RotatingTangent rotating_tangent(const RotatingSystem& rotating, double speed, Vec U) {
  const System& system = rotating.system;
  system.rebase(U);
  const RotatingMotion motion = rotating_motion(rotating, speed, gather_to_all(system, U));
  const petsc::VecHandle V = system.create_vector(), A = system.create_vector(), F = system.create_vector();
  set(V, motion.V), set(A, motion.A);
  const petsc::MatHandle J = system.create_tangent();
  const auto tangent = [&](Weights weights) {
    system.tangent(0, U, V, A, weights, J);
    return gather_to_all(system, J);
  };
  RotatingTangent out;
  system.residual(0, U, V, A, ConstraintLevel::position, F);
  out.F = gather_to_all(system, F);
  out.G = tangent({0, 0, 0});
  out.M = tangent({0, 0, 1}) - out.G;
  const MatrixXd F_v = tangent({0, 1, 0}) - out.G;
  out.K = tangent({1, 0, 0}) - out.G;
  add_product(F_v, motion.V_U, out.K);
  add_product(out.M, motion.A_U, out.K);
  out.C = F_v;
  add_product(out.M, motion.H, out.C);
  return out;
}

std::vector<char> multiplier_flags(const System& system) {
  const Coordinates& coordinates = system.coordinates();
  std::vector<char> flags(coordinates.global_size(), 0);
  for (int i = 0; i < coordinates.local_size(); ++i)
    if (coordinates.multiplier()[i]) flags[coordinates.global()[i]] = 1;
  return flags;
}

MassScale mass_scale(const RotatingSystem& rotating, const MatrixXd& M) {
  MassScale scale{M.diagonal().cwiseMax(0).cwiseSqrt(), 0};
  for (int frame : rotating.planar_frames)
    scale.rotation = std::max(scale.rotation, scale.root[global(rotating, frame) + 2]);
  for (const auto& [x, base] : world_frames(rotating.system))
    scale.rotation = std::max(scale.rotation, scale.root.segment<3>(x).maxCoeff());
  if (scale.rotation == 0) scale.rotation = 1;
  return scale;
}

KeptState::KeptState(const System& system, Vec U)
    : system_(system), U_(system.create_vector()), frames_(world_frames(system)) {
  check(VecCopy(U, U_));
  for (const auto& [first, attitude] : system.attitudes()) bases_.push_back(attitude->base);
}

void KeptState::restore(Vec U) const {
  check(VecCopy(U_, U));
  for (std::size_t i = 0; i < bases_.size(); ++i) system_.attitudes()[i].second->base = bases_[i];
}

VectorXd KeptState::change_to(Vec U) const {
  VectorXd change = gather_to_all(system_, U) - gather_to_all(system_, U_);
  const std::vector<WorldFrame> now = world_frames(system_);
  for (std::size_t i = 0; i < frames_.size(); ++i)
    change.segment<3>(now[i].x) = math::rotation_vector(frames_[i].base.conjugate() * now[i].base);
  return change;
}

void rotate(const RotatingSystem& rotating, double angle, Vec U) {
  const System& system = rotating.system;
  system.rebase(U);
  VectorXd u = gather_to_all(system, U);
  const Eigen::Quaterniond E(Eigen::AngleAxisd(angle, rotating.axis.direction));
  const Vector3d& c = rotating.axis.point;
  for (const auto& [x, base] : world_frames(system)) u.segment<3>(x - 3) = c + E * (u.segment<3>(x - 3) - c);
  for (const auto& [first, attitude] : system.attitudes()) attitude->base = (E * attitude->base).normalized();
  for (int frame : rotating.planar_frames) {
    const Index R = global(rotating, frame);
    u.segment<2>(R) = c.head<2>() + Eigen::Rotation2Dd(angle) * (u.segment<2>(R) - c.head<2>());
    u[R + 2] += angle;
  }
  set(U, u);
}

void rotation_rows(const RotatingSystem& rotating, double angle, Eigen::Ref<MatrixXd> rows) {
  const Matrix3d E = Eigen::AngleAxisd(angle, rotating.axis.direction).toRotationMatrix();
  for (const auto& [x, base] : world_frames(rotating.system))
    rows.middleRows(x - 3, 3) = (E * rows.middleRows(x - 3, 3)).eval();
  for (int frame : rotating.planar_frames) {
    const Index R = global(rotating, frame);
    rows.middleRows(R, 2) = (E.topLeftCorner<2, 2>() * rows.middleRows(R, 2)).eval();
  }
}

}  // namespace floe::solve
