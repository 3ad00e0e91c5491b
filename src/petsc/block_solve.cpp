#include "block_solve.h"

#include <dlfcn.h>
#include <dmumps_c.h>
#include <petsc/private/matimpl.h>
#include <petscsf.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace floe::petsc {
namespace {

constexpr PetscInt most_columns = 64;
constexpr MUMPS_INT solve_job = 3;
constexpr const char* kept_name = "floe_mumps_block_solve";

using MumpsCall = void (*)(DMUMPS_STRUC_C*);

/// What stays from one block to the next.
struct Kept {
  decltype(_MatOps::matsolve) usual = nullptr;  ///< PETSc's own
  MumpsCall call = nullptr;
  PetscSF scatter = nullptr;     ///< from where MUMPS leaves a solution to where its rows are
  std::vector<MUMPS_INT> rows;   ///< of the right-hand sides here, from 1
  std::vector<MUMPS_INT> found;  ///< of the solutions here, for which the scatter is
};

PetscErrorCode destroy(void* pointer) {
  auto* kept = static_cast<Kept*>(pointer);
  PetscFunctionBegin;
  PetscCall(PetscSFDestroy(&kept->scatter));
  delete kept;
  PetscFunctionReturn(0);
}

/// MUMPS' instance, with which a factor's data begins; nothing if it does not.
DMUMPS_STRUC_C* instance(Mat F) {
  auto* id = static_cast<DMUMPS_STRUC_C*>(F->data);
  return id && std::strncmp(id->version_number, MUMPS_VERSION, sizeof(MUMPS_VERSION)) == 0 ? id : nullptr;
}

/// Fields of MUMPS' instance that PETSc has set for itself, put back at the end.
class Borrowed {
 public:
  explicit Borrowed(DMUMPS_STRUC_C* id) : id_(id), was_(std::make_unique<DMUMPS_STRUC_C>(*id)) {}
  ~Borrowed() {
    id_->nrhs = was_->nrhs;
    id_->nloc_rhs = was_->nloc_rhs, id_->lrhs_loc = was_->lrhs_loc;
    id_->irhs_loc = was_->irhs_loc, id_->rhs_loc = was_->rhs_loc;
    id_->isol_loc = was_->isol_loc, id_->sol_loc = was_->sol_loc;
    id_->icntl[19] = was_->icntl[19];
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;

 private:
  DMUMPS_STRUC_C* id_;
  std::unique_ptr<DMUMPS_STRUC_C> was_;
};

/// A scatter to `layout` from where MUMPS left the rows `found`, unless it is the kept one. Collective.
PetscErrorCode aim(Kept* kept, MPI_Comm comm, PetscLayout layout, std::vector<MUMPS_INT> found) {
  int other = !kept->scatter || found != kept->found;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &other, 1, MPI_INT, MPI_LOR, comm));
  if (!other) PetscFunctionReturn(0);
  std::vector<PetscInt> rows(found.size());
  std::transform(found.begin(), found.end(), rows.begin(), [](MUMPS_INT row) { return PetscInt(row) - 1; });
  PetscCall(PetscSFDestroy(&kept->scatter));
  PetscCall(PetscSFCreate(comm, &kept->scatter));
  PetscCall(PetscSFSetGraphLayout(kept->scatter, layout, static_cast<PetscInt>(rows.size()), nullptr, PETSC_OWN_POINTER,
                                  rows.data()));
  PetscCall(PetscSFSetUp(kept->scatter));
  kept->found = std::move(found);
  PetscFunctionReturn(0);
}

/// The rows here of some columns, whose first entries are `step` apart.
template <class Number>
struct Rows {
  Number* first;
  PetscInt step;
  Number* column(PetscInt j) const { return first + static_cast<std::ptrdiff_t>(j) * step; }
};

/// X with A X = B for `count` columns.
PetscErrorCode solve_columns(Mat F, Kept* kept, PetscInt count, Rows<const double> b, Rows<double> x) {
  DMUMPS_STRUC_C* const id = instance(F);
  const MPI_Comm comm = PetscObjectComm(reinterpret_cast<PetscObject>(F));
  const PetscInt own = F->rmap->n;
  const std::size_t left = static_cast<std::size_t>(id->lsol_loc);
  std::vector<MUMPS_INT> found(std::max<std::size_t>(left, 1));
  std::vector<double> solution(found.size() * static_cast<std::size_t>(count));

  PetscFunctionBegin;
  {
    const Borrowed borrowed(id);
    id->nrhs = static_cast<MUMPS_INT>(count);
    id->nloc_rhs = static_cast<MUMPS_INT>(own), id->lrhs_loc = static_cast<MUMPS_INT>(std::max<PetscInt>(b.step, 1));
    id->irhs_loc = kept->rows.data(), id->rhs_loc = const_cast<double*>(b.first);
    id->isol_loc = found.data(), id->sol_loc = solution.data();
    id->icntl[19] = 10;
    id->job = solve_job;
    (*kept->call)(id);
  }
  PetscCheck(id->infog[0] >= 0, comm, PETSC_ERR_LIB, "Error reported by MUMPS in solve phase: INFOG(1)=%d",
             static_cast<int>(id->infog[0]));
  found.resize(left);
  PetscCall(aim(kept, comm, F->rmap, std::move(found)));
  for (PetscInt j = 0; j < count; ++j) {
    const double* const from = solution.data() + static_cast<std::size_t>(j) * left;
    PetscCall(PetscSFReduceBegin(kept->scatter, MPIU_REAL, from, x.column(j), MPI_REPLACE));
    PetscCall(PetscSFReduceEnd(kept->scatter, MPIU_REAL, from, x.column(j), MPI_REPLACE));
  }
  PetscCall(PetscLogFlops(2.0 * static_cast<double>(count) * id->rinfo[2]));
  PetscFunctionReturn(0);
}

