#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "nas_build.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// The rigid mass whose matrix of the six motions of its node is M, from T = 1/2 m |v + w x c|^2 + 1/2 w'J w: M_vv = m
/// 1, M_vw = -m ~c, M_ww = J + m (c'c 1 - c c'). Nothing where M is that of no such mass.
std::optional<PointMass> rigid_mass(const Eigen::Matrix<double, 6, 6>& M) {
  constexpr double fields = 1e-5;  // rounded
  PointMass mass{0, M.topLeftCorner<3, 3>().trace() / 3};
  const Eigen::Matrix3d moving = M.topLeftCorner<3, 3>(), coupled = M.topRightCorner<3, 3>();
  const Eigen::Matrix3d even = (coupled + coupled.transpose()) / 2, odd = (coupled - coupled.transpose()) / 2;
  if (!(mass.mass >= 0) ||
      (moving - mass.mass * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > fields * mass.mass)
    return std::nullopt;
  if (even.cwiseAbs().maxCoeff() > fields * odd.cwiseAbs().maxCoeff()) return std::nullopt;
  if (mass.mass > 0)
    mass.offset = -Eigen::Vector3d(odd(2, 1), odd(0, 2), odd(1, 0)) / mass.mass;
  else if (!coupled.isZero(0))
    return std::nullopt;
  const Eigen::Vector3d& c = mass.offset;
  mass.inertia =
      M.bottomRightCorner<3, 3>() - mass.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  return mass;
}

/// Cards that give a grid moments of inertia alone add them to another of this grid that gives it a mass.
void add_inertia_to_masses(std::vector<NasMass>& masses) {
  std::map<long long, std::size_t> with_mass;
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (masses[i].mass.mass > 0) with_mass.try_emplace(masses[i].grid, i);
  for (const NasMass& given : masses) {
    const auto found = with_mass.find(given.grid);
    if (given.mass.mass > 0 || found == with_mass.end()) continue;
    NasMass& sum = masses[found->second];
    sum.mass.inertia += given.mass.inertia;
    sum.name += " with " + given.name;
  }
  masses.erase(std::remove_if(masses.begin(), masses.end(),
                              [&](const NasMass& m) { return !(m.mass.mass > 0) && with_mass.count(m.grid); }),
               masses.end());
}

}  // namespace

/// CMASS1 and CMASS2 of one grid together are a diagonal matrix in its displacement axes.
std::vector<NasMassMatrix> NasBuild::mass_matrices() {
  std::vector<NasMassMatrix> all = model_.mass_matrices;
  std::map<long long, std::size_t> of_grid;
  for (const NasScalarMass& one : model_.component_masses) {
    double mass = one.mass;
    if (one.property > 0) {
      const auto found = model_.scalar_masses.find(one.property);
      if (found == model_.scalar_masses.end()) {
        faults_.add(one.where,
                    fmt::format("{} {} names PMASS {}, which is not defined", one.card, one.id, one.property));
        continue;
      }
      mass = found->second;
    }
    const NasGrid* grid = frames_.grid(one.grid);
    if (!grid) {
      faults_.add(one.where, fmt::format("{} {} names grid {}, which is not defined", one.card, one.id, one.grid));
      continue;
    }
    const auto [at, fresh] = of_grid.try_emplace(one.grid, all.size());
    if (fresh)
      all.push_back({one.grid, frames_.displacement_axes(*grid), fmt::format("{} {}", one.card, one.id), one.where});
    all[at->second].matrix(one.component - 1, one.component - 1) += mass;
  }
  return all;
}

/// What is the matrix of a rigid mass becomes one, as if it were a CONM2.
std::vector<NasMass> NasBuild::all_masses() {
  std::vector<NasMass> all = model_.masses;
  for (const NasMassMatrix& given : mass_matrices()) {
    if (given.matrix.isZero(0)) continue;
    if (auto mass = rigid_mass(given.matrix)) {
      all.push_back({given.grid, given.axes, *mass, given.where, given.name});
      continue;
    }
    const auto m = given.matrix.diagonal();
    faults_.add(given.where,
                fmt::format("{}: the masses at grid {} are {:.6g}, {:.6g}, {:.6g} along the directions 1, 2, 3{}; "
                            "expected those of a rigid body, the same in all directions, or CONM2",
                            given.name, given.grid, m[0], m[1], m[2],
                            given.matrix.isDiagonal() ? "" : ", with terms between directions"));
  }
  return all;
}

/// Moments of inertia of which one exceeds the sum of the others (by 0.1 %: rounded fields) are physically impossible,
/// for example where a card gives only one: the smallest body with the largest of them is taken. With J = tr(S) 1 - S,
/// S the integral of r r^T, negative eigenvalues of S become 0.
void NasBuild::complete_inertia(Eigen::Matrix3d& inertia, const NasMass& of) {
  constexpr double rounding = 1e-9, fields = 1e-3;
  const double scale = inertia.cwiseAbs().maxCoeff();
  const auto refuse = [&] {
    faults_.add(of.where,
                of.name + ": its moments of inertia are physically impossible: one is negative about some axis");
  };
  if (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues()[0] < -rounding * scale) return refuse();
  const Eigen::Matrix3d second = inertia.trace() / 2 * Eigen::Matrix3d::Identity() - inertia;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(second);
  if (!(principal.eigenvalues()[0] < -rounding * scale)) return;
  const bool reports = principal.eigenvalues()[0] < -fields * scale;
  const Eigen::Vector3d kept = principal.eigenvalues().cwiseMax(0);
  const Eigen::Matrix3d &e = principal.eigenvectors(), was = inertia;
  inertia = kept.sum() * Eigen::Matrix3d::Identity() - Eigen::Matrix3d(e * kept.asDiagonal() * e.transpose());
  if (!reports) return;
  notices.push_back(
      fmt::format("{}: {}: its moments of inertia are physically impossible (one exceeds the sum of the "
                  "others); taken as {:.6g}, {:.6g}, {:.6g} instead of {:.6g}, {:.6g}, {:.6g}",
                  faults_.text_of(of.where), of.name, inertia(0, 0), inertia(1, 1), inertia(2, 2), was(0, 0), was(1, 1),
                  was(2, 2)));
}

std::optional<NasMass> NasBuild::in_basic_axes(NasMass given) {
  const auto x = frames_.position(given.grid, given.where);
  if (!x) return std::nullopt;
  PointMass& mass = given.mass;
  if (given.axes < 0) {
    mass.offset -= *x;
  } else {
    const Eigen::Matrix3d axes = frames_.directions(given.axes, *x, given.where);
    mass.offset = axes * mass.offset;
    mass.inertia = axes * mass.inertia * axes.transpose();
  }
  mass.mass *= model_.mass_factor;
  mass.inertia *= model_.mass_factor;
  return given;
}

void NasBuild::add_masses() {
  std::vector<NasMass> masses;
  for (const NasMass& given : all_masses())
    if (const auto mass = in_basic_axes(given)) masses.push_back(*mass);
  add_inertia_to_masses(masses);
  for (NasMass& given : masses) {
    PointMass& mass = given.mass;
    complete_inertia(mass.inertia, given);
    if (mass.mass == 0 && !mass.inertia.isZero(0)) {
      faults_.add(given.where, fmt::format("{}: grid {} has moments of inertia without a mass; expected a mass, too",
                                           given.name, given.grid));
      continue;
    }
    if (rank_ != 0) continue;
    mass.node = static_cast<PetscInt>(mesh.mentions.size());
    mesh.mentions.push_back({given.grid, given.where});
    deck.masses.push_back(mass);
  }
}

}  // namespace floe::mesh
