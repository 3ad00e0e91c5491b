#include "resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "floe/math/rotation.h"
#include "floe/petsc/values.h"
#include "rotations.h"
#include "round_off.h"

namespace floe::solve {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using petsc::check;

bool owns(const System& system, Mat J, int local) {
  PetscInt first = 0, end = 0;
  check(MatGetOwnershipRange(J, &first, &end));
  const PetscInt global = system.coordinates().global()[local];
  return global >= first && global < end;
}

/// Rows and columns from local `first` on, `count` of them, all owned.
MatrixXd block(const System& system, Mat J, int first, int count) {
  const std::vector<PetscInt>& global = system.coordinates().global();
  const std::vector<PetscInt> rows(global.begin() + first, global.begin() + first + count);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(count, count);
  check(MatGetValues(J, count, rows.data(), count, rows.data(), values.data()));
  return values;
}

FrameInertia inertia_of(const System& system, Mat M, int first, int dimension, int rotations) {
  const MatrixXd all = block(system, M, first, dimension + rotations);
  FrameInertia frame{first, first + dimension, 0, MatrixXd::Zero(dimension, rotations)};
  const double mass = all(0, 0);
  if (!(mass > 0)) return frame;
  frame.centre_shift = all.topRightCorner(dimension, rotations) / mass;
  const MatrixXd about_centre =
      all.bottomRightCorner(rotations, rotations) / mass - frame.centre_shift.transpose() * frame.centre_shift;
  frame.radius = std::sqrt(std::max(0.0, about_centre.trace()));
  return frame;
}

/// What the frame rotates by, about axes that M's rows have.
VectorXd rotation_of(const FrameInertia& frame, const VectorXd& d, const VectorXd& u) {
  if (frame.centre_shift.cols() == 1) return d.segment(frame.rotations, 1);
  return math::rotation_tangent(u.segment<3>(frame.rotations)) * d.segment<3>(frame.rotations);
}

double greatest_shift(const System& system, const std::vector<FrameInertia>& frames, Vec step, Vec U, Vec before) {
  VectorXd d, u, start;
  system.gather(step, d), system.gather(U, u), system.gather(before, start);
  double size = 0, greatest = 0;
  for (const FrameInertia& frame : frames) size = std::max(size, frame.radius);
  for (const FrameInertia& frame : frames) {
    if (size == 0) break;  // axes that follow the nodes of corotational bodies: where they are, the nodes tell
    const Index dimension = frame.centre_shift.rows();
    const double moved = (u - start).segment(frame.first, dimension).norm();
    const double beside = std::max(frame.radius > 0 ? frame.radius : size, moved);
    const VectorXd by = d.segment(frame.first, dimension) + frame.centre_shift * rotation_of(frame, d, u);
    if (beside > 0) greatest = std::max(greatest, by.norm() / beside);
  }
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, system.comm());
  return greatest;
}

/// One or minus one, as if by chance (splitmix64).
double sign_of(std::uint64_t index, std::uint64_t round) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u + round * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1 : -1;
}

/// 64 eps |J| |x| with signs that change, plus what stands in `rows`.
void add_round_off(Mat J, Vec x, std::uint64_t round, Vec rows) {
  const petsc::VecHandle terms = sizes_of_terms(J, x);
  petsc::Values error(rows), term(terms);
  for (PetscInt i = error.first; i < error.end; ++i)
    error[i] += 64 * PETSC_MACHINE_EPSILON * sign_of(static_cast<std::uint64_t>(i), round) * term[i];
}

/// Whether d is no more than what round-off of the frames' places makes of the configuration.
bool is_of_places(const System& system, const std::vector<FrameInertia>& frames, KSP solver, Mat J, Vec d) {
  const petsc::VecHandle zero = system.create_vector(), rows = system.create_vector(), made = system.create_vector();
  add_round_off(J, sizes_of_places(system, frames, zero), 0, rows);
  check(KSPSolve(solver, rows, made));
  return share_of(J, d, made) <= 1;
}

}  // namespace

std::vector<FrameInertia> frame_inertias(const System& system, double t, Vec U, Vec V, Mat J) {
  const petsc::VecHandle A = system.create_vector();
  system.tangent(t, U, V, A, {0, 0, 1}, J);
  std::vector<FrameInertia> frames;
  for (const auto& attitude : system.attitudes())
    if (attitude.first >= 3 && owns(system, J, attitude.first))
      frames.push_back(inertia_of(system, J, attitude.first - 3, 3, 3));
  for (const Coordinates::Angle& angle : system.coordinates().angles())
    if (angle.of_frame && owns(system, J, angle.local)) frames.push_back(inertia_of(system, J, angle.local - 2, 2, 1));
  return frames;
}

petsc::VecHandle sizes_of_places(const System& system, const std::vector<FrameInertia>& frames, Vec U) {
  petsc::VecHandle all = system.create_vector();
  check(VecCopy(U, all));
  check(VecAbs(all));
  petsc::Values own(all);
  for (const FrameInertia& frame : frames) {
    const int first = frame.first, dimension = static_cast<int>(frame.centre_shift.rows());
    for (int local = first; local < frame.rotations + frame.centre_shift.cols(); ++local) {
      double& size = own[system.coordinates().global()[local]];
      size = std::max(size, local < first + dimension ? frame.radius : 1.0);
    }
  }
  return all;
}

double plain_size(const System& system, const std::vector<FrameInertia>& frames, KSP solver, Mat J, Vec d, Vec U,
                  Vec before) {
  const double rotation = max_rotation_of_step(system, d), shift = greatest_shift(system, frames, d, U, before);
  double share = share_of(J, d, U);
  if (!std::isfinite(rotation + shift)) return INFINITY;
  if (share > 1e-9 && is_of_places(system, frames, solver, J, d)) share = 0;
  return std::isfinite(share) ? std::max({rotation, shift, share}) : INFINITY;
}

double gain_of_errors(const System& system, KSP solver, Mat J, Mat next) {
  const petsc::VecHandle w = system.create_vector(), y = system.create_vector(), changed = system.create_vector();
  double size = 0, gain = 0;
  check(MatGetDiagonal(J, w));
  {
    petsc::Values start(w);
    for (PetscInt i = start.first; i < start.end; ++i) start[i] = start[i] != 0 ? 1 / std::sqrt(std::abs(start[i])) : 1;
  }
  for (int round = 0; round < 4; ++round) {
    check(MatMult(next, w, changed));
    check(MatMult(J, w, y));
    check(VecAXPY(changed, -1, y));
    add_round_off(J, w, round, changed);
    check(VecNorm(w, NORM_INFINITY, &size));
    check(KSPSolve(solver, changed, y));
    check(VecNorm(y, NORM_INFINITY, &gain));
    gain /= size;
    if (!(gain > 0) || !std::isfinite(gain)) return gain == 0 ? 0 : INFINITY;
    check(VecCopy(y, w));
    check(VecScale(w, 1 / (gain * size)));
  }
  return gain;
}

}  // namespace floe::solve
