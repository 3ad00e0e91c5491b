#include "mode_pairs.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "block_lanczos.h"
#include "canonical_modes.h"
#include "eigenvalue_count.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/options.h"
#include "floe/petsc/values.h"
#include "multigrid.h"

namespace floe::reduction {

using petsc::check;

petsc::VecHandle rough_field(const fem::Structure& structure, const fem::Conditions& conditions, int number) {
  petsc::VecHandle x = fem::field(structure);
  PetscInt first = 0, end = 0;
  double* values = nullptr;
  check(VecGetOwnershipRange(x, &first, &end));
  check(VecGetArrayWrite(x, &values));
  const double length = fem::extent(structure);  // rotations of the size that displacements give, in any units
  for (PetscInt i = 0; i < end - first; ++i) {
    const bool rotation = i % structure.dofs_per_node >= structure.dimension();
    values[i] =
        (std::sin((12.9898 + 1.6180 * number) * double(structure.original_dof(static_cast<int>(i)) + 1)) + 0.5) *
        (rotation ? 1 / length : 1);
  }
  check(VecRestoreArrayWrite(x, &values));
  fem::hold(x, conditions);
  return x;
}

KSP solver_of(EPS eps) {
  ST st = nullptr;
  KSP ksp = nullptr;
  check(EPSGetST(eps, &st));
  check(STGetKSP(st, &ksp));
  return ksp;
}

PetscInt subspace_of(EPS eps, PetscInt count, PetscInt available) {
  const PetscInt vectors = std::max(2 * count, count + 15) + 3;
  PetscBool krylov = PETSC_FALSE;
  if (block_size(eps) > 1) return std::min(block_lanczos_space(count), available);
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(eps), EPSKRYLOVSCHUR, &krylov));
  return krylov && 2 * vectors < available ? vectors : PETSC_DEFAULT;
}

namespace {

/// EPSSolve, where a linear solve within it that fails is told by its factor, its options, or its mesh.
void solve_pairs(EPS eps, const Statics& statics) {
  try {
    check(EPSSolve(eps));
  } catch (const petsc::Error& error) {
    if (error.code() == PETSC_ERR_SUP || error.code() == PETSC_ERR_USER_INPUT)
      throw InputError(std::string("an option -modes_... is rejected: ") + error.what());
    ST st = nullptr;
    KSP ksp = nullptr;
    const char* prefix = nullptr;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check(EPSGetST(eps, &st));
    check(STGetKSP(st, &ksp));
    const petsc::FactorFault fault = petsc::factor_fault(ksp);
    PetscBool inverts_mass = PETSC_FALSE;
    check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(st), STSHIFT, &inverts_mass));
    if (inverts_mass && !fault.text.empty())
      throw InputError(
          "option -modes_st_type shift: inverts the mass matrix, which may be singular (rotations); expected "
          "sinvert");
    if (!fault.text.empty()) throw RunError(fault.text);
    if (error.code() != PETSC_ERR_NOT_CONVERGED) throw;
    if (statics.refines()) throw too_fine(statics.elements()->structure(), "its modes do not converge");
    check(KSPGetOptionsPrefix(ksp, &prefix));
    check(KSPGetConvergedReason(ksp, &reason));
    throw RunError(fmt::format("a linear solve for the modes (options -{}ksp_...) did not converge: {}",
                               prefix ? prefix : "", KSPConvergedReasons[reason]));
  }
}

void check_converged(EPS eps, int count) {
  PetscInt converged = 0, iterations = 0;
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  check(EPSGetConverged(eps, &converged));
  check(EPSGetConvergedReason(eps, &reason));
  check(EPSGetIterationNumber(eps, &iterations));
  if (converged < count)
    throw RunError(
        fmt::format("the eigenvalue solver (options -modes_eps_...) found {} of {} modes in {} iterations: {}",
                    converged, count, iterations, EPSConvergedReasons[reason]));
}

/// What the EPS leaves out from now on.
///
/// The vectors that it left out before become columns of its BV. Where these are then as many as the next subspace
/// needs, SLEPc 3.18 takes its arrays for large enough, which are as long as the last one: it writes behind them. So
/// the BV is made small.
void deflate(EPS eps, std::vector<Vec> deflated) {
  check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(deflated.size()), deflated.data()));
  BV V = nullptr;
  PetscInt columns = 0;
  check(EPSGetBV(eps, &V));
  check(BVGetSizes(V, nullptr, nullptr, &columns));
  if (!deflated.empty() && columns > 1) check(BVResize(V, 1, PETSC_FALSE));
}

