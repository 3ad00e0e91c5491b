#include "floe/reduction/modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "block_lanczos.h"
#include "canonical_modes.h"
#include "floe/fem/flat_body.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "mode_quality.h"
#include "multigrid.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// A rough field that depends on the dofs' original numbers only, not on ranks, zero at the conditions: the start of
/// the Krylov space, or one of them.
petsc::VecHandle start(const fem::Structure& structure, const fem::Conditions& conditions, int number = 0) {
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

/// q'K q / q'M q with the strain energy of the elements.
double rayleigh(const fem::ElementStiffness& K, Mat M, Vec q) {
  const petsc::VecHandle product = fem::field(K.structure());
  double kinetic = 0;
  check(MatMult(M, q, product));
  check(VecDot(q, product, &kinetic));
  return 2 * K.strain_energy(q) / kinetic;
}

/// A value near the lowest squared frequency of a body that is free to move: Rayleigh's quotient of a static
/// deflection.
double low_frequency(const fem::Structure& structure, const Statics& statics, Mat M) {
  petsc::VecHandle load = fem::field(structure);
  check(MatMult(M, start(structure, {}), load));
  Columns loads;
  loads.push_back(std::move(load));
  const Columns u = statics.solve(loads);
  return rayleigh(*statics.elements(), M, u[0]);
}

bool user_sets(const std::string& prefix) {
  char* all = nullptr;
  check(PetscOptionsGetAll(nullptr, &all));
  const bool found = (" " + std::string(all)).find(" -" + prefix) != std::string::npos;
  check(PetscFree(all));
  return found;
}

bool own_transformation(EPS eps, double shift) {
  double target = 0;
  check(EPSGetTarget(eps, &target));
  return target == shift && !user_sets("modes_st_");
}

/// Lets the solver of `statics` invert K, unless the user wants another operator or another solver.
void share_factor(EPS eps, Mat M, const Statics& statics) {
  ST st = nullptr;
  if (!own_transformation(eps, 0)) return;
  check(EPSGetST(eps, &st));
  check(STSetKSP(st, statics.solver()));
  if (!statics.iterates()) return;
  check(EPSSetOperators(eps, statics.exact_stiffness(), M));
  check(STSetPreconditionerMat(st, statics.stiffness()));
}

/// Where the factor is spoilt by round-off: the exact K - shift M, preconditioned by the factor of the assembled one.
void refine(EPS eps, Mat exact, Mat M, double shift, const fem::Structure& structure, const fem::Conditions& held) {
  ST st = nullptr;
  KSP ksp = nullptr;
  if (!own_transformation(eps, shift)) return;
  const petsc::MatHandle factored = fem::assemble(structure, held, 1, 1, -shift);
  check(MatSetOption(factored, MAT_SPD, PETSC_TRUE));
  check(EPSSetOperators(eps, exact, M));
  check(EPSGetST(eps, &st));
  check(STSetMatMode(st, ST_MATMODE_SHELL));
  check(STSetPreconditionerMat(st, factored));
  check(STGetKSP(st, &ksp));
  iterate(ksp, KSPCG);
}

KSP solver_of(EPS eps) {
  ST st = nullptr;
  KSP ksp = nullptr;
  check(EPSGetST(eps, &st));
  check(STGetKSP(st, &ksp));
  return ksp;
}

/// Where the user's options iterate: the assembled K - shift M as multigrid takes it, for the preconditioner.
void precondition(EPS eps, double shift, const fem::Structure& structure, const fem::ReferenceFrame& frame,
                  const fem::Conditions& held) {
  ST st = nullptr;
  const petsc::MatHandle shifted = fem::assemble(structure, held, 1, 1, -shift);
  check(EPSGetST(eps, &st));
  check(STSetMatMode(st, ST_MATMODE_SHELL));
  check(STSetPreconditionerMat(st, for_multigrid(shifted, frame, held)));
}

petsc::EpsHandle solver(Mat K, Mat M, double shift, double tolerance) {
  petsc::EpsHandle eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  register_block_lanczos();
  check(EPSCreate(PetscObjectComm(reinterpret_cast<PetscObject>(K)), eps.out()));
  check(EPSSetOptionsPrefix(eps, "modes_"));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetTolerances(eps, tolerance, PETSC_DEFAULT));
  check(EPSSetTarget(eps, shift));
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check(EPSSetPurify(eps, PETSC_FALSE));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPSetTolerances(ksp, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));  // of an iteration, by options
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  return eps;
}

