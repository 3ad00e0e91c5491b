#include "static_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/fem/field_rows.h"
#include "floe/petsc/values.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// A response of which those before it hold more than all but this share of the energy is solved for again.
constexpr double weak = 1e-2;

/// And once more while what the others hold moves the body by more than this share of it, if that is more of its load
/// than round-off.
constexpr double apart = 1e-9, round_off = 1e-15;

/// A load, or a response, of which no more is left is round-off.
constexpr double nothing_left = 1e-9, no_response = 1e-13;

constexpr const char* silent = "does not deform the body";

/// A pass gains as many digits as a solve has; more than a few find round-off.
constexpr int most_passes = 6;

/// Of a load, where a moment counts as the force that has it over the body's extent. [N] Collective.
double size_of_load(const fem::Structure& structure, Vec load) {
  const int n = structure.dofs_per_node;
  const double length = fem::extent(structure);
  double square = 0;
  {
    petsc::Values own(load);
    for (PetscInt i = own.first; i < own.end; ++i)
      square += std::pow(i % n < structure.dimension() ? own[i] : own[i] / length, 2);
  }
  MPI_Allreduce(MPI_IN_PLACE, &square, 1, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return std::sqrt(square);
}

/// A unit load and the response to it.
struct Load {
  std::size_t attachment;
  petsc::VecHandle f, u;
  double size = 0;           ///< of f
  bool again = false;        ///< solved for again
  std::string dropped = {};  ///< why, if it is
  bool alive() const { return dropped.empty(); }
};

/// What is taken off a load.
struct Share {
  std::size_t load;
  double times;
};

/// f_i'u_j over the sizes of both loads, by what is not zero of f; the same on all ranks. Collective.
Eigen::MatrixXd compliance(const fem::Structure& structure, const std::vector<Load*>& loads) {
  const Eigen::Index count = std::ssize(loads);
  std::vector<std::vector<std::pair<PetscInt, double>>> forces(count);  // of each load, where it acts
  for (Eigen::Index i = 0; i < count; ++i) {
    petsc::Values f(loads[i]->f);
    for (PetscInt dof = f.first; dof < f.end; ++dof)
      if (f[dof] != 0) forces[i].push_back({dof, f[dof]});
  }
  Eigen::MatrixXd mine = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    petsc::Values u(loads[j]->u);
    for (Eigen::Index i = 0; i < count; ++i)
      for (const auto& [dof, force] : forces[i]) mine(i, j) += force * u[dof] / (loads[i]->size * loads[j]->size);
  }
  Eigen::MatrixXd all = mine;
  MPI_Reduce(mine.data(), all.data(), static_cast<int>(mine.size()), MPI_DOUBLE, MPI_SUM, 0, structure.mesh.comm);
  MPI_Bcast(all.data(), static_cast<int>(all.size()), MPI_DOUBLE, 0, structure.mesh.comm);
  return all;
}

/// The next column of a Cholesky factor: of almost equal pivots the first, whatever their round-off.
Eigen::Index next_pivot(const Eigen::VectorXd& left, const std::vector<char>& done) {
  Eigen::Index best = -1;
  for (const double share : {0.0, 0.5}) {
    const double least = best < 0 ? -1 : share * left[best];
    Eigen::Index found = -1;
    for (Eigen::Index j = 0; j < left.size(); ++j) {
      if (done[j] || left[j] < least) continue;
      if (found < 0 || (share == 0 && left[j] > left[found])) found = j;
    }
    best = found;
  }
  return best;
}

/// Of each load what is to be taken off it: nothing where it shares little with those before it.
std::vector<std::vector<Share>> shares(const Eigen::MatrixXd& C, const std::vector<Load*>& loads) {
  const Eigen::Index count = C.rows();
  const Eigen::VectorXd roots = C.diagonal().cwiseMax(0).cwiseSqrt();
  std::vector<std::vector<Share>> all(count);
  std::vector<char> done(count, 0);
  std::vector<Eigen::Index> taken;
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(count, count);  // K-orthonormal combinations of scaled loads
  Eigen::VectorXd common = Eigen::VectorXd::Zero(count);        // of the energy 1 of each scaled response
  const auto scaled = [&](Eigen::Index i, Eigen::Index j) {  // of the softer load on the stiffer response: more digits
    if (!(roots[i] > 0 && roots[j] > 0)) return 0.;
    return (roots[i] < roots[j] ? C(j, i) : C(i, j)) / (roots[i] * roots[j]);
  };
  for (Eigen::Index step = 0; step < count; ++step) {
    const Eigen::VectorXd left = (1 - common.array()).max(0) * roots.array().square();
    const Eigen::Index j = next_pivot(left, done);
    done[j] = 1;
    const double share = std::max(0., 1 - common[j]);
    const auto still_in_it = [&](Eigen::Index i) {
      const double times = std::abs(T(i, j)), contrast = roots[i] / roots[j];
      return times * contrast > apart && times > round_off * contrast;
    };
    if (share < weak || (loads[j]->again && std::any_of(taken.begin(), taken.end(), still_in_it)))
      for (const Eigen::Index i : taken)
        if (T(i, j) != 0) all[j].push_back({static_cast<std::size_t>(i), -T(i, j)});
    if (share < weak) continue;  // what it is beside the others is seen in the next pass
    T.col(j) /= std::sqrt(share);
    taken.push_back(j);
    for (Eigen::Index k = 0; k < count; ++k) {
      if (done[k]) continue;
      double along = 0;
      for (const Eigen::Index i : taken) along += T(i, j) * scaled(i, k);
      T.col(k) -= along * T.col(j);
      common[k] += along * along;
    }
  }
  for (Eigen::Index j = 0; j < count; ++j)  // of loads as they are
    for (Share& each : all[j])
      each.times *= roots[j] * loads[j]->size / (roots[static_cast<Eigen::Index>(each.load)] * loads[each.load]->size);
  return all;
}