/// `count` pairs at least, and those that have converged of `wanted`, with `deflated` left out.
/// @param seed  of the vectors to start with
Found pairs(const PairSearch& search, std::vector<Vec> deflated, int seed, int count, int wanted) {
  const EPS eps = search.eps;
  deflate(eps, std::move(deflated));
  Columns first;
  for (int i = 0; i < block_size(eps); ++i)
    first.push_back(rough_field(search.structure, search.constrained, seed + i));
  std::vector<Vec> initial(first.begin(), first.end());
  check(EPSSetInitialSpace(eps, static_cast<PetscInt>(initial.size()), initial.data()));
  solve_pairs(eps, search.statics);
  check_converged(eps, count);
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  Found found;
  for (int i = 0; i < std::min<PetscInt>(converged, wanted); ++i) {
    petsc::VecHandle x = fem::field(search.structure);
    double lambda = 0, error = 0;
    check(EPSGetEigenpair(eps, i, &lambda, nullptr, x, nullptr));
    if (search.errors) check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
    fem::hold(x, search.constrained);
    found.add(lambda, std::move(x), error);
  }
  return found;
}

/// Pairs of `more` go where they belong.
void merge(Found& found, Found more) {
  for (std::size_t i = 0; i < more.lambda.size(); ++i) found.add(more.lambda[i], std::move(more.raw[i]), more.error[i]);
  std::vector<std::size_t> order(found.lambda.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return found.lambda[i] < found.lambda[j]; });
  Found sorted;
  for (std::size_t i : order) sorted.add(found.lambda[i], std::move(found.raw[i]), found.error[i]);
  found = std::move(sorted);
}

}  // namespace

int left_out(const std::vector<double>& lambda, int count) {
  for (const auto& [first, end] : clusters(lambda))
    if (first < count && count <= end) return end - count;
  return 0;
}