/// Takes blocks where K - s M is factored, which solves for many right-hand sides at once, and the body is not small;
/// iterations solve one by one.
void prefer_blocks(EPS eps, PetscInt count, PetscInt available) {
  ST st = nullptr;
  EPSWhich which = EPS_TARGET_MAGNITUDE;
  PetscBool inverts = PETSC_FALSE, direct = PETSC_FALSE;
  check(EPSGetST(eps, &st));
  check(EPSGetWhichEigenpairs(eps, &which));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(st), STSINVERT, &inverts));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(solver_of(eps)), KSPPREONLY, &direct));
  const bool chosen = user_sets("modes_eps_type") || user_sets("modes_eps_n") || user_sets("modes_eps_mpd");
  if (chosen || which != EPS_TARGET_MAGNITUDE || !inverts || !direct || !factors(solver_of(eps))) return;
  if (4 * block_lanczos_space(count) > available) return;
  check(EPSSetType(eps, block_lanczos));
  check(EPSMonitorCancel(eps));  // options set them again
  check(EPSSetFromOptions(eps));
}

/// How many vectors the Krylov space has: three more than SLEPc's default, each of which makes the last pair's residual
/// ten times smaller or more, so that no restart is needed (nine solves for a mode more). Other solvers choose
/// themselves.
PetscInt subspace_of(EPS eps, PetscInt count, PetscInt available) {
  const PetscInt vectors = std::max(2 * count, count + 15) + 3;
  PetscBool krylov = PETSC_FALSE;
  if (block_size(eps) > 1) return std::min(block_lanczos_space(count), available);
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(eps), EPSKRYLOVSCHUR, &krylov));
  return krylov && 2 * vectors < available ? vectors : PETSC_DEFAULT;
}

/// The rigid motions that are left free, under the conditions.
Columns rigid_motions(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding) {
  Columns rigid;
  for (Eigen::Index r = 0; r < holding.left.cols(); ++r) {
    rigid.push_back(fem::field(structure));
    for (Eigen::Index i = 0; i < holding.left.rows(); ++i)
      check(VecAXPY(rigid.back(), holding.left(i, r), frame.rigid[i]));
    fem::hold(rigid.back(), holding.held);
  }
  return rigid;
}

/// EPSSolve, where a linear solve within it that fails is told by its factor, its options, or its mesh.
void solve_pairs(EPS eps, const Statics& statics) {
  try {
    check(EPSSolve(eps));
  } catch (const petsc::Error& error) {
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
          "option -modes_st_type shift: inverts the mass matrix, in which rotations may have no mass; expected "
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

}  // namespace

ModeSolver::ModeSolver(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                       const Statics& statics)
    : structure_(structure), frame_(frame), holding_(holding), statics_(statics) {}

// An EPS resets the solver it goes with: the one of `statics` is taken out first.
ModeSolver::~ModeSolver() {
  if (!eps_) return;
  ST st = nullptr;
  KSP ksp = nullptr;
  EPSGetST(eps_, &st);
  STGetKSP(st, &ksp);
  if (!statics_.owns(ksp)) return;
  petsc::KspHandle other;
  KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(ksp)), other.out());
  STSetKSP(st, other);
}

