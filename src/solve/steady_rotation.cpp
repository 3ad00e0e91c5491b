#include "floe/solve/steady_rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/solve/start.h"
#include "gather_to_all.h"
#include "rotating_axes.h"

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

namespace {

/// Rows and columns of J get greatest entries of about one: R J S (Ruiz 2001, RAL-TR-2001-034).
void equilibrate(Sparse& J, VectorXd& R, VectorXd& S) {
  const auto root = [](double greatest) { return greatest > 0 ? 1 / std::sqrt(greatest) : 1.0; };
  R = S = VectorXd::Ones(J.rows());
  for (int sweep = 0; sweep < 5; ++sweep) {
    VectorXd left = VectorXd::Zero(J.rows()), right = left;
    for (Index i = 0; i < J.rows(); ++i)
      for (Sparse::InnerIterator entry(J, i); entry; ++entry) {
        left[i] = std::max(left[i], std::abs(entry.value()));
        right[entry.col()] = std::max(right[entry.col()], std::abs(entry.value()));
      }
    left = left.unaryExpr(root), right = right.unaryExpr(root);
    J = left.asDiagonal() * J * right.asDiagonal();
    R.array() *= left.array(), S.array() *= right.array();
  }
}

/// J^-1 b by MUMPS on this rank.
VectorXd factored(Sparse& J, VectorXd b) {
  const PetscInt n = static_cast<PetscInt>(J.rows());
  petsc::MatHandle A;
  petsc::VecHandle in, out;
  petsc::KspHandle ksp;
  VectorXd x(n);
  J.makeCompressed();
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, J.outerIndexPtr(), J.innerIndexPtr(), J.valuePtr(), A.out()));
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, b.data(), in.out()));
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), out.out()));
  check(KSPCreate(PETSC_COMM_SELF, ksp.out()));
  check(KSPSetOperators(ksp, A, A));
  set_tangent_solver(ksp, A);
  check(KSPSolve(ksp, in, out));
  return x;
}

/// J x = b on the first rank; where J is small the solution of least norm, which singular directions leave alone. Not
/// finite where there is none. Collective.
VectorXd solve(Sparse J, const VectorXd& b, MPI_Comm comm) {
  constexpr Index small = 400;
  VectorXd x = VectorXd::Zero(b.size());
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  if (rank == 0) try {
      VectorXd R, S;
      equilibrate(J, R, S);
      const VectorXd scaled = R.cwiseProduct(b);
      x = J.rows() <= small ? VectorXd(Eigen::CompleteOrthogonalDecomposition<MatrixXd>(MatrixXd(J)).solve(scaled))
                            : factored(J, scaled);
      x.array() *= S.array();
    } catch (const std::exception&) {  // other ranks wait for an answer
      x.setConstant(NAN);
    }
  MPI_Bcast(x.data(), static_cast<int>(x.size()), MPI_DOUBLE, 0, comm);
  return x;
}

/// Whether nothing holds the scene's rotation about the axis, at a configuration that meets the constraints.
bool rotates_freely(const RotatingTangent& at, const VectorXd& rotation) {
  const VectorXd constrained = at.G * rotation, size = at.G.cwiseAbs() * rotation.cwiseAbs();
  return (constrained.cwiseAbs().array() <= 1e-7 * size.array()).all();
}

