// Solves K x = b of a cantilever plate or cylindrical panel of triangles, 2 m x 1 m, by MUMPS' factor and by conjugate
// gradients or GMRES with PCBDDC. One line of JSON.
//   mpirun -n 4 subdomains -cells 140 (along; half as many across) -thickness 1e-3 (of the length) -curved 1
//     -options_file examples/blade/options/subdomains.opts
// Processor seconds are those outside of MPI's calls: with more ranks than cores a waiting rank takes time, too.
#include "../../src/reduction/subdomains.h"

#include <fmt/format.h>
#include <petsc/private/pcbddcimpl.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "benchmark.h"
#include "floe/fem/subdomains.h"
#include "floe/generate/generate.h"
#include "floe/mesh/partition.h"
#include "floe/petsc/stage.h"
#include "floe/reduction/statics.h"

using namespace floe;
using benchmark::option;
using benchmark::processor_seconds;
using petsc::check;

namespace {

double waited = 0;  ///< processor seconds within MPI
int depth = 0;

template <class Call>
int timed(Call&& call) {
  const double start = depth++ == 0 ? processor_seconds() : 0;
  const int code = call();
  if (--depth == 0) waited += processor_seconds() - start;
  return code;
}

}  // namespace

// Those in which PETSc's ranks wait for each other; its log counts some by macros.
#undef MPI_Allreduce
#undef MPI_Reduce
#undef MPI_Bcast
#undef MPI_Barrier
#undef MPI_Recv
#undef MPI_Wait
#undef MPI_Waitall
#undef MPI_Waitany
#undef MPI_Iprobe
#undef MPI_Test
#undef MPI_Testall
#undef MPI_Allgather
extern "C" {
int MPI_Allreduce(const void* in, void* out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
  return timed([&] { return PMPI_Allreduce(in, out, n, type, op, comm); });
}
int MPI_Reduce(const void* in, void* out, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm) {
  return timed([&] { return PMPI_Reduce(in, out, n, type, op, root, comm); });
}
int MPI_Bcast(void* values, int n, MPI_Datatype type, int root, MPI_Comm comm) {
  return timed([&] { return PMPI_Bcast(values, n, type, root, comm); });
}
int MPI_Barrier(MPI_Comm comm) {
  return timed([&] { return PMPI_Barrier(comm); });
}
int MPI_Recv(void* values, int n, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Status* status) {
  return timed([&] { return PMPI_Recv(values, n, type, from, tag, comm, status); });
}
int MPI_Wait(MPI_Request* request, MPI_Status* status) {
  return timed([&] { return PMPI_Wait(request, status); });
}
int MPI_Waitall(int n, MPI_Request* requests, MPI_Status* statuses) {
  return timed([&] { return PMPI_Waitall(n, requests, statuses); });
}
int MPI_Waitany(int n, MPI_Request* requests, int* which, MPI_Status* status) {
  return timed([&] { return PMPI_Waitany(n, requests, which, status); });
}
int MPI_Iprobe(int from, int tag, MPI_Comm comm, int* flag, MPI_Status* status) {
  return timed([&] { return PMPI_Iprobe(from, tag, comm, flag, status); });
}
int MPI_Test(MPI_Request* request, int* flag, MPI_Status* status) {
  return timed([&] { return PMPI_Test(request, flag, status); });
}
int MPI_Testall(int n, MPI_Request* requests, int* flag, MPI_Status* statuses) {
  return timed([&] { return PMPI_Testall(n, requests, flag, statuses); });
}
int MPI_Allgather(const void* in, int n, MPI_Datatype type, void* out, int m, MPI_Datatype other, MPI_Comm comm) {
  return timed([&] { return PMPI_Allgather(in, n, type, out, m, other, comm); });
}
}

namespace {

double of_all(double mine, MPI_Op op) {
  MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE, op, PETSC_COMM_WORLD);
  return mine;
}

/// Processor seconds of all ranks, without waiting.
template <class Work>
double seconds(Work&& work) {
  MPI_Barrier(PETSC_COMM_WORLD);
  const double start = processor_seconds() - waited;
  work();
  return of_all(processor_seconds() - waited - start, MPI_SUM);
}

double megabytes() { return 1e-6 * benchmark::memory(); }

/// A cantilever, clamped at x = 0; curved: a quarter of a cylinder.
fem::Structure structure_of(PetscInt cells, double thickness, bool curved) {
  generate::Plate plate;
  plate.a = {2, 0, 0}, plate.b = {0, 1, 0};
  plate.na = cells, plate.nb = cells / 2;
  mesh::RawMesh raw = generate::plate(PETSC_COMM_WORLD, plate);
  const double radius = 2 / std::numbers::pi;
  if (curved)
    for (Eigen::Vector3d& x : raw.positions)
      x = {x.x(), radius * std::sin(x.y() / radius), radius * (1 - std::cos(x.y() / radius))};
  const fem::ShellSection section = fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), 2 * thickness}});
  return {fem::mesh_of(raw, mesh::partition(raw)), {section}, fem::MembraneStrain::averaged};
}