void ModeSolver::create(int count) {
  const bool moves = holding_.left.cols() > 0, shares = !moves && holding_.held == statics_.conditions();
  M_ = fem::mass(structure_, holding_.held);
  if (!shares) K_ = fem::stiffness(structure_, holding_.held);
  const double shift = moves ? -low_frequency(structure_, statics_, M_) : 0;
  // Pairs of K's factor need not be much better than that is of K.
  const double tolerance = shares ? std::clamp(1e-2 * statics_.factor_error(), 1e-10, 1e-8) : 1e-10;
  eps_ = solver(shares ? statics_.stiffness() : Mat(K_), M_, shift, tolerance);
  check(EPSSetDimensions(eps_, count, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check_options(EPSSetFromOptions(eps_), "modes_");
  exact_ = fem::stiffness_operator(statics_.elements(), holding_.held);
  if (!factors(solver_of(eps_)))
    precondition(eps_, shift, structure_, frame_, holding_.held);
  else if (shares)
    share_factor(eps_, M_, statics_);
  else if (statics_.refines())
    refine(eps_, exact_, M_, shift, structure_, holding_.held);
  prefer_blocks(eps_, count, available());
  if (!user_sets("modes_eps_n") && !user_sets("modes_eps_mpd"))
    check(EPSSetDimensions(eps_, count, subspace_of(eps_, count, available()), PETSC_DEFAULT));
}

PetscInt ModeSolver::available() const {
  if (available_ >= 0) return available_;
  const petsc::VecHandle masses = fem::field(structure_);
  check(MatGetDiagonal(fem::mass(structure_, {}), masses));
  fem::hold(masses, holding_.held);
  petsc::Values own(masses);
  PetscInt moving = std::count_if(own.begin(), own.begin() + structure_.owned_dofs(), [](double m) { return m > 0; });
  MPI_Allreduce(MPI_IN_PLACE, &moving, 1, MPIU_INT, MPI_SUM, structure_.mesh.comm);
  return available_ = moving - static_cast<PetscInt>(holding_.left.cols());
}

namespace {

/// `count` pairs at least, and those that have converged of `wanted`.
Found pairs(EPS eps, const fem::Structure& structure, const fem::Conditions& held, const Columns& rigid,
            const Statics& statics, int count, int wanted) {
  std::vector<Vec> deflated(rigid.begin(), rigid.end());
  if (!deflated.empty()) check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(deflated.size()), deflated.data()));
  Columns first;
  for (int i = 0; i < block_size(eps); ++i) first.push_back(start(structure, held, i));
  std::vector<Vec> initial(first.begin(), first.end());
  check(EPSSetInitialSpace(eps, static_cast<PetscInt>(initial.size()), initial.data()));
  solve_pairs(eps, statics);
  check_converged(eps, count);
  PetscInt converged = 0;
  check(EPSGetConverged(eps, &converged));
  Found found;
  found.lambda.resize(std::min<PetscInt>(converged, wanted));
  for (int i = 0; i < std::ssize(found.lambda); ++i) {
    found.raw.push_back(fem::field(structure));
    check(EPSGetEigenpair(eps, i, &found.lambda[i], nullptr, found.raw.back(), nullptr));
    fem::hold(found.raw.back(), held);
  }
  return found;
}

/// How many of the pairs have the frequency of the last one counted, but come after it.
int left_out(const std::vector<double>& lambda, int count) {
  for (const auto& [first, end] : clusters(lambda))
    if (first < count && count <= end) return end - count;
  return 0;
}

/// The pairs, with all of the last one's frequency. One more than counted shows whether there are some.
Found complete_pairs(EPS eps, const fem::Structure& structure, const fem::Conditions& held, const Columns& rigid,
                     const Statics& statics, int count, int available) {
  const bool bounded = user_sets("modes_eps_ncv");  // the user's subspace holds one vector more than is asked for
  PetscInt asked = 0, subspace = 0;
  check(EPSGetDimensions(eps, &asked, &subspace, nullptr));
  if (bounded) available = std::min(available, std::max<int>(count, subspace - 1));
  for (int more = 1;; more *= 2) {
    const int wanted = std::min(count + more, available);
    check(EPSGetDimensions(eps, &asked, nullptr, nullptr));
    if (asked < wanted || asked > available)
      check(EPSSetDimensions(eps, wanted, bounded ? subspace : subspace_of(eps, wanted, available), PETSC_DEFAULT));
    Found found = pairs(eps, structure, held, rigid, statics, count, wanted);
    const int have = static_cast<int>(found.lambda.size()), equal = left_out(found.lambda, count);
    if (count + equal == have && have == wanted && wanted < available && more < 16) continue;
    found.lambda.resize(count + equal);
    found.raw.resize(count + equal);
    return found;
  }
}

}  // namespace

