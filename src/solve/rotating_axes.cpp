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

/// The blocks of a matrix that has few.
class Blocks {
 public:
  void add(Index row, Index column, const MatrixXd& values) {
    for (Index i = 0; i < values.rows(); ++i)
      for (Index j = 0; j < values.cols(); ++j)
        entries_.emplace_back(static_cast<PetscInt>(row + i), static_cast<PetscInt>(column + j), values(i, j));
  }
  Sparse matrix(Index n) const {
    Sparse sum(n, n);
    sum.setFromTriplets(entries_.begin(), entries_.end());
    return sum;
  }

 private:
  std::vector<Eigen::Triplet<double, PetscInt>> entries_;
};

struct Derivatives {
  Blocks V_U, A_U, H;
};

void add_planar(const RotatingSystem& rotating, double speed, const VectorXd& U, RotatingMotion& out, Derivatives& d) {
  const Matrix2d W = across(speed);
  for (int frame : rotating.planar_frames) {
    const Index R = global(rotating, frame);
    const Eigen::Vector2d arm = U.segment<2>(R) - rotating.axis.point.head<2>();
    out.V.segment<2>(R) = W * arm, out.V[R + 2] = speed;
    out.A.segment<2>(R) = W * W * arm;
    d.V_U.add(R, R, W);
    d.A_U.add(R, R, W * W);
    d.H.add(R, R, 2 * W);
  }
}

void add_spatial(const RotatingSystem& rotating, double speed, const VectorXd& U, RotatingMotion& out, Derivatives& d) {
  const Vector3d spin = speed * rotating.axis.direction;
  const Matrix3d W = math::skew(spin);
  for (const auto& [x, base] : world_frames(rotating.system)) {
    const Index R = x - 3;
    const Vector3d omega = base.conjugate() * spin, arm = U.segment<3>(R) - rotating.axis.point;
    const Matrix3d w = math::skew(omega);
    out.V.segment<3>(R) = W * arm, out.V.segment<3>(x) = omega;
    out.A.segment<3>(R) = W * W * arm;
    d.V_U.add(R, R, W);
    d.V_U.add(x, x, w);  // A -> A (I + ~dtheta): A'W -> A'W - dtheta x omega
    d.A_U.add(R, R, W * W);
    d.H.add(R, R, 2 * W);
    d.H.add(x, x, w);
  }
}

}  // namespace

RotatingMotion rotating_motion(const RotatingSystem& rotating, double speed, const VectorXd& U) {
  RotatingMotion out{VectorXd::Zero(U.size()), VectorXd::Zero(U.size()), {}, {}, {}};
  Derivatives d;
  add_planar(rotating, speed, U, out, d);
  add_spatial(rotating, speed, U, out, d);
  out.V_U = d.V_U.matrix(U.size()), out.A_U = d.A_U.matrix(U.size()), out.H = d.H.matrix(U.size());
  return out;
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
  const Sparse F_v = tangent({0, 1, 0}) - out.G;
  out.K = tangent({1, 0, 0}) - out.G;
  out.K += Sparse(F_v * motion.V_U) + Sparse(out.M * motion.A_U);
  out.C = F_v + Sparse(out.M * motion.H);
  return out;
}

std::vector<char> multiplier_flags(const System& system) {
  const Coordinates& coordinates = system.coordinates();
  std::vector<char> flags(coordinates.global_size(), 0);
  for (int i = 0; i < coordinates.local_size(); ++i)
    if (coordinates.multiplier()[i]) flags[coordinates.global()[i]] = 1;
  return flags;
}

MassScale mass_scale(const RotatingSystem& rotating, const Sparse& M) {
  MassScale scale{VectorXd(M.diagonal()).cwiseMax(0).cwiseSqrt(), 0};
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

Sparse row_rotation(const RotatingSystem& rotating, double angle) {
  const Matrix3d E = Eigen::AngleAxisd(angle, rotating.axis.direction).toRotationMatrix();
  const Index n = rotating.system.coordinates().global_size();
  std::vector<char> rotated(n, 0);
  Blocks blocks;
  const auto rotate_at = [&](Index R, const MatrixXd& block) {
    blocks.add(R, R, block);
    std::fill_n(rotated.begin() + R, block.rows(), 1);
  };
  for (const auto& [x, base] : world_frames(rotating.system)) rotate_at(x - 3, E);
  for (int frame : rotating.planar_frames) rotate_at(global(rotating, frame), E.topLeftCorner<2, 2>());
  for (Index i = 0; i < n; ++i)
    if (!rotated[i]) blocks.add(i, i, MatrixXd::Ones(1, 1));
  return blocks.matrix(n);
}

}  // namespace floe::solve