/// All dofs of the nodes at x = 0: the first node of each row along x.
fem::Conditions clamped(const fem::Structure& structure, PetscInt cells) {
  std::vector<PetscInt> originals;
  for (PetscInt row = 0; row <= cells / 2; ++row) originals.push_back(row * (cells + 1));
  fem::Conditions conditions;
  for (const PetscInt node : fem::global_nodes(structure.mesh, originals))
    for (PetscInt i = 0; i < 6; ++i) conditions.push_back(6 * node + i);
  std::sort(conditions.begin(), conditions.end());
  return conditions;
}

/// Smooth forces in all directions, the same on any ranks.
petsc::VecHandle load(const fem::Structure& structure, const fem::Conditions& conditions) {
  petsc::VecHandle f = fem::field(structure);
  double* values = nullptr;
  check(VecGetArrayWrite(f, &values));
  for (PetscInt i = 0; i < structure.owned_dofs(); ++i)
    values[i] = i % 6 < 3 ? std::cos(3. * double(structure.original_dof(int(i))) / double(structure.dofs())) : 0;
  check(VecRestoreArrayWrite(f, &values));
  fem::hold(f, conditions);
  return f;
}

/// Seconds of one solve.
double solve(KSP ksp, Vec f, Vec u, int times) {
  return seconds([&] {
           for (int i = 0; i < times; ++i) check(KSPSolve(ksp, f, u));
         }) /
         times;
}

void run() {
  const PetscInt cells = option("-cells", PetscInt(70));
  const fem::Structure structure = structure_of(cells, option("-thickness", 1e-3), option("-curved", PetscInt(0)) != 0);
  const fem::Conditions conditions = clamped(structure, cells);
  const PetscInt clamp = conditions[0] / 6;
  const fem::ReferenceFrame frame = fem::reference_frame(structure, fem::ReferenceFrame::Kind::clamped, clamp, clamp);
  const petsc::VecHandle f = load(structure, conditions), u = fem::field(structure);
  const int times = static_cast<int>(option("-solves", PetscInt(2)));
  const double before = megabytes();
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  petsc::MatHandle K;
  petsc::KspHandle ksp;
  const double setup = seconds([&] {
    K = fem::stiffness(structure, conditions);
    ksp = reduction::direct_solver(K, "derivatives_");
    PetscBool bddc = PETSC_FALSE;
    PC pc = nullptr;
    check(KSPGetPC(ksp, &pc));
    check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCBDDC, &bddc));
    if (bddc) {
      K = reduction::for_iteration(ksp, {structure, frame, conditions, 0});
      check(KSPSetOperators(ksp, K, K));
    }
    check(KSPSetUp(ksp));
  });
  const double each = solve(ksp, f, u, times);
  double block = 0, deflection = 0;
  PetscBool bddc = PETSC_FALSE;
  PC pc = nullptr;
  PetscInt iterations = 0, coarse = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(VecNorm(u, NORM_INFINITY, &deflection));
  check(KSPGetPC(ksp, &pc));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCBDDC, &bddc));
  check(KSPGetIterationNumber(ksp, &iterations));
  check(KSPGetConvergedReason(ksp, &reason));
  if (bddc)
    coarse = static_cast<PC_BDDC*>(pc->data)->coarse_size;
  else {
    const petsc::MatHandle B = reduction::dense_like(f, 55), X = reduction::dense_like(f, 55);
    check(MatSetRandom(B, nullptr));
    block = seconds([&] { check(KSPMatSolve(ksp, B, X)); }) / 55;
  }
  const double most = of_all(megabytes() - before, MPI_MAX), sum = of_all(megabytes() - before, MPI_SUM);
  check(PetscPrintf(PETSC_COMM_WORLD,
                    "{\"dofs\": %d, \"ranks\": %d, \"iterations\": %d, \"reason\": \"%s\", \"coarse\": %d, \"setup\": "
                    "%.4f, \"solve\": %.5f, \"block\": %.5f, \"memory\": [%.1f, %.1f], \"deflection\": %.12g}\n",
                    int(structure.dofs()), size, int(iterations), KSPConvergedReasons[reason], int(coarse), setup, each,
                    block, most, sum, deflection));
}

}  // namespace

int main(int argc, char** argv) { return benchmark::execute(argc, argv, run); }