/// Rigid motions of the scene beside its rotation about the axis, which a steady rotation leaves open: nothing holds
/// them, and they change no force. M-orthonormal, and M-orthogonal to `rotation`; unknowns x their number. Without them
/// the factor of a large free body is that of round-off.
MatrixXd open_motions(const RotatingSystem& rotating, const RotatingTangent& at, const VectorXd& u,
                      const VectorXd& rotation) {
  const bool plane = !rotating.planar_frames.empty();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // one of them along the axis of the rotation
  if (!plane) {
    const Eigen::Vector3d &z = rotating.axis.direction, x = z.unitOrthogonal();
    axes << x, z.cross(x), z;
  }
  const auto about = [&](const Eigen::Vector3d& point, int axis) {
    RotatingSystem other = rotating;
    other.axis = {point, axes.col(axis)};
    return rotating_motion(other, 1, u).V;
  };
  std::vector<VectorXd> all;
  const Eigen::Vector3d& point = rotating.axis.point;
  for (int i = 0; i < (plane ? 2 : 3); ++i) {  // along i: the difference of rotations about two parallel axes
    const int axis = plane ? 2 : (i + 1) % 3, across = plane ? 1 - i : (i + 2) % 3;
    all.push_back(about(point, axis) - about(point + axes.col(across), axis));
  }
  for (int i = 0; i < (plane ? 0 : 3); ++i) all.push_back(about(point, i));
  const Sparse size = at.K.cwiseAbs();
  std::vector<VectorXd> open;
  const double inertia = rotation.dot(at.M * rotation);
  for (VectorXd& motion : all) {
    if (!rotates_freely(at, motion)) continue;
    const VectorXd force = at.K * motion, most = size * motion.cwiseAbs();
    const double round_off = 1e-14 * most.maxCoeff();  // K may have entries of round-off alone
    if (!(force.cwiseAbs().array() <= 1e-12 * most.array() + round_off).all()) continue;
    const double before = std::sqrt(std::max(0.0, motion.dot(at.M * motion)));
    for (int twice = 0; twice < 2; ++twice) {
      if (inertia > 0) motion -= rotation.dot(at.M * motion) / inertia * rotation;
      for (const VectorXd& other : open) motion -= other.dot(at.M * motion) * other;
    }
    const double norm = std::sqrt(std::max(0.0, motion.dot(at.M * motion)));
    if (norm > 1e-6 * before) open.push_back(motion / norm);
  }
  MatrixXd found(u.size(), static_cast<Index>(open.size()));
  for (std::size_t i = 0; i < open.size(); ++i) found.col(static_cast<Index>(i)) = open[i];
  return found;
}

struct Step {
  VectorXd change;
  double spin_up = 0;  ///< angular acceleration about the axis that is left over [rad/s2]
};

/// Newton's step; where the scene is free to rotate, it does not, and may spin up instead: [J M b; (M b)' 0]. Nor does
/// it move as nothing holds it.
///
/// @param rotation  change of the coordinates as the scene rotates by one radian; zero where a drive holds it
/// @param open      of open_motions
/// Collective.
Step newton_step(const RotatingTangent& at, const VectorXd& rotation, const MatrixXd& open, MPI_Comm comm) {
  const double inertia = rotation.dot(at.M * rotation);
  const Index n = rotation.size(), first = inertia > 0 ? 1 : 0, count = first + open.cols();
  Sparse J = at.K + at.G;
  if (count == 0) return {solve(std::move(J), -at.F, comm)};
  MatrixXd weighted(n, count);
  if (first == 1) weighted.col(0) = at.M * rotation / inertia;
  weighted.rightCols(open.cols()) = at.M * open;
  std::vector<Eigen::Triplet<double, PetscInt>> border;
  for (Index k = 0; k < count; ++k)
    for (Index i = 0; i < n; ++i) {
      if (weighted(i, k) == 0) continue;
      border.emplace_back(static_cast<PetscInt>(i), static_cast<PetscInt>(n + k), weighted(i, k));
      border.emplace_back(static_cast<PetscInt>(n + k), static_cast<PetscInt>(i), weighted(i, k));
    }
  Sparse bordered(n + count, n + count);
  bordered.setFromTriplets(border.begin(), border.end());
  J.conservativeResize(n + count, n + count);
  VectorXd b = VectorXd::Zero(n + count);
  b.head(n) = -at.F;
  const VectorXd x = solve(J + bordered, b, comm);
  return {x.head(n), first == 1 ? x[n] / inertia : 0};
}

/// Accelerations that round-off, or a search that came near enough, leaves. [rad/s2]
double negligible(const RotatingTangent& at, const MassScale& mass, double speed) {
  double fastest = 0;  // square of the highest frequency
  const VectorXd stiffness = VectorXd(at.K.diagonal()).cwiseAbs();
  for (Index i = 0; i < stiffness.size(); ++i)
    if (mass.root[i] > 0) fastest = std::max(fastest, stiffness[i] / std::pow(mass.root[i], 2));
  return 1e-6 * speed * speed + 1e-12 * fastest;
}

/// That forces balance: what singular directions have left is no equilibrium.
void check_balance(const RotatingSystem& rotating, double speed, double spin_up, Vec U) {
  const RotatingTangent at = rotating_tangent(rotating, speed, U);
  const MassScale mass = mass_scale(rotating, at.M);
  const double small = negligible(at, mass, speed);
  if (std::abs(spin_up) > small)
    throw RunError(
        fmt::format("a residual moment about the axis accelerates the rotation by {:.3g} rad/s2; expected a drive, or "
                    "loads without such a moment",
                    std::abs(spin_up)));
  double greatest = 0;
  for (Index i = 0; i < at.F.size(); ++i)
    if (mass.root[i] > 0) greatest = std::max(greatest, std::abs(at.F[i]) / (mass.root[i] * mass.rotation));
  if (!(greatest <= small))
    throw RunError(fmt::format("the forces are not in equilibrium (residual load: {:.3g} rad/s2)", greatest));
}