PetscErrorCode kept_of(Mat F, Kept** kept) {
  PetscContainer container = nullptr;
  PetscFunctionBegin;
  *kept = nullptr;
  PetscCall(PetscObjectQuery(reinterpret_cast<PetscObject>(F), kept_name, reinterpret_cast<PetscObject*>(&container)));
  if (container) PetscCall(PetscContainerGetPointer(container, reinterpret_cast<void**>(kept)));
  PetscFunctionReturn(0);
}

PetscErrorCode solve(Mat F, Mat B, Mat X) {
  Kept* kept = nullptr;
  PetscBool dense = PETSC_FALSE, apart = PETSC_FALSE;
  PetscInt count = 0;
  Rows<const double> b{nullptr, 0};
  Rows<double> x{nullptr, 0};

  PetscFunctionBegin;
  PetscCall(kept_of(F, &kept));
  PetscCheck(kept, PetscObjectComm(reinterpret_cast<PetscObject>(F)), PETSC_ERR_PLIB,
             "The factor has lost its scatter");
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(B), MATMPIDENSE, &dense));
  PetscCall(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(X), MATMPIDENSE, &apart));
  if (!dense || !apart) {
    PetscCall((*kept->usual)(F, B, X));
    PetscFunctionReturn(0);
  }
  PetscCheck(B->rmap->n == F->rmap->n && X->rmap->n == F->rmap->n, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "Right-hand sides and solutions must have the rows of the factor");
  PetscCall(MatGetSize(B, nullptr, &count));
  PetscCall(MatDenseGetLDA(B, &b.step));
  PetscCall(MatDenseGetLDA(X, &x.step));
  PetscCall(MatDenseGetArrayRead(B, &b.first));
  PetscCall(MatDenseGetArrayWrite(X, &x.first));
  for (PetscInt j = 0; j < count; j += most_columns)
    PetscCall(solve_columns(F, kept, std::min(most_columns, count - j), {b.column(j), b.step}, {x.column(j), x.step}));
  PetscCall(MatDenseRestoreArrayWrite(X, &x.first));
  PetscCall(MatDenseRestoreArrayRead(B, &b.first));
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode keep_block_scatter(Mat F) {
  Kept* kept = nullptr;
  PetscContainer container = nullptr;
  PetscMPIInt ranks = 1;
  PetscBool central = PETSC_FALSE, threads = PETSC_FALSE;
  const auto object = reinterpret_cast<PetscObject>(F);
  const auto call = reinterpret_cast<MumpsCall>(dlsym(RTLD_DEFAULT, "dmumps_c"));

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm(object), &ranks));
  PetscCall(PetscOptionsHasName(object->options, object->prefix, "-mat_mumps_icntl_20", &central));
  PetscCall(PetscOptionsHasName(object->options, object->prefix, "-mat_mumps_use_omp_threads", &threads));
  if (ranks == 1 || central || threads || !call || !instance(F) || F->rmap->N > PETSC_MPI_INT_MAX ||
      F->ops->matsolve == solve)
    PetscFunctionReturn(0);
  PetscCall(kept_of(F, &kept));
  if (!kept) {
    kept = new Kept;
    PetscCall(PetscContainerCreate(PetscObjectComm(object), &container));
    PetscCall(PetscContainerSetPointer(container, kept));
    PetscCall(PetscContainerSetUserDestroy(container, destroy));
    PetscCall(PetscObjectCompose(object, kept_name, reinterpret_cast<PetscObject>(container)));
    PetscCall(PetscContainerDestroy(&container));
  }
  kept->usual = F->ops->matsolve;
  kept->call = call;
  kept->rows.resize(static_cast<std::size_t>(std::max<PetscInt>(F->rmap->n, 1)));
  for (PetscInt i = 0; i < F->rmap->n; ++i) kept->rows[i] = static_cast<MUMPS_INT>(F->rmap->rstart + i + 1);
  F->ops->matsolve = solve;
  PetscFunctionReturn(0);
}

}  // namespace floe::petsc
