#include <petsc/private/matimpl.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "block_solve.h"
#include "floe/petsc/error.h"
#include "floe/petsc/factorisation.h"

namespace floe::petsc {
namespace {

constexpr std::array<MatType, 6> kinds = {MATSEQAIJ, MATMPIAIJ, MATSEQBAIJ, MATMPIBAIJ, MATSEQSBAIJ, MATMPISBAIJ};
constexpr std::array<MatFactorType, 2> factors = {MAT_FACTOR_LU, MAT_FACTOR_CHOLESKY};
constexpr PetscInt most_room = 12800;        // ICNTL(14) [%]
constexpr double most_memory = 4294967296.;  // [B], for more than twice of what is estimated

/// PETSc's own ways of making MUMPS' factors, by the kind of matrix and of factor.
std::map<std::pair<std::string, MatFactorType>, MatSolverFunction>& makers() {
  static std::map<std::pair<std::string, MatFactorType>, MatSolverFunction> all;
  return all;
}

PetscErrorCode make(Mat A, MatFactorType type, Mat* F);
PetscErrorCode numeric(Mat F, Mat A, const MatFactorInfo* info);

/// What a factor was to be computed by, and from.
struct Operations {
  decltype(_MatOps::lufactorsymbolic) lu = nullptr;
  decltype(_MatOps::choleskyfactorsymbolic) cholesky = nullptr;
  decltype(_MatOps::lufactornumeric) numeric = nullptr;
  IS rows = nullptr, columns = nullptr;
};

constexpr const char* operations_name = "floe_mumps_operations";

PetscErrorCode destroy_operations(void* pointer) {
  auto* operations = static_cast<Operations*>(pointer);
  PetscFunctionBegin;
  PetscCall(ISDestroy(&operations->rows));
  PetscCall(ISDestroy(&operations->columns));
  delete operations;
  PetscFunctionReturn(0);
}

PetscErrorCode operations_of(Mat F, Operations** operations) {
  PetscContainer container = nullptr;
  PetscFunctionBegin;
  PetscCall(
      PetscObjectQuery(reinterpret_cast<PetscObject>(F), operations_name, reinterpret_cast<PetscObject*>(&container)));
  PetscCall(PetscContainerGetPointer(container, reinterpret_cast<void**>(operations)));
  PetscFunctionReturn(0);
}

PetscErrorCode keep(IS given, IS* kept) {
  PetscFunctionBegin;
  if (given) PetscCall(PetscObjectReference(reinterpret_cast<PetscObject>(given)));
  PetscCall(ISDestroy(kept));
  *kept = given;
  PetscFunctionReturn(0);
}

/// PETSc's analysis, which names what computes the numbers.
PetscErrorCode analyse(Mat F, Mat A, Operations& operations, const MatFactorInfo* info) {
  PetscFunctionBegin;
  if (F->factortype == MAT_FACTOR_LU) {
    PetscCall((*operations.lu)(F, A, operations.rows, operations.columns, info));
    operations.numeric = F->ops->lufactornumeric;
    F->ops->lufactornumeric = numeric;
  } else {
    PetscCall((*operations.cholesky)(F, A, operations.rows, info));
    operations.numeric = F->ops->choleskyfactornumeric;
    F->ops->choleskyfactornumeric = numeric;
  }
  PetscCall(keep_block_scatter(F));
  PetscFunctionReturn(0);
}

PetscErrorCode symbolic_lu(Mat F, Mat A, IS rows, IS columns, const MatFactorInfo* info) {
  Operations* operations = nullptr;
  PetscFunctionBegin;
  PetscCall(operations_of(F, &operations));
  PetscCall(keep(rows, &operations->rows));
  PetscCall(keep(columns, &operations->columns));
  PetscCall(analyse(F, A, *operations, info));
  PetscFunctionReturn(0);
}

PetscErrorCode symbolic_cholesky(Mat F, Mat A, IS rows, const MatFactorInfo* info) {
  Operations* operations = nullptr;
  PetscFunctionBegin;
  PetscCall(operations_of(F, &operations));
  PetscCall(keep(rows, &operations->rows));
  PetscCall(analyse(F, A, *operations, info));
  PetscFunctionReturn(0);
}

/// The room to try next, where that is what was missing and may be had; else 0. Alike on all ranks of F.
PetscErrorCode next_room(Mat F, PetscInt* next) {
  PetscInt infog = 0, bound = 0, room = 0, entries = 0;
  PetscFunctionBegin;
  *next = 0;
  PetscCall(MatMumpsGetInfog(F, 1, &infog));
  PetscCall(MatMumpsGetIcntl(F, 23, &bound));
  PetscCall(MatMumpsGetIcntl(F, 14, &room));
  PetscCall(MatMumpsGetInfog(F, 3, &entries));
  constexpr std::array<PetscInt, 7> too_small = {-8, -9, -11, -14, -15, -17, -20};
  if (std::find(too_small.begin(), too_small.end(), infog) == too_small.end() || bound > 0) PetscFunctionReturn(0);
  const PetscInt more = std::max<PetscInt>(100, 2 * room);
  const double millions = entries < 0 ? -static_cast<double>(entries) : 1e-6 * static_cast<double>(entries);
  const double bytes = 1e6 * sizeof(double) * millions * (1 + static_cast<double>(more) / 100);
  if (more <= most_room && (more == 100 || bytes <= most_memory)) *next = more;
  PetscFunctionReturn(0);
}

/// F as it was before its analysis, with the same controls: PETSc goes on with no factor whose numbers
/// have failed.
PetscErrorCode renew(Mat F, Mat A) {
  constexpr std::array<PetscInt, 18> controls = {4, 6, 7, 8, 10, 12, 13, 22, 23, 24, 27, 28, 29, 31, 33, 35, 36, 38};
  Operations *old = nullptr, *operations = nullptr;
  const char* prefix = nullptr;
  Mat fresh = nullptr;
  PetscFunctionBegin;
  PetscCall(operations_of(F, &old));
  PetscCall(make(A, F->factortype, &fresh));
  PetscCall(MatGetOptionsPrefix(F, &prefix));
  PetscCall(MatSetOptionsPrefix(fresh, prefix));
  for (const PetscInt i : controls) {
    PetscInt value = 0;
    PetscCall(MatMumpsGetIcntl(F, i, &value));
    PetscCall(MatMumpsSetIcntl(fresh, i, value));
  }
  for (const PetscInt i : {1, 3, 4, 5, 7}) {
    double value = 0;
    PetscCall(MatMumpsGetCntl(F, i, &value));
    PetscCall(MatMumpsSetCntl(fresh, i, value));
  }
  PetscCall(operations_of(fresh, &operations));
  PetscCall(keep(old->rows, &operations->rows));
  PetscCall(keep(old->columns, &operations->columns));
  PetscCall(MatHeaderReplace(F, &fresh));
  PetscFunctionReturn(0);
}

PetscErrorCode compute(Mat F, Mat A, const MatFactorInfo* info) {
  Operations* operations = nullptr;
  PetscInt room = 0;
  PetscFunctionBegin;
  PetscCall(operations_of(F, &operations));
  PetscCall((*operations->numeric)(F, A, info));
  PetscCall(next_room(F, &room));
  while (room > 0) {
    PetscCall(PetscInfo(F, "MUMPS' work space is too small: ICNTL(14) becomes %" PetscInt_FMT "\n", room));
    PetscCall(renew(F, A));
    PetscCall(operations_of(F, &operations));
    PetscCall(analyse(F, A, *operations, info));
    PetscCall(MatMumpsSetIcntl(F, 14, room));  // options have set it anew
    PetscCall((*operations->numeric)(F, A, info));
    PetscCall(next_room(F, &room));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode numeric(Mat F, Mat A, const MatFactorInfo* info) {
  const PetscBool raises = A->erroriffailure;
  PetscInt infog = 0, detail = 0;
  PetscFunctionBegin;
  A->erroriffailure = PETSC_FALSE;
  const PetscErrorCode code = compute(F, A, info);
  A->erroriffailure = raises;
  PetscCall(code);
  PetscCall(MatMumpsGetInfog(F, 1, &infog));
  PetscCall(MatMumpsGetInfog(F, 2, &detail));
  PetscCheck(infog >= 0 || !raises, PetscObjectComm(reinterpret_cast<PetscObject>(F)), PETSC_ERR_LIB,
             "Error reported by MUMPS in numerical factorization phase: INFOG(1)=%" PetscInt_FMT
             ", INFO(2)=%" PetscInt_FMT,
             infog, detail);
  PetscFunctionReturn(0);
}

PetscErrorCode make(Mat A, MatFactorType type, Mat* F) {
  MatType kind = nullptr;
  PetscContainer container = nullptr;
  PetscFunctionBegin;
  PetscCall(MatGetType(A, &kind));
  const auto maker = makers().find({kind, type});
  PetscCheck(maker != makers().end(), PetscObjectComm(reinterpret_cast<PetscObject>(A)), PETSC_ERR_SUP,
             "MUMPS has no factor of a matrix of type %s", kind);
  PetscCall((*maker->second)(A, type, F));
  PetscCall(PetscContainerCreate(PetscObjectComm(reinterpret_cast<PetscObject>(*F)), &container));
  auto* operations = new Operations{(*F)->ops->lufactorsymbolic, (*F)->ops->choleskyfactorsymbolic, nullptr};
  PetscCall(PetscContainerSetPointer(container, operations));
  PetscCall(PetscContainerSetUserDestroy(container, destroy_operations));
  PetscCall(
      PetscObjectCompose(reinterpret_cast<PetscObject>(*F), operations_name, reinterpret_cast<PetscObject>(container)));
  PetscCall(PetscContainerDestroy(&container));
  if (operations->lu) (*F)->ops->lufactorsymbolic = symbolic_lu;
  if (operations->cholesky) (*F)->ops->choleskyfactorsymbolic = symbolic_cholesky;
  PetscFunctionReturn(0);
}

}  // namespace

void prepare_mumps() {
  check(MatInitializePackage());
  for (const MatType kind : kinds)
    for (const MatFactorType type : factors) {
      PetscBool package = PETSC_FALSE, there = PETSC_FALSE;
      MatSolverFunction maker = nullptr;
      check(MatSolverTypeGet(MATSOLVERMUMPS, kind, type, &package, &there, &maker));
      if (!there || !maker || maker == make) continue;
      makers()[{kind, type}] = maker;
      check(MatSolverTypeRegister(MATSOLVERMUMPS, kind, type, make));
    }
}

}  // namespace floe::petsc