/// In units of a frame's rotation by one radian.
double size_of(const VectorXd& change, const MassScale& mass) {
  return change.cwiseProduct(mass.root).cwiseAbs().maxCoeff() / mass.rotation;
}

/// Whether all forces are zero and the constraints are satisfied, but for round-off: no step is needed, and J may be
/// singular (a hinge without stiffness at rest). Positions and directions of constraints are of the size of one [m, 1].
bool in_equilibrium(const RotatingSystem& rotating, const RotatingTangent& at, const VectorXd& u) {
  const std::vector<char> multiplier = multiplier_flags(rotating.system);
  const VectorXd forces = (at.K.cwiseAbs() + at.G.cwiseAbs()) * u.cwiseAbs(),
                 constraints = at.G.cwiseAbs() * u.cwiseAbs().cwiseMax(1);
  for (Index i = 0; i < at.F.size(); ++i)
    if (!(std::abs(at.F[i]) <= 1e-14 * (multiplier[static_cast<std::size_t>(i)] ? constraints[i] : forces[i])))
      return false;
  return true;
}

PetscInt newton(const RotatingSystem& rotating, double speed, Vec U) {
  double last = INFINITY;
  bool free = false;
  for (PetscInt iteration = 1; iteration <= 50; ++iteration) {
    const RotatingTangent at = rotating_tangent(rotating, speed, U);
    const VectorXd u = gather_to_all(rotating.system, U);
    if (iteration == 1 && in_equilibrium(rotating, at, u)) return 0;
    VectorXd rotation = rotating_motion(rotating, 1, u).V;
    if (iteration == 1) free = rotates_freely(at, rotation);
    if (!free) rotation.setZero();
    const Step step = newton_step(at, rotation, open_motions(rotating, at, u, rotation), rotating.system.comm());
    const double size = size_of(step.change, mass_scale(rotating, at.M));
    if (!step.change.allFinite()) break;
    set(U, u + step.change);
    if (size <= 1e-10 ||
        (iteration > 15 && size <= 1e-7 && size > 0.3 * last)) {  // the second: all that round-off allows
      check_balance(rotating, speed, step.spin_up, U);
      return iteration;
    }
    last = size;
  }
  throw RunError("Newton's method did not converge");
}

/// Newton's step at `speed` from U for the forces at `other`.
VectorXd step_towards(const RotatingSystem& rotating, double speed, double other, Vec U) {
  const VectorXd F = rotating_tangent(rotating, other, U).F;
  RotatingTangent at = rotating_tangent(rotating, speed, U);
  const VectorXd u = gather_to_all(rotating.system, U);
  VectorXd rotation = rotating_motion(rotating, 1, u).V;
  if (!rotates_freely(at, rotation)) rotation.setZero();
  at.F = F;
  return newton_step(at, rotation, open_motions(rotating, at, u, rotation), rotating.system.comm()).change;
}

/// From one steady rotation to another.
class Follower {
 public:
  Follower(const RotatingSystem& rotating, double from, double speed, Vec U)
      : rotating_(rotating), least_(std::abs(speed - from) / 1000), U_(U) {
    const MassScale mass = mass_scale(rotating, rotating_tangent(rotating, from, U).M);
    follows_ = size_of(step_towards(rotating, from, from, U), mass) <= 1e-6;
  }
  PetscInt go(double from, double speed) {
    const KeptState before(rotating_.system, U_);
    PetscInt iterations = 0;
    try {
      iterations = newton(rotating_, speed, U_);
    } catch (const RunError&) {
      before.restore(U_);
      if (std::abs(speed - from) < 2 * least_ || speed == from) throw;
      return halves(from, speed);
    }
    if (!follows_ || speed == from) return iterations;
    const BranchJump found = jump_of(from, before, speed);
    return found.ratio > 0 ? iterations + shorter(found, before) : iterations;
  }
  bool follows() const { return follows_; }
  BranchJump jump;  ///< the greatest

 private:
  PetscInt halves(double from, double speed) {
    const PetscInt first = go(from, (from + speed) / 2);
    return first + go((from + speed) / 2, speed);
  }

  PetscInt shorter(const BranchJump& found, const KeptState& before) {
    const KeptState there(rotating_.system, U_);
    if (std::abs(found.to - found.from) >= 2 * least_) {
      before.restore(U_);
      try {
        return halves(found.from, found.to);
      } catch (const RunError&) {  // none on the way: it was left
        there.restore(U_);
      }
    }
    if (found.ratio > std::max(least_jump, jump.ratio)) jump = found;
    return 0;
  }

