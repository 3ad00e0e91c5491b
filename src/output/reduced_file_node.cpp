#include <fmt/format.h>

#include "dataset.h"
#include "floe/output/reduced_file.h"
#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"
#include "reduced_file_image.h"

namespace floe::output {
namespace {

struct Found {
  std::int64_t number = 0;
  double distance = 0, extent = 0;
};

/// @param positions  n x 3, row-major
Found nearest(const std::vector<double>& positions, const Eigen::Vector3d& x) {
  Found found{0, HUGE_VAL, 0};
  Eigen::Vector3d low = Eigen::Vector3d::Constant(HUGE_VAL), high = -low;
  for (std::size_t i = 0; 3 * i < positions.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3d> at(&positions[3 * i]);
    low = low.cwiseMin(at), high = high.cwiseMax(at);
    if (const double distance = (at - x).norm(); distance < found.distance)
      found.number = static_cast<std::int64_t>(i), found.distance = distance;
  }
  found.extent = (high - low).norm();
  return found;
}

/// The node's row of every column: x, then S and psi column by column.
std::vector<double> read_node(hid_t file, const ReducedBodyFile& body, const Eigen::Vector3d& x, Found& found) {
  const hsize_t n = body.nodes, k = body.body.coordinates(), width = body.dofs / std::max<std::int64_t>(1, body.nodes);
  const auto positions = read_whole<double>(file, "shapes/positions", {n, 3});
  found = nearest(positions, x);
  std::vector<double> row(positions.begin() + 3 * found.number, positions.begin() + 3 * found.number + 3);
  const auto basis =
      read_block<double>(file, "shapes/basis", {k, n, width}, {0, hsize_t(found.number), 0}, {k, 1, width});
  row.insert(row.end(), basis.begin(), basis.end());
  return row;
}

body::PlaceMap map_of(const std::vector<double>& row, int dimension, Eigen::Index k) {
  const int rotations = dimension == 2 ? 1 : 3, width = dimension + rotations;
  const Eigen::Map<const Eigen::MatrixXd> columns(row.data() + 3, width, k);
  return {Eigen::Map<const Eigen::VectorXd>(row.data(), dimension), columns.topRows(dimension),
          columns.bottomRows(rotations)};
}

}  // namespace

ReducedNode nearest_node(MPI_Comm comm, const std::filesystem::path& path, const ReducedBodyFile& body,
                         const Eigen::VectorXd& x) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const Eigen::Index k = body.body.coordinates();
  const int width = body.dimension == 2 ? 3 : 6;
  std::vector<double> row(3 + width * k);
  Found found;
  petsc::agree(comm, [&] {
    if (rank != 0) return;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    point.head(x.size()) = x;
    try {
      silence_hdf5();
      const Hid access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      check_hdf5(H5Pset_file_locking(access, false, true));
      const Hid file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
      row = read_node(file, body, point, found);
    } catch (const std::exception& error) {
      throw InputError(fmt::format("reduced body '{}': {}", path.string(), error.what()));
    }
  });
  MPI_Bcast(row.data(), static_cast<int>(row.size()), MPI_DOUBLE, 0, comm);
  MPI_Bcast(&found.number, 1, MPI_INT64_T, 0, comm);
  double lengths[2] = {found.distance, found.extent};
  MPI_Bcast(lengths, 2, MPI_DOUBLE, 0, comm);
  return {found.number, lengths[0], lengths[1], map_of(row, body.dimension, k)};
}

}  // namespace floe::output