/// The load whose multiple another one is, or all it is made of.
std::string names(const std::vector<Share>& parts, const std::vector<Load*>& loads,
                  const std::vector<Attachment>& attachments) {
  double greatest = 0;
  for (const Share& part : parts) greatest = std::max(greatest, std::abs(part.times) * loads[part.load]->size);
  std::vector<std::string> all;
  for (const Share& part : parts)
    if (std::abs(part.times) * loads[part.load]->size > 1e-6 * greatest)
      all.push_back(attachments[loads[part.load]->attachment].label);
  return fmt::format("{}", fmt::join(all, ", "));
}

/// u = K^-1 f of some loads, by one block solve.
void respond(const fem::Structure& structure, const Statics& statics, const std::vector<Load*>& loads) {
  Columns f;
  for (const Load* load : loads) f.push_back(copy(load->f));
  Columns u = statics.solve(f);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    fem::separate(structure, u[i], 1e-9);
    loads[i]->u = std::move(u[i]);
  }
}

/// Takes off each load what those before it hold. @return those that are to be solved for
std::vector<Load*> take_off(const fem::Structure& structure, const std::vector<Attachment>& attachments,
                            const std::vector<Load*>& loads) {
  const std::vector<std::vector<Share>> parts = shares(compliance(structure, loads), loads);
  std::vector<petsc::VecHandle> lessened(loads.size());  // after the old ones, which others still need
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (parts[j].empty()) continue;
    lessened[j] = copy(loads[j]->f);
    double sum = loads[j]->size;
    for (const Share& part : parts[j]) {
      check(VecAXPY(lessened[j], -part.times, loads[part.load]->f));
      sum += std::abs(part.times) * loads[part.load]->size;
    }
    if (size_of_load(structure, lessened[j]) <= nothing_left * sum)
      loads[j]->dropped = "repeats " + names(parts[j], loads, attachments);
  }
  std::vector<Load*> again;
  for (std::size_t j = 0; j < loads.size(); ++j) {
    if (!lessened[j]) continue;
    loads[j]->f = std::move(lessened[j]);
    loads[j]->size = size_of_load(structure, loads[j]->f);
    loads[j]->again = true;
    if (loads[j]->dropped.empty()) again.push_back(loads[j]);
  }
  return again;
}

/// Loads without a response are dropped: those where the body is constrained.
void drop_silent(const fem::Structure& structure, std::vector<Load>& loads) {
  const petsc::MatHandle M = fem::mass(structure, {});
  double greatest = 0;
  std::vector<double> norms;
  for (const Load& load : loads) {
    norms.push_back(load.alive() && load.size > 0 ? mass_norm(M, load.u) / load.size : 0);
    greatest = std::max(greatest, norms.back());
  }
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (loads[i].alive() && norms[i] <= no_response * greatest) loads[i].dropped = silent;
}

}  // namespace

StaticColumns static_columns(const fem::Structure& structure, const Statics& statics,
                             const std::vector<Attachment>& attachments) {
  std::vector<Load> loads;
  Columns moved;
  for (std::size_t i = 0; i < attachments.size(); ++i)
    if (attachments[i].load)
      loads.push_back({i, copy(attachments[i].load), {}, size_of_load(structure, attachments[i].load)});
    else
      moved.push_back(copy(attachments[i].moved));
  const auto alive = [&] {
    std::vector<Load*> all;
    for (Load& load : loads)
      if (load.alive()) all.push_back(&load);
    return all;
  };
  std::vector<Load*> again = alive();
  for (int pass = 0; !again.empty() && pass < most_passes; ++pass) {
    respond(structure, statics, again);
    drop_silent(structure, loads);
    again = take_off(structure, attachments, alive());
  }
  respond(structure, statics, again);
  StaticColumns result;
  Columns constrained = statics.constraint_modes(moved);
  auto load = loads.begin();
  auto constraint = constrained.begin();
  const petsc::MatHandle M = fem::mass(structure, {});
  for (const Attachment& attachment : attachments) {
    ColumnOrigin origin{ColumnOrigin::Kind::attachment, "attachment " + attachment.label};
    origin.of_higher_vector = attachment.of_higher_vector;
    if (attachment.load) {
      origin.dropped = load->dropped;
      result.columns.push_back(std::move(load++->u));
    } else {
      result.columns.push_back(std::move(*constraint++));
      if (mass_norm(M, result.columns.back()) == 0) origin.dropped = silent;
    }
    origin.kept = origin.dropped.empty();
    if (!origin.kept) origin.new_part = 0;
    result.origins.push_back(std::move(origin));
  }
  return result;
}

}  // namespace floe::reduction
