#include "floe/reduction/modes.h"

#include <fmt/format.h>

#include <cmath>

namespace floe::reduction {

using petsc::check;

namespace {

/// A rough field that depends on the global dof numbers only, zero at the conditions: the start of the Krylov space.
petsc::VecHandle start(const fem::Structure& structure, const fem::Conditions& conditions) {
  petsc::VecHandle x = fem::field(structure);
  PetscInt first = 0, end = 0;
  double* values = nullptr;
  check(VecGetOwnershipRange(x, &first, &end));
  check(VecGetArrayWrite(x, &values));
  for (PetscInt i = first; i < end; ++i) values[i - first] = std::sin(12.9898 * double(i + 1)) + 0.5;
  check(VecRestoreArrayWrite(x, &values));
  fem::hold(x, conditions);
  return x;
}

/// A value near the lowest squared frequency of a body that is free to move: Rayleigh's quotient of a static
/// deflection.
double low_frequency(const fem::Structure& structure, const Statics& statics, Mat M) {
  petsc::VecHandle load = fem::field(structure);
  check(MatMult(M, start(structure, {}), load));
  Columns loads;
  loads.push_back(std::move(load));
  const Columns u = statics.solve(loads);
  const petsc::MatHandle K = fem::stiffness(structure, {});
  const petsc::VecHandle product = fem::field(structure);
  double elastic = 0, kinetic = 0;
  check(MatMult(K, u[0], product));
  check(VecDot(u[0], product, &elastic));
  check(MatMult(M, u[0], product));
  check(VecDot(u[0], product, &kinetic));
  return elastic / kinetic;
}

petsc::EpsHandle solver(Mat K, Mat M, int count, double shift) {
  petsc::EpsHandle eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(EPSCreate(PetscObjectComm(reinterpret_cast<PetscObject>(K)), eps.out()));
  check(EPSSetOptionsPrefix(eps, "modes_"));
  check(EPSSetOperators(eps, K, M));
  check(EPSSetProblemType(eps, EPS_GHEP));
  check(EPSSetDimensions(eps, count, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetTolerances(eps, 1e-13, PETSC_DEFAULT));
  check(EPSSetTarget(eps, shift));
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check(EPSSetPurify(eps, PETSC_FALSE));
  check(EPSGetST(eps, &st));
  check(STSetType(st, STSINVERT));
  check(STGetKSP(st, &ksp));
  check(KSPSetType(ksp, KSPPREONLY));
  check(KSPGetPC(ksp, &pc));
  check(PCSetType(pc, PCCHOLESKY));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check_options(EPSSetFromOptions(eps), "modes_");
  return eps;
}

}  // namespace

void fix_sign(Vec shape) {
  PetscInt first = 0, end = 0;
  const double* values = nullptr;
  check(VecGetOwnershipRange(shape, &first, &end));
  check(VecGetArrayRead(shape, &values));
  auto translation = [&](PetscInt dof) { return dof % fem::Structure::dofs_per_node != 2; };
  double greatest = 0;
  for (PetscInt i = first; i < end; ++i)
    if (translation(i)) greatest = std::max(greatest, std::abs(values[i - first]));
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(shape));
  MPI_Allreduce(MPI_IN_PLACE, &greatest, 1, MPI_DOUBLE, MPI_MAX, comm);
  PetscInt where = PETSC_MAX_INT;
  double sign = 0;
  for (PetscInt i = first; i < end && where == PETSC_MAX_INT; ++i)
    if (translation(i) && std::abs(values[i - first]) > 0.5 * greatest)
      where = i, sign = values[i - first] < 0 ? -1 : 1;
  check(VecRestoreArrayRead(shape, &values));
  PetscInt lowest = where;
  MPI_Allreduce(&where, &lowest, 1, MPIU_INT, MPI_MIN, comm);
  if (where != lowest) sign = 0;
  MPI_Allreduce(MPI_IN_PLACE, &sign, 1, MPI_DOUBLE, MPI_SUM, comm);
  if (sign < 0) check(VecScale(shape, -1));
}

Modes vibration_modes(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int count) {
  Modes modes;
  if (count <= 0) return modes;
  const PetscInt available =
      structure.dofs() - static_cast<PetscInt>(holding.held.size()) - static_cast<PetscInt>(holding.left.cols());
  if (count > available)
    throw InputError(
        fmt::format("{} modes are asked of a body that has {} elastic dofs under its conditions", count, available));
  const petsc::MatHandle K = fem::stiffness(structure, holding.held), M = fem::mass(structure, holding.held);
  const bool moves = holding.left.cols() > 0;
  const double shift = moves ? -low_frequency(structure, statics, M) : 0;
  const petsc::EpsHandle eps = solver(K, M, count, shift);

  Columns rigid;
  for (Eigen::Index r = 0; r < holding.left.cols(); ++r) {
    rigid.push_back(fem::field(structure));
    for (int i = 0; i < 3; ++i) check(VecAXPY(rigid.back(), holding.left(i, r), frame.rigid[i]));
    fem::hold(rigid.back(), holding.held);
  }
  std::vector<Vec> deflated(rigid.begin(), rigid.end());
  if (moves) check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(deflated.size()), deflated.data()));
  const petsc::VecHandle first = start(structure, holding.held);
  Vec initial[1] = {first};
  check(EPSSetInitialSpace(eps, 1, initial));
  check(EPSSolve(eps));

  PetscInt converged = 0, iterations = 0;
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  check(EPSGetConverged(eps, &converged));
  check(EPSGetConvergedReason(eps, &reason));
  check(EPSGetIterationNumber(eps, &iterations));
  if (converged < count)
    throw RunError(
        fmt::format("the eigenvalue solver (options -modes_eps_...) found {} of {} modes in {} iterations: {}",
                    converged, count, iterations, EPSConvergedReasons[reason]));
  for (int i = 0; i < count; ++i) {
    double lambda = 0, error = 0;
    modes.raw.push_back(fem::field(structure));
    check(EPSGetEigenpair(eps, i, &lambda, nullptr, modes.raw.back(), nullptr));
    check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
    fem::hold(modes.raw.back(), holding.held);
    fix_sign(modes.raw.back());
    modes.omega.push_back(std::sqrt(std::max(lambda, 0.0)));
    modes.residual.push_back(error);
    modes.shapes.push_back(copy(modes.raw.back()));
    fem::to_frame(frame, modes.shapes.back());
  }
  return modes;
}

}  // namespace floe::reduction