Modes ModeSolver::solve(int count) {
  Modes modes;
  if (count <= 0) return modes;
  if (count > available())
    throw InputError(
        fmt::format("{} modes are asked of a body that has {} elastic dofs under its conditions", count, available()));
  if (!eps_) create(std::min<int>(count + 1, static_cast<int>(available())));
  const petsc::Stage stage("modes");
  const Transformation inverse(eps_, statics_, holding_.held);
  const bool shares = statics_.owns(inverse.ksp);
  Found found = complete_pairs(eps_, structure_, holding_.held, rigid_motions(structure_, frame_, holding_), statics_,
                               count, static_cast<int>(available()));
  std::vector<double> errors;
  if (inverse.ksp) errors = purify(inverse, M_, holding_.held, found);
  modes.raw = std::move(found.raw);
  for (const auto& mode : modes.raw) fem::separate(structure_, mode, 1e-7);
  std::vector<double> lambda =
      exact_values(*statics_.elements(), M_, shares && statics_.refines() && !statics_.iterates(), modes.raw);
  make_canonical(structure_, M_, modes.raw, lambda);
  for (const auto& [first, end] : clusters(lambda))
    if (!errors.empty())
      std::fill(errors.begin() + first, errors.begin() + end,
                *std::max_element(errors.begin() + first, errors.begin() + end));
  modes.left_out = static_cast<int>(modes.raw.size()) - count;
  modes.raw.resize(count), lambda.resize(count), errors.resize(inverse.ksp ? count : 0);
  for (int i = 0; i < count; ++i) {
    fem::separate(structure_, modes.raw[i], 1e-7);
    fix_sign(structure_, modes.raw[i]);
    modes.omega.push_back(std::sqrt(lambda[i]));
    modes.shapes.push_back(copy(modes.raw[i]));
    if (!holds_frame(frame_, holding_.held)) fem::to_frame(frame_, modes.shapes.back());
  }
  if (shares && !statics_.iterates())  // of K's factor, and what that misses
    for (double error : errors) modes.residual.push_back(error + statics_.factor_error());
  else if (inverse.ksp)
    modes.residual = residuals(inverse, exact_, M_, holding_.held, modes.raw, lambda);
  else
    modes.residual = relative_errors(eps_, count);
  for (int i = 0; i < count; ++i) {
    if (modes.residual[i] <= 1e-2 || std::abs(found.lambda[i] / lambda[i] - 1) <= 1e-3) continue;
    if (!statics_.refines())
      throw RunError(
          fmt::format("mode {} of {} cannot be told from motions without mass; ask for fewer modes", i + 1, count));
    throw too_fine(structure_, fmt::format("mode {} lies between {:.4g} and {:.4g} rad/s", i + 1,
                                           std::sqrt(std::min(lambda[i], std::abs(found.lambda[i]))),
                                           std::sqrt(std::max(lambda[i], std::abs(found.lambda[i])))));
  }
  return modes;
}

Modes vibration_modes(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int count) {
  return ModeSolver(structure, frame, holding, statics).solve(count);
}

}  // namespace floe::reduction