namespace {

/// The user's subspace, or nothing.
std::optional<PetscInt> user_subspace(EPS eps) {
  PetscInt subspace = 0;
  if (!petsc::user_sets("modes_eps_ncv")) return std::nullopt;
  check(EPSGetDimensions(eps, nullptr, &subspace, nullptr));
  return subspace;
}

/// The pairs, with all of the last one's frequency, and one more where there is one, which shows that these are all.
Found pairs_and_next(const PairSearch& search, int count) {
  const std::optional<PetscInt> bound = user_subspace(search.eps);
  const PetscInt b = block_size(search.eps),
                 beside = b > 1 ? 3 * b : 1;  // vectors that a solver needs beside the pairs
  const int available =
      bound ? std::min<int>(search.available, std::max<int>(count, *bound - beside)) : search.available;
  const std::vector<Vec> rigid(search.rigid.begin(), search.rigid.end());
  PetscInt asked = 0;
  for (int more = 1;; more *= 2) {
    const int wanted = std::min(count + more, available);
    check(EPSGetDimensions(search.eps, &asked, nullptr, nullptr));
    if (asked < wanted || asked > available)
      check(EPSSetDimensions(search.eps, wanted, bound ? *bound : subspace_of(search.eps, wanted, available),
                             PETSC_DEFAULT));
    Found found = pairs(search, rigid, 0, count, wanted);
    const int have = static_cast<int>(found.lambda.size());
    if (!search.lowest || count + left_out(found.lambda, count) < have || have < wanted || wanted == available ||
        more >= 16)
      return found;
  }
}

/// Pairs may be missing where as many frequencies as a block has vectors, or more, lie within 5 % (all of that, where
/// nothing but round-off tells equal ones apart). One vector finds one.
bool may_lack(EPS eps, const std::vector<double>& lambda) {
  const std::size_t b = block_size(eps);
  for (std::size_t i = 0; i + b <= lambda.size(); ++i)
    if (lambda[i + b - 1] < 1.1 * lambda[i]) return true;
  return false;
}

/// The run of equal frequencies to which the last pair that counts belongs.
std::pair<int, int> last_cluster(const std::vector<double>& lambda, int count) {
  const auto all = clusters(lambda);
  return *std::find_if(all.begin(), all.end(), [&](const auto& run) { return count <= run.second; });
}

/// Behind all pairs of the last one's frequency, found or not: halfway to the next one, if that is known.
double bound_of(const std::vector<double>& lambda, int count) {
  const int end = last_cluster(lambda, count).second;
  if (end < static_cast<int>(lambda.size())) return std::sqrt(lambda[end - 1] * lambda[end]);
  return lambda[end - 1] * (1 + 1e-6);
}

/// Most pairs of the last one's frequency that are looked for: make_canonical() needs all of them.
int most_equal(int count) { return 4 * count + 256; }

/// Looks for what lies below the bound and is not found.
/// @param missing  how many; nothing: until none is found
/// @param most     pairs in all: where more are found, the search ends
/// @return         how many of them are still not found
PetscInt find_missing(const PairSearch& search, double bound, std::optional<PetscInt> missing, std::size_t most,
                      Found& found) {
  int seed = 0;
  while (!missing || *missing > 0) {
    const int left = search.available - static_cast<int>(found.raw.size());
    const int wanted = std::min<int>(left, missing ? std::min<int>(*missing, block_size(search.eps)) : 1);
    if (wanted <= 0) break;
    std::vector<Vec> deflated(search.rigid.begin(), search.rigid.end());
    deflated.insert(deflated.end(), found.raw.begin(), found.raw.end());
    if (!user_subspace(search.eps))
      check(EPSSetDimensions(search.eps, wanted, subspace_of(search.eps, wanted, left), PETSC_DEFAULT));
    Found more = pairs(search, deflated, seed += 64, 1, left);
    const auto below = std::count_if(more.lambda.begin(), more.lambda.end(), [&](double l) { return l < bound; });
    if (below == 0) break;
    more.resize(std::size_t(below));
    if (missing) *missing -= static_cast<PetscInt>(below);
    merge(found, std::move(more));
    if (found.raw.size() + static_cast<std::size_t>(std::max<PetscInt>(missing.value_or(0), 0)) > most) break;
  }
  return missing ? std::max<PetscInt>(*missing, 0) : 0;
}

/// Bodies of which a factorisation is no expense.
constexpr PetscInt cheap_dofs = 20000;

void complete(const PairSearch& search, int count, Found& found) {
  if (static_cast<int>(found.lambda.size()) >= search.available) return;
  const bool factored = factors(solver_of(search.eps));
  if (factored && search.structure.dofs() > cheap_dofs && !may_lack(search.eps, found.lambda)) return;
  const double bound = bound_of(found.lambda, count);
  const bool open = last_cluster(found.lambda, count).second == std::ssize(found.lambda);
  const auto below = std::count_if(found.lambda.begin(), found.lambda.end(), [&](double l) { return l < bound; });
  std::optional<PetscInt> missing;
  if (factored) missing = eigenvalues_below(search.structure, search.constrained, bound);
  if (missing) *missing -= static_cast<PetscInt>(below) + static_cast<PetscInt>(search.rigid.size());
  const std::size_t most = count + most_equal(count), before = found.raw.size();
  const PetscInt left = find_missing(search, bound, missing, most, found);
  const std::size_t equal = found.raw.size() + static_cast<std::size_t>(left);
  if (open && found.raw.size() > before && equal > most) {
    const int first = last_cluster(found.lambda, count).first;
    throw InputError(fmt::format("modes {} to {}{} have the same frequency; ask for {}as many", first + 1,
                                 missing ? "" : "more than ", equal,
                                 first > 0 ? fmt::format("{}, or for ", first) : ""));
  }
  // Round-off of the factor moves eigenvalues that are as near to the bound as it is great.
  const auto near = [&](double l) { return std::abs(l / bound - 1) < 1e-5; };
  if (left == 0 || search.statics.refines() || std::any_of(found.lambda.begin(), found.lambda.end(), near)) return;
  throw RunError(
      fmt::format("{} of the modes below {:.6g} Hz are not found, as counted by the inertia of K - s M; other "
                  "vectors may find them (-modes_eps_block_lanczos_size, -modes_eps_ncv), or another number of modes",
                  left, std::sqrt(bound) / (2 * M_PI)));
}

/// @throws InputError  the EPS finds rigid motions
void refuse_rigid(const PairSearch& search, Mat M, const Found& found) {
  const Eigen::Index r = static_cast<Eigen::Index>(search.rigid.size());
  if (r == 0) return;
  const petsc::VecHandle product = fem::field(search.structure);
  Eigen::MatrixXd G(r, r);
  Eigen::VectorXd along(r);
  EPSType type = nullptr;
  for (Eigen::Index i = 0; i < r; ++i) {
    check(MatMult(M, search.rigid[i], product));
    for (Eigen::Index j = 0; j < r; ++j) check(VecDot(search.rigid[j], product, &G(j, i)));
  }
  const Eigen::LDLT<Eigen::MatrixXd> inverse(G);
  for (const petsc::VecHandle& x : found.raw) {
    double size = 0;
    check(MatMult(M, x, product));
    check(VecDot(x, product, &size));
    for (Eigen::Index i = 0; i < r; ++i) check(VecDot(search.rigid[i], product, &along[i]));
    if (!(along.dot(inverse.solve(along)) > 0.5 * size)) continue;
    check(EPSGetType(search.eps, &type));
    throw InputError(fmt::format(
        "option -modes_eps_type {}: does not deflate the rigid motions of a free body; expected krylovschur, "
        "block-lanczos or another type with deflation",
        type));
  }
}

}  // namespace

Found lowest_pairs(const PairSearch& search, Mat M, int count) {
  Found found = pairs_and_next(search, count);
  refuse_rigid(search, M, found);
  if (!search.lowest) {
    found.resize(count);
    merge(found, {});
    return found;
  }
  merge(found, {});
  complete(search, count, found);
  found.resize(count + left_out(found.lambda, count));
  return found;
}

}  // namespace floe::reduction