  BranchJump jump_of(double from, const KeptState& before, double speed) const {
    const petsc::VecHandle start = rotating_.system.create_vector();
    rotating_.system.rebase(U_);
    const KeptState there(rotating_.system, U_);
    const VectorXd change = before.change_to(U_), back = -step_towards(rotating_, speed, from, U_);
    const MassScale mass = mass_scale(rotating_, rotating_tangent(rotating_, speed, U_).M);
    before.restore(start);
    const VectorXd forward = step_towards(rotating_, from, speed, start), predicted = (forward + back) / 2;
    there.restore(U_);
    const double size = size_of(change, mass);
    const auto away = [&](const VectorXd& step) { return size_of(change - step, mass) > size_of(change + step, mass); };
    const bool along = !away(forward) && !away(back);
    if (!(size > 1e-9) || (along && size_of(change - predicted, mass) <= most_departure * size)) return {};
    return {from, speed, size / std::max(size_of(predicted, mass), 1e-12 * size)};
  }

  const RotatingSystem& rotating_;
  double least_;
  bool follows_ = false;
  Vec U_;
};

/// Of U, steady at `speed`, but for a rotation about the axis that nothing holds.
double distance_to(const RotatingSystem& rotating, double speed, const KeptState& from, Vec U) {
  rotating.system.rebase(U);
  const RotatingTangent at = rotating_tangent(rotating, speed, U);
  VectorXd change = from.change_to(U);
  const VectorXd rotation = rotating_motion(rotating, 1, gather_to_all(rotating.system, U)).V,
                 weighted = at.M * rotation;
  if (const double inertia = rotation.dot(weighted); inertia > 0 && rotates_freely(at, rotation))
    change -= weighted.dot(change) / inertia * rotation;
  return size_of(change, mass_scale(rotating, at.M));
}

/// Another steady rotation than U, by way of one at `from`; U is as it was where there is none.
PetscInt search_from_steady(const RotatingSystem& rotating, double from, double speed, const KeptState& start, Vec U,
                            RotationSearch& found) {
  rotating.system.rebase(U);
  const KeptState direct(rotating.system, U);
  try {
    start.restore(U);
    PetscInt iterations = newton(rotating, from, U);
    Follower follower(rotating, from, speed, U);
    constexpr int steps = 8;  // whole ones may meet another branch by chance
    const double step = (speed - from) / steps;
    for (int i = 0; i < steps; ++i)
      iterations += follower.go(from + i * step, i + 1 < steps ? from + (i + 1) * step : speed);
    if (const double other = distance_to(rotating, speed, direct, U); other > near_start)
      found = {follower.jump, other};
    return iterations;
  } catch (const RunError&) {  // none at `from`, or none on the way
    direct.restore(U);
    return 0;
  }
}

}  // namespace

void rotating_velocities(const RotatingSystem& rotating, double speed, Vec U, Vec V) {
  rotating.system.rebase(U);
  set(V, rotating_motion(rotating, speed, gather_to_all(rotating.system, U)).V);
}

std::string other_rotation(const RotationSearch& search) {
  if (search.other == 0 && search.away > 0)
    return fmt::format(
        "the initial shape is not steady, and the steady rotation found is {:.2g} rad away from it; where another one "
        "is intended, start from a shape (`initial`) within {} rad of it",
        search.away, near_start);
  if (search.other == 0) return "";
  return fmt::format(
      "the initial shape is not steady; the result is the steady rotation reached from rest. From the initial shape "
      "Newton's method finds another one, {:.2g} rad away; start from a shape (`initial`) within {} rad of the one "
      "intended",
      search.other, near_start);
}

PetscInt steady_rotation(const RotatingSystem& rotating, double from, double speed, Vec U, RotationSearch* search) {
  const KeptState before(rotating.system, U);
  RotationSearch found;
  try {
    Follower follower(rotating, from, speed, U);
    PetscInt iterations = follower.go(from, speed);
    found.jump = follower.jump;
    if (!follower.follows() && speed != from && distance_to(rotating, speed, before, U) > near_start)
      iterations += search_from_steady(rotating, from, speed, before, U, found);
    if (!follower.follows() && speed != from)
      if (const double away = distance_to(rotating, speed, before, U); away > far_from_start) found.away = away;
    if (search) *search = found;
    return iterations;
  } catch (const RunError& error) {
    before.restore(U);
    throw RunError(fmt::format("no steady rotation at {:.6g} rad/s: {}", speed, error.what()));
  }
}

}  // namespace floe::solve
