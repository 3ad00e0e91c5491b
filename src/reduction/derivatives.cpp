#include "floe/reduction/derivatives.h"

#include <algorithm>
#include <map>

#include "floe/fem/field_rows.h"
#include "floe/petsc/stage.h"
#include "multigrid.h"

namespace floe::reduction {

using petsc::check;

Pairs all_pairs(int m) {
  Pairs pairs;
  for (int i = 0; i < m; ++i)
    for (int j = i; j < m; ++j) pairs.push_back({i, j});
  return pairs;
}

Columns static_derivatives(const fem::Structure& structure, const Statics& statics, const Columns& fields,
                           const Pairs& pairs) {
  if (pairs.empty()) return {};
  const petsc::Stage stage("derivatives");
  Columns theta = statics.solve(fem::derivative_loads(structure, fem::gather(structure, fields), pairs));
  for (const auto& column : theta) fem::separate(structure, column, 1e-7);
  return theta;
}

namespace {

/// The global dof where a field is greatest.
PetscInt greatest_dof(Vec field) {
  PetscInt dof = 0;
  double value = 0;  // VecMax writes it whether asked for or not
  const petsc::VecHandle magnitude = copy(field);
  check(VecAbs(magnitude));
  check(VecMax(magnitude, &dof, &value));
  return dof;
}

/// K - lambda M under the conditions, K without its round-off.
petsc::MatHandle exact_operator(const fem::Structure& structure, const Statics& statics, double lambda,
                                const fem::Conditions& conditions) {
  const petsc::MatHandle K = fem::stiffness_operator(statics.elements(), conditions),
                         M = fem::mass(structure, conditions);
  Mat parts[2] = {K, M};
  double scalings[2] = {1, -lambda};
  petsc::MatHandle sum;
  check(MatCreateComposite(structure.mesh.comm, 2, parts, sum.out()));
  check(MatCompositeSetScalings(sum, scalings));
  check(MatAssemblyBegin(sum, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(sum, MAT_FINAL_ASSEMBLY));
  return sum;
}

/// A solver of (K - lambda M) x = b under the conditions.
petsc::KspHandle shifted_solver(const fem::Structure& structure, const Statics& statics, double lambda,
                                const fem::Conditions& conditions) {
  const petsc::MatHandle A = fem::assemble(structure, conditions, 1, 1, -lambda);
  petsc::KspHandle ksp = direct_solver(A, "derivatives_");
  if (!factors(ksp))
    throw InputError(
        "options -derivatives_pc_...: derivatives with inertia (derivative_type: full) have an indefinite "
        "matrix; expected a factorisation (cholesky), or static derivatives");
  if (!statics.refines()) return ksp;
  const petsc::MatHandle exact = exact_operator(structure, statics, lambda, conditions);
  check(KSPSetOperators(ksp, exact, A));
  iterate(ksp, KSPGMRES);
  petsc::check_options(KSPSetFromOptions(ksp), "derivatives_");
  return ksp;
}

}  // namespace

Columns full_derivatives(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                         const Statics& statics, const Modes& modes, const Pairs& pairs, Pairs& which) {
  std::map<int, std::vector<int>> partners;  // of each i, the j
  which.clear();
  for (const auto& [i, j] : pairs) {
    partners[i].push_back(j);
    if (i != j) partners[j].push_back(i);
  }
  const petsc::MatHandle M = fem::mass(structure, {});
  Columns all;
  for (const auto& [i, others] : partners) {
    const double lambda = modes.omega[i] * modes.omega[i];
    fem::Conditions conditions = holding.constrained;
    conditions.push_back(greatest_dof(modes.raw[i]));
    std::sort(conditions.begin(), conditions.end());
    const petsc::KspHandle ksp = shifted_solver(structure, statics, lambda, conditions);
    const petsc::VecHandle Mphi = fem::field(structure);
    check(MatMult(M, modes.raw[i], Mphi));
    Pairs with;
    for (int j : others) with.push_back({i, j});
    Columns loads = fem::stiffness_derivatives(structure, modes.shapes, with);
    auto next = loads.begin();
    for (int j : others) {
      const petsc::VecHandle& load = *next++;
      double slope = 0;  // domega_i^2 / deta_j
      check(VecDot(load, modes.shapes[i], &slope));
      fem::balance(frame, load);
      check(VecAYPX(load, -1, Mphi));  // M phi - load, M phi scaled below
      check(VecAXPY(load, slope - 1, Mphi));
      fem::hold(load, conditions);
      which.push_back({i, j});
    }
    Columns theta = block_solve(ksp, loads);
    for (auto& column : theta) {
      double along = 0;
      check(VecDot(Mphi, column, &along));
      check(VecAXPY(column, -along, modes.raw[i]));
      fem::to_frame(frame, column);
      all.push_back(std::move(column));
    }
  }
  return all;
}

}  // namespace floe::reduction
