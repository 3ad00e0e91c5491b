#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "floe/petsc/error.h"
#include "gather_to_all.h"
#include "null_space.h"

namespace floe::solve {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double tried = 0.4;  // rad; no angle of a symmetry

/// Owner of each unknown by global index, "" where there is none.
std::vector<std::string> owner_names(const Coordinates& coordinates) {
  std::vector<std::string> names(coordinates.global_size());
  const std::vector<int> owner = coordinates.owner_of_local();
  for (int i = 0; i < coordinates.local_size(); ++i)
    if (owner[i] >= 0) names[coordinates.global()[i]] = coordinates.owners()[owner[i]];
  return names;
}

/// The equation that holds the angle of each drive: of a drive in space the fourth (Q_21), in the plane the last.
std::vector<Index> angle_rows(const RotatingSystem& rotating, const std::vector<std::string>& names) {
  const std::vector<char> is_multiplier = multiplier_flags(rotating.system);
  std::vector<Index> angles;
  for (const std::string& drive : rotating.drives) {
    std::vector<Index> rows;
    for (Index i = 0; i < static_cast<Index>(names.size()); ++i)
      if (is_multiplier[i] && names[i] == drive) rows.push_back(i);
    if (!rows.empty()) angles.push_back(rows.size() == 6 ? rows[3] : rows.back());
  }
  return angles;
}

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw InputError(
      fmt::format("{} does not rotate with the scene about the axis, so that no steady rotation exists; expected {}",
                  what, expected));
}

/// The constraints' values and gradients at the configuration and at the rotated one, and the forces there.
struct Trial {
  RotatingTangent here, there;
};

Trial trial(const RotatingSystem& rotating, Vec U) {
  const System& system = rotating.system;
  const KeptState kept(system, U);
  const petsc::VecHandle rotated = system.create_vector();
  petsc::check(VecCopy(U, rotated));
  VectorXd forces_aside = gather_to_all(system, rotated);
  const std::vector<char> is_multiplier = multiplier_flags(system);
  for (Index i = 0; i < forces_aside.size(); ++i)
    if (is_multiplier[i]) forces_aside[i] = 0;
  set(rotated, forces_aside);
  Trial out;
  out.here = rotating_tangent(rotating, 0, rotated);
  rotate(rotating, tried, rotated);
  out.there = rotating_tangent(rotating, 0, rotated);
  kept.restore(U);
  const Sparse back = row_rotation(rotating, -tried), forth = back.transpose();
  for (Sparse* X : {&out.there.G, &out.there.K}) *X = Sparse(back * *X) * forth;
  out.there.F = back * out.there.F;
  return out;
}

/// That K is the same at both configurations: bearings that are stiffer one way than the other make it periodic in
/// rotating axes. Entries count as the forces that rotations by one radian and what they move make.
void check_stiffness(const RotatingSystem& rotating, const Trial& at, const std::vector<char>& is_multiplier,
                     const VectorXd& reach, const std::vector<std::string>& names) {
  const VectorXd size = reach.asDiagonal() * (at.here.K.cwiseAbs() * reach);  // of each row
  const double greatest = size.size() > 0 ? size.maxCoeff() : 0;
  const Sparse difference = at.there.K - at.here.K;
  for (Index i = 0; i < size.size(); ++i)
    for (Sparse::InnerIterator entry(difference, i); entry && !is_multiplier[i]; ++entry) {
      const Index j = entry.col();
      if (is_multiplier[j]) continue;
      const double change = reach[i] * std::abs(entry.value()) * reach[j];
      if (!(change > 1e-6 * std::sqrt(size[i] * size[j]) + 1e-11 * greatest)) continue;
      refuse(
          fmt::format(
              "the stiffness acting on {}{}", names[i].empty() ? "the bodies" : names[i],
              rotating.springs.empty() ? "" : fmt::format(" (to the ground: {})", fmt::join(rotating.springs, ", "))),
          "springs and bushings to the ground that lie on the axis and are equally stiff in all directions normal to "
          "it, or whose first place rotates with the scene");
    }
}

}  // namespace

void check_rotations(const RotatingSystem& rotating, Vec U) {
  const System& system = rotating.system;
  const PetscInt unknowns = system.coordinates().global_size();
  const std::vector<std::string> names = owner_names(system.coordinates());
  const std::vector<char> is_multiplier = multiplier_flags(system);
  const std::vector<Index> angles = angle_rows(rotating, names);
  const Trial at = trial(rotating, U);
  const MassScale mass = mass_scale(rotating, at.here.M);
  // what a coordinate moves where a frame rotates by one radian
  const VectorXd reach = mass.root.unaryExpr([&](double root) { return root > 0 ? mass.rotation / root : 0.0; });
  const AllowedMotions allowed(system, at.here, mass.root);
  const VectorXd sizes = at.here.G.cwiseAbs() * reach;
  for (Index i = 0; i < unknowns; ++i) {
    if (!is_multiplier[i]) continue;
    const double size = sizes[i];
    const bool met = std::abs(at.there.F[i] - at.here.F[i]) <= 1e-7 * size ||
                     std::find(angles.begin(), angles.end(), i) != angles.end();
    if (!met || (size > 0 &&
                 allowed.restrict_rows(VectorXd(at.there.G.row(i).transpose())).norm() * mass.rotation > 1e-7 * size))
      refuse(names[i], "joints to the ground on the axis that leave the rotation about it free or drive it");
  }
  const VectorXd change = at.there.F - at.here.F, stiff = at.here.K.cwiseAbs() * reach;
  for (Index i = 0; i < unknowns; ++i)
    if (!is_multiplier[i] &&
        std::abs(change[i]) > 1e-7 * std::max(std::abs(at.here.F[i]), std::abs(at.there.F[i])) + 1e-10 * stiff[i])
      refuse("the load on " + (names[i].empty() ? "the bodies" : names[i]),
             "gravity along the axis or none, loads in axes of the body, springs to the ground on the axis");
  check_stiffness(rotating, at, is_multiplier, reach, names);
}

}  // namespace floe::solve
