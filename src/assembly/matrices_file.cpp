#include <fmt/format.h>

#include <algorithm>

#include "floe/assembly/body_stage.h"
#include "floe/output/folder.h"
#include "floe/output/matrix_market.h"
#include "floe/petsc/error.h"

namespace floe::assembly {
namespace {

/// Rows of the files: the dofs that are free, in the order of their original numbers.
struct FreeRows {
  std::vector<char> free;             ///< of all dofs by original numbers, the same on every rank
  std::vector<std::int64_t> numbers;  ///< of this rank's dofs: row, or -1
  std::int64_t count = 0;
};

FreeRows free_rows(const fem::Structure& structure, const fem::Conditions& constrained) {
  FreeRows rows;
  rows.free.assign(structure.dofs(), 0);
  for (int i = 0; i < structure.owned_dofs(); ++i)
    if (!std::binary_search(constrained.begin(), constrained.end(), structure.global_dof(i)))
      rows.free[structure.original_dof(i)] = 1;
  MPI_Allreduce(MPI_IN_PLACE, rows.free.data(), static_cast<int>(rows.free.size()), MPI_CHAR, MPI_MAX,
                structure.mesh.comm);
  std::vector<std::int64_t> number(rows.free.size(), -1);
  for (std::size_t dof = 0; dof < number.size(); ++dof)
    if (rows.free[dof]) number[dof] = rows.count++;
  for (int i = 0; i < structure.owned_dofs(); ++i) rows.numbers.push_back(number[structure.original_dof(i)]);
  return rows;
}

/// Of all nodes by original numbers, on rank 0; zeros elsewhere.
std::vector<Eigen::Vector3d> positions(const fem::Mesh& mesh) {
  std::vector<Eigen::Vector3d> all(mesh.node_count, Eigen::Vector3d::Zero());
  for (int node = 0; node < mesh.owned_nodes; ++node) all[mesh.original_node(node)] = mesh.positions[node];
  int rank = 0;
  MPI_Comm_rank(mesh.comm, &rank);
  double* numbers = all.data()->data();
  MPI_Reduce(rank == 0 ? MPI_IN_PLACE : numbers, rank == 0 ? numbers : nullptr, static_cast<int>(3 * all.size()),
             MPI_DOUBLE, MPI_SUM, 0, mesh.comm);
  return all;
}

/// What each row is, for readers of the matrices.
std::string table(const fem::Structure& structure, const FreeRows& rows, const std::vector<Eigen::Vector3d>& x) {
  static constexpr const char* planar[] = {"u", "v", "rz"};
  static constexpr const char* spatial[] = {"u", "v", "w", "rx", "ry", "rz"};
  const auto names = structure.dimension() == 2 ? planar : spatial;
  std::string text =
      "# row from 1, node from 0 as the mesh numbers them, dof, undeformed place of the node; body axes\n";
  text += "# row node dof x y z\n";
  std::int64_t row = 0;
  for (std::size_t dof = 0; dof < rows.free.size(); ++dof) {
    if (!rows.free[dof]) continue;
    const std::size_t node = dof / structure.dofs_per_node;
    text += fmt::format("{} {} {} {} {} {}\n", ++row, node, names[dof % structure.dofs_per_node], x[node][0],
                        x[node][1], x[node][2]);
  }
  return text;
}

void write_body_matrices(const Plan& plan, int index, const std::filesystem::path& folder) {
  const MPI_Comm comm = plan.comm;
  const PlannedBody& body = plan.bodies[index];
  const fem::Structure& structure = body.structure;
  const fem::Conditions constrained = holding_of_modes(plan, index).constrained;
  const FreeRows rows = free_rows(structure, constrained);
  const auto file = [&](const char* what) { return folder / fmt::format("{}-{}", body.spec.name, what); };
  const std::vector<Eigen::Vector3d> x = positions(structure.mesh);
  petsc::agree(comm, [&] {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) output::write_file_atomically(file("rows.txt"), table(structure, rows, x));
  });
  const std::string which = fmt::format("of {} under the conditions of its modes, written by floe; rows: {}",
                                        body.spec.name, file("rows.txt").filename().string());
  output::write_matrix_market(fem::stiffness(structure, constrained), rows.numbers, rows.count, file("K.mtx"),
                              {"K " + which});
  output::write_matrix_market(fem::mass(structure, constrained), rows.numbers, rows.count, file("M.mtx"),
                              {"M " + which});
}

}  // namespace

std::vector<std::string> write_matrices(const Scene& whole, MPI_Comm comm, const std::filesystem::path& folder,
                                        bool overwrite) {
  const Scene scene = split_frames(whole, comm);
  const Plan plan = prepare(scene, comm);
  std::vector<std::string> names;
  for (const PlannedBody& body : plan.bodies)
    if (is_meshed(body.spec)) names.push_back(body.spec.name);
  if (names.empty())
    throw InputError(
        fmt::format("{}: no body is flexible and has a mesh; expected one whose matrices can be written", scene.file));
  const output::ResultFolder results = output::prepare_folder(comm, folder, overwrite);
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    if (is_meshed(plan.bodies[b].spec)) write_body_matrices(plan, static_cast<int>(b), results.path);
  return names;
}

}  // namespace floe::assembly
