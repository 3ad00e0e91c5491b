// Times the offline stage on a flat cantilever plate of triangles, phase by phase, and beside it what the same matrix
// costs bare: analysis, factorisation, 26 single solves and the blocked solves of the derivatives. One line of JSON.
//   offline_stage -cells 96 (along; half as many across) -modes 10 -bare 1
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "benchmark.h"
#include "floe/generate/generate.h"
#include "floe/mesh/partition.h"
#include "floe/output/reduced_file.h"
#include "floe/reduction/reduce.h"

using namespace floe;
using benchmark::option;
using benchmark::processor_seconds;
using petsc::check;

namespace {

struct Clock {
  double wall, cpu;
};

/// Maximum amount of memory so far, of all ranks together [bytes].
double memory() {
  double sum = benchmark::memory();
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

/// Runs `work` and writes its seconds, wall and processor, of the slowest rank.
class Report {
 public:
  template <class Work>
  auto time(const char* name, Work&& work) {
    MPI_Barrier(PETSC_COMM_WORLD);
    const Clock start{MPI_Wtime(), processor_seconds()};
    struct Note {
      Report& report;
      const char* name;
      Clock start;
      ~Note() {
        double spent[2] = {MPI_Wtime() - start.wall, processor_seconds() - start.cpu};
        MPI_Allreduce(MPI_IN_PLACE, spent, 2, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
        report.note(name, fmt::format("[{:.4f}, {:.4f}]", spent[0], spent[1]));
      }
    } note{*this, name, start};
    return work();
  }
  void note(const char* name, const std::string& value) {
    text_ += fmt::format("{}\"{}\": {}", text_.empty() ? "" : ", ", name, value);
  }
  void print() const { check(PetscPrintf(PETSC_COMM_WORLD, "{%s}\n", text_.c_str())); }

 private:
  std::string text_;
};

/// All dofs of the nodes at x = 0.
fem::Conditions left_edge(const mesh::RawMesh& raw, const fem::Structure& structure) {
  fem::Conditions mine, all;
  for (PetscInt node = 0; node < structure.mesh.owned_nodes; ++node)
    if (structure.mesh.positions[node].x() == 0)
      for (PetscInt d = 0; d < 6; ++d) mine.push_back(6 * (structure.mesh.first_node + node) + d);
  int size = 1, count = static_cast<int>(mine.size());
  MPI_Comm_size(raw.comm, &size);
  std::vector<int> counts(size), starts(size + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, raw.comm);
  for (int r = 0; r < size; ++r) starts[r + 1] = starts[r] + counts[r];
  all.resize(starts[size]);
  MPI_Allgatherv(mine.data(), count, MPIU_INT, all.data(), counts.data(), starts.data(), MPIU_INT, raw.comm);
  std::sort(all.begin(), all.end());
  return all;
}

/// What MUMPS says of its factor: operations, entries, order of the greatest front. Zero if another has factored.
void note_factor(KSP ksp, Report& report) {
  PC pc = nullptr;
  Mat factor = nullptr;
  PetscBool mumps = PETSC_FALSE;
  MatSolverType type = nullptr;
  PetscReal operations = 0;
  PetscInt entries = 0, front = 0;
  check(KSPGetPC(ksp, &pc));
  check(PCFactorGetMatSolverType(pc, &type));
  check(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (mumps) {
    check(PCFactorGetMatrix(pc, &factor));
    check(MatMumpsGetRinfog(factor, 3, &operations));
    check(MatMumpsGetInfog(factor, 29, &entries));  // millions, if negative
    check(MatMumpsGetInfog(factor, 11, &front));
  }
  const double count = entries < 0 ? -1e6 * double(entries) : double(entries);
  report.note("factor", fmt::format("{{\"operations\": {:.6g}, \"entries\": {:.6g}, \"front\": {}}}", operations, count,
                                    static_cast<long>(front)));
}

/// What PETSc has sent so far in messages between two ranks, and reductions: counts and bytes of the busiest rank.
/// MUMPS' own messages are not among them.
void note_messages(Report& report) {
  double mine[3] = {petsc_isend_ct + petsc_send_ct, petsc_isend_len + petsc_send_len, petsc_allreduce_ct};
  MPI_Allreduce(MPI_IN_PLACE, mine, 3, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  report.note("messages", fmt::format("{{\"count\": {:.0f}, \"bytes\": {:.0f}, \"reductions\": {:.0f}}}", mine[0],
                                      mine[1], mine[2]));
}

/// Analysis, factorisation, single and blocked solves with K alone, by PETSc's own interface to MUMPS; and blocked
/// solves by floe's.
void bare(Mat K, int single, int block, Report& report) {
  check(PetscOptionsSetValue(nullptr, "-bare_mat_mumps_icntl_20", "10"));  // keeps floe from its own way
  const petsc::KspHandle ksp = reduction::direct_solver(K, "bare_"), own = reduction::direct_solver(K, "derivatives_");
  report.time("bare factorisation", [&] { check(KSPSetUp(ksp)); });
  petsc::VecHandle b, x;
  check(MatCreateVecs(K, x.out(), b.out()));
  check(VecSetRandom(b, nullptr));
  report.time("bare single solves", [&] {
    for (int i = 0; i < single; ++i) check(KSPSolve(ksp, b, x));
  });
  PetscInt local = 0, global = 0;
  check(VecGetLocalSize(b, &local));
  check(VecGetSize(b, &global));
  petsc::MatHandle B, X;
  check(MatCreateDense(PETSC_COMM_WORLD, local, PETSC_DECIDE, global, block, nullptr, B.out()));
  check(MatCreateDense(PETSC_COMM_WORLD, local, PETSC_DECIDE, global, block, nullptr, X.out()));
  check(MatSetRandom(B, nullptr));
  check(MatAssemblyBegin(X, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(X, MAT_FINAL_ASSEMBLY));
  report.time("bare block solve", [&] { check(KSPMatSolve(ksp, B, X)); });
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size > 1) {
    check(KSPSetUp(own));
    check(KSPMatSolve(own, B, X));  // makes the scatter
    report.time("block solve", [&] { check(KSPMatSolve(own, B, X)); });
  }
  note_factor(ksp, report);
}

/// The reduced body's file, without the basis at every node.
void write(const fem::Structure& structure, const fem::ReferenceFrame& frame, const reduction::Basis& basis,
           const reduction::Generators& generators, const body::FlexibleBody& body) {
  output::ReducedBodyFile file;
  file.name = "plate", file.dimension = 3;
  file.dofs = structure.dofs(), file.nodes = structure.mesh.node_count, file.cells = structure.mesh.cell_count;
  file.body = body;
  file.frame = {"clamped", Eigen::VectorXd::Zero(3), Eigen::MatrixXd::Identity(3, 3)};
  file.places.push_back({"clamp", reduction::place_map(structure, basis, frame.conditions[0] / 6)});
  for (const auto& origin : basis.origins)
    file.columns.push_back({origin.kind == reduction::ColumnOrigin::Kind::mode ? "mode" : "derivative", origin.label,
                            origin.omega, origin.new_part, origin.kept, 0});
  file.omega = generators.modes.omega, file.residual = generators.modes.residual;
  file.made = output::made_here(PETSC_COMM_WORLD, "");
  output::write_reduced_body(PETSC_COMM_WORLD, std::filesystem::temp_directory_path() / "offline_stage.h5", file, true);
}

/// Elastic energy of a state, so that runs can be compared: modes and derivatives a thickness and more in size.
double energy(const body::FlexibleBody& body) {
  const int k = body.coordinates();
  Eigen::VectorXd q(k);
  for (int i = 0; i < k; ++i) q[i] = 0.01 / (1 + i);
  return body::energy(body.elasticity, q);
}

void run() {
  const PetscInt cells = option("-cells", PetscInt(48));
  const int modes = static_cast<int>(option("-modes", PetscInt(10)));
  Report report;
  generate::Plate plate;
  plate.a = {2, 0, 0}, plate.b = {0, 1, 0};
  plate.na = cells, plate.nb = cells / 2;
  const fem::ShellSection section = fem::shell_section({{fem::isotropic(7e10, 0.3, 2700), 0.002}});
  const mesh::RawMesh raw = report.time("mesh", [&] { return generate::plate(PETSC_COMM_WORLD, plate); });
  const std::vector<int> ranks = report.time("partition", [&] { return mesh::partition(raw); });
  fem::Structure structure = report.time(
      "structure", [&] { return fem::Structure(fem::mesh_of(raw, ranks), {section}, fem::MembraneStrain::averaged); });
  const fem::Conditions constrained = left_edge(raw, structure);
  const PetscInt clamp = constrained[0] / 6;
  const fem::ReferenceFrame frame = fem::reference_frame(structure, fem::ReferenceFrame::Kind::clamped, clamp, clamp);
  const fem::Holding holding = fem::holding(structure, frame, constrained);
  auto statics =
      report.time("assembly", [&] { return std::make_unique<reduction::Statics>(structure, frame, holding); });
  report.time("factorisation", [&] { statics->factor(); });
  auto solver = std::make_unique<reduction::ModeSolver>(structure, frame, holding, *statics);
  const reduction::Generators generators =
      report.time("modes", [&] { return reduction::generators(structure, *statics, solver->solve(modes), {}, 1e-7); });
  solver.reset();
  auto derivatives = report.time("derivatives", [&] {
    return reduction::derivative_columns(structure, frame, holding, *statics, generators, reduction::all_pairs(modes),
                                         false);
  });
  const int block = static_cast<int>(derivatives.columns.size());
  const reduction::Basis basis =
      report.time("basis", [&] { return reduction::basis_of(structure, generators, std::move(derivatives), 1e-7); });
  const body::FlexibleBody body = report.time("projection", [&] { return reduction::project(structure, basis); });
  report.time("file", [&] { write(structure, frame, basis, generators, body); });
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  report.note("ranks", std::to_string(size));
  report.note("blas", fmt::format("\"{}\"", petsc::blas_kernel()));
  report.note("dofs", std::to_string(structure.dofs()));
  report.note("memory", fmt::format("{:.0f}", memory()));
  report.note("columns", std::to_string(basis.columns));
  report.note("pairs", std::to_string(body.elasticity.pairs.size()));
  report.note("omega",
              fmt::format("[{:.12g}, {:.12g}]", generators.modes.omega.front(), generators.modes.omega.back()));
  report.note("residual", fmt::format("{:.3g}", generators.modes.residual.back()));
  report.note("energy", fmt::format("{:.14g}", energy(body)));
  note_messages(report);
  if (option("-bare", PetscInt(1))) bare(statics->stiffness(), 26, block, report);
  report.print();
}

}  // namespace

int main(int argc, char** argv) { return benchmark::execute(argc, argv, run); }
