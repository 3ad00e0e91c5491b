#include "floe/reduction/modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "block_lanczos.h"
#include "canonical_modes.h"
#include "floe/fem/flat_body.h"
#include "floe/petsc/factorisation.h"
#include "floe/petsc/options.h"
#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "mode_pairs.h"
#include "multigrid.h"
#include "subdomains.h"

namespace floe::reduction {

using petsc::check;

namespace {

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
  check(MatMult(M, rough_field(structure, {}), load));
  Columns loads;
  loads.push_back(std::move(load));
  const Columns u = statics.solve(loads);
  return rayleigh(*statics.elements(), M, u[0]);
}

bool own_transformation(EPS eps, double shift) {
  double target = 0;
  check(EPSGetTarget(eps, &target));
  return target == shift && !petsc::user_sets("modes_st_");
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
void refine(EPS eps, Mat exact, Mat M, double shift, const fem::Structure& structure,
            const fem::Conditions& constrained) {
  ST st = nullptr;
  KSP ksp = nullptr;
  if (!own_transformation(eps, shift)) return;
  const petsc::MatHandle factored = fem::assemble(structure, constrained, 1, 1, -shift);
  check(MatSetOption(factored, MAT_SPD, PETSC_TRUE));
  check(EPSSetOperators(eps, exact, M));
  check(EPSGetST(eps, &st));
  check(STSetMatMode(st, ST_MATMODE_SHELL));
  check(STSetPreconditionerMat(st, factored));
  check(STGetKSP(st, &ksp));
  iterate(ksp, KSPGMRES);
}

/// Where the user's options iterate: K - shift M as their preconditioner takes it.
void precondition(EPS eps, double shift, const fem::Structure& structure, const fem::ReferenceFrame& frame,
                  const fem::Conditions& constrained) {
  ST st = nullptr;
  check(EPSGetST(eps, &st));
  check(STSetMatMode(st, ST_MATMODE_SHELL));
  check(STSetPreconditionerMat(st, for_iteration(solver_of(eps), {structure, frame, constrained, shift})));
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

/// K x = lambda M x is what every result is made from, and its transformed operator is solved with, not preconditioned.
void refuse_other_operators(EPS eps) {
  ST st = nullptr;
  EPSProblemType type = EPS_GHEP;
  PetscBool solves = PETSC_TRUE;
  check(EPSGetProblemType(eps, &type));
  if (type == EPS_HEP || type == EPS_NHEP)
    throw InputError(
        "options -modes_eps_hermitian, -modes_eps_non_hermitian: modes solve a generalized problem with K and M");
  check(EPSGetST(eps, &st));
  check(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(st), &solves, STSINVERT, STCAYLEY, STSHIFT, ""));
  if (solves) petsc::refuse_preconditioner_alone(solver_of(eps));
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
  const bool chosen =
      petsc::user_sets("modes_eps_type") || petsc::user_sets("modes_eps_n") || petsc::user_sets("modes_eps_mpd");
  if (chosen || which != EPS_TARGET_MAGNITUDE || !inverts || !direct || !factors(solver_of(eps))) return;
  if (4 * block_lanczos_space(count) > available) return;
  check(EPSSetType(eps, block_lanczos));
  check(EPSMonitorCancel(eps));  // options set them again
  check(EPSSetFromOptions(eps));
}

/// Whether no option chooses other pairs than those next to the shift.
bool finds_lowest(EPS eps, double shift) {
  double target = 0;
  EPSWhich which = EPS_TARGET_MAGNITUDE;
  check(EPSGetTarget(eps, &target));
  check(EPSGetWhichEigenpairs(eps, &which));
  return which == EPS_TARGET_MAGNITUDE && target == shift;
}

/// The rigid motions that are left free, under the conditions.
Columns rigid_motions(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding) {
  Columns rigid;
  for (Eigen::Index r = 0; r < holding.left.cols(); ++r) {
    rigid.push_back(fem::field(structure));
    for (Eigen::Index i = 0; i < holding.left.rows(); ++i)
      check(VecAXPY(rigid.back(), holding.left(i, r), frame.rigid[i]));
    fem::hold(rigid.back(), holding.constrained);
  }
  return rigid;
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
  const bool moves = holding_.left.cols() > 0, shares = !moves && holding_.constrained == statics_.conditions();
  M_ = fem::mass(structure_, holding_.constrained);
  if (!shares) K_ = fem::stiffness(structure_, holding_.constrained);
  const double shift = moves ? -low_frequency(structure_, statics_, M_) : 0;
  // Pairs of K's factor need not be much better than that is of K.
  const double tolerance = shares ? std::clamp(1e-2 * statics_.factor_error(), 1e-10, 1e-8) : 1e-10;
  shift_ = shift;
  eps_ = solver(shares ? statics_.stiffness() : Mat(K_), M_, shift, tolerance);
  check(EPSSetDimensions(eps_, count, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check_options(EPSSetFromOptions(eps_), "modes_");
  refuse_other_operators(eps_);
  exact_ = fem::stiffness_operator(statics_.elements(), holding_.constrained);
  if (!factors(solver_of(eps_)))
    precondition(eps_, shift, structure_, frame_, holding_.constrained);
  else if (shares)
    share_factor(eps_, M_, statics_);
  else if (statics_.refines())
    refine(eps_, exact_, M_, shift, structure_, holding_.constrained);
  prefer_blocks(eps_, count, available());
  if (!petsc::user_sets("modes_eps_n") && !petsc::user_sets("modes_eps_mpd"))
    check(EPSSetDimensions(eps_, count, subspace_of(eps_, count, available()), PETSC_DEFAULT));
}

PetscInt ModeSolver::available() const {
  if (available_ >= 0) return available_;
  const petsc::VecHandle masses = fem::field(structure_);
  check(MatGetDiagonal(fem::mass(structure_, {}), masses));
  fem::hold(masses, holding_.constrained);
  petsc::Values own(masses);
  PetscInt moving = std::count_if(own.begin(), own.begin() + structure_.owned_dofs(), [](double m) { return m > 0; });
  MPI_Allreduce(MPI_IN_PLACE, &moving, 1, MPIU_INT, MPI_SUM, structure_.mesh.comm);
  return available_ = moving - static_cast<PetscInt>(holding_.left.cols());
}

Modes ModeSolver::solve(int count) {
  if (count <= 0) return {};
  if (count > available())
    throw InputError(
        fmt::format("{} modes requested of a body that has {} elastic dofs under its conditions", count, available()));
  try {
    return found(count);
  } catch (const petsc::Error& error) {
    if (error.code() != PETSC_ERR_NOT_CONVERGED) throw;
    throw too_fine(structure_, "its modes do not converge");
  }
}

Modes ModeSolver::found(int count) {
  Modes modes;
  if (!eps_) create(std::min<int>(count + 1, static_cast<int>(available())));
  const petsc::Stage stage("modes");
  const Transformation inverse(eps_, statics_, holding_.constrained);
  const bool shares = statics_.owns(inverse.ksp);
  const Columns rigid = rigid_motions(structure_, frame_, holding_);
  const PairSearch search{eps_,
                          structure_,
                          holding_.constrained,
                          rigid,
                          statics_,
                          static_cast<int>(available()),
                          finds_lowest(eps_, shift_),
                          !inverse.ksp};
  Found pairs = lowest_pairs(search, M_, count);
  std::vector<double> errors;
  if (inverse.ksp) errors = purify(inverse, M_, holding_.constrained, pairs);
  modes.raw = std::move(pairs.raw);
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
    if (!holds_frame(frame_, holding_.constrained)) fem::to_frame(frame_, modes.shapes.back());
  }
  if (shares && !statics_.iterates())  // of K's factor, and what that misses
    for (double error : errors) modes.residual.push_back(error + statics_.factor_error());
  else if (inverse.ksp)
    modes.residual = residuals(inverse, exact_, M_, holding_.constrained, modes.raw, lambda);
  else
    modes.residual.assign(pairs.error.begin(), pairs.error.begin() + count);
  for (int i = 0; i < count; ++i) {
    if (modes.residual[i] <= 1e-2 || std::abs(pairs.lambda[i] / lambda[i] - 1) <= 1e-3) continue;
    if (!statics_.refines())
      throw RunError(
          fmt::format("mode {} of {} is indistinguishable from massless motions; ask for fewer modes", i + 1, count));
    throw too_fine(structure_, fmt::format("mode {} lies between {:.4g} and {:.4g} rad/s", i + 1,
                                           std::sqrt(std::min(lambda[i], std::abs(pairs.lambda[i]))),
                                           std::sqrt(std::max(lambda[i], std::abs(pairs.lambda[i])))));
  }
  return modes;
}

Modes vibration_modes(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int count) {
  return ModeSolver(structure, frame, holding, statics).solve(count);
}

}  // namespace floe::reduction
