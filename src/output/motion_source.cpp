#include "motion_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "floe/petsc/error.h"
#include "reduced_file_hdf5.h"

namespace floe::output {
namespace {

bool has(hid_t file, const std::string& name) {
  for (auto end = name.find('/'); end != std::string::npos; end = name.find('/', end + 1))
    if (H5Lexists(file, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0 && H5Oexists_by_name(file, name.c_str(), H5P_DEFAULT) > 0;
}

Extent extent_of(hid_t file, const std::string& name) {
  Extent extent = series_extent(file, name);
  if (extent.size() != 2) fail(name, "a series", "none");
  return extent;
}

/// Rows of a series, whatever their numbers are: behind the last row of a killed run there are none.
std::vector<double> series_rows(hid_t file, const std::string& name, hsize_t first, hsize_t rows) {
  const hsize_t columns = extent_of(file, name)[1], start[2] = {first, 0}, count[2] = {rows, columns};
  std::vector<double> all(rows * columns);
  if (all.empty()) return all;
  const Hid dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), there(H5Dget_space(dataset), H5Sclose),
      here(H5Screate_simple(2, count, nullptr), H5Sclose);
  check_hdf5(H5Sselect_hyperslab(there, H5S_SELECT_SET, start, nullptr, count, nullptr));
  check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, all.data()));
  return all;
}

std::vector<double> finite_row(hid_t file, const std::string& name, hsize_t index) {
  auto row = series_rows(file, name, index, 1);
  if (!std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); }))
    throw RunError(fmt::format("{}: row {} has a number that is none", name, index + 1));
  return row;
}

Eigen::Matrix3Xd columns3(const std::vector<double>& rows) {
  return Eigen::Map<const Eigen::Matrix3Xd>(rows.data(), 3, static_cast<Eigen::Index>(rows.size() / 3));
}

}  // namespace

MotionSource::MotionSource(MPI_Comm comm, const std::filesystem::path& folder) : comm_(comm), folder_(folder) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("motion '{}': {}", folder.string(), why));
  };
  if (!std::filesystem::is_directory(folder)) refuse("is not there; expected the folder of a run");
  if (!std::filesystem::exists(folder / "result.h5")) refuse("has no result.h5; expected the folder of a run");
  try {
    silence_hdf5();
    const Hid access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    check_hdf5(H5Pset_file_locking(access, false, true));
    file_ = Hid(H5Fopen((folder / "result.h5").c_str(), H5F_ACC_RDONLY, access), H5Fclose);
    if (!has(file_, "motion/t") || !has(file_, "motion/dimension"))
      throw Fault("result.h5 has no node positions of the bodies; run the scene again with this version");
    dimension_ = static_cast<int>(read_whole<double>(file_, "motion/dimension", {}).front());
    summary_ = nlohmann::json::parse(read_text(file_, "summary"));
    const nlohmann::json& summary = summary_;
    in_world_ = summary.value("formulation", "") == "cfr";
    read_times();
    unknowns_ = extent_of(file_, "motion/U")[1];
    attitudes_ = has(file_, "motion/attitude") ? extent_of(file_, "motion/attitude")[1] : 0;
    // Attitudes stand in the order of the bodies, which is that of their columns in U, or of the scene.
    std::vector<std::string> names;
    for (const auto& body : summary.at("bodies")) names.push_back(body.at("name"));
    int frames_in_space = 0;
    for (const std::string& name : names) read_body(name, frames_in_space);
  } catch (const Fault& fault) {
    refuse(fault.what());
  } catch (const RunError& fault) {
    refuse(fmt::format("result.h5: {}", fault.what()));
  } catch (const nlohmann::json::exception& fault) {
    refuse(fmt::format("result.h5: its summary cannot be read: {}", fault.what()));
  }
  if (times_.empty()) refuse("result.h5 has no instant yet");
  if (bodies_.empty()) refuse("no body of the run has a mesh in its results");
}

void MotionSource::read_times() {
  const hsize_t rows = std::min(extent_of(file_, "motion/U")[0], extent_of(file_, "motion/t")[0]);
  times_ = series_rows(file_, "motion/t", 0, rows);
  times_.erase(std::find_if_not(times_.begin(), times_.end(), [](double t) { return std::isfinite(t); }), times_.end());
}

void MotionSource::read_body(const std::string& name, int& frames_in_space) {
  const std::string group = "bodies/" + name;
  MovingBody body;
  body.name = name;
  const auto columns = read_whole<double>(file_, group + "/columns_of_motion", {2});
  body.frame = std::lround(columns[0]), body.elastic = std::lround(columns[1]);
  if (body.elastic >= 0) {
    body.coordinates = static_cast<std::int64_t>(unknowns_) - body.elastic;
    for (const auto& of : summary_.at("bodies"))
      if (of.at("name") == name)
        body.coordinates = std::min(body.coordinates, of.value("reduced_coordinates", body.coordinates));
  }
  if (dimension_ == 3 && body.frame >= 0) body.attitude = 4 * static_cast<std::int64_t>(frames_in_space++);
  if (!has(file_, group + "/shapes")) {
    without_.push_back(name);
    return;
  }
  const auto frame = read_whole<double>(file_, group + "/frame_at_start", {4, 3});
  const Eigen::Matrix<double, 3, 4> parts = columns3(frame);
  body.place = parts.col(0), body.axes = parts.rightCols<3>();
  body.width = dimension_ == 3 ? 6 : 3;
  read_nodes(body, group);
  body.dofs_in_world = in_world_ && !body.columns.empty();
  bodies_.push_back(std::move(body));
}

void MotionSource::read_nodes(MovingBody& body, const std::string& group) {
  Extent all = series_extent(file_, group + "/shapes/positions");
  if (all.size() != 2 || all[1] != 3) fail(group + "/shapes/positions", "n x 3 numbers", "none");
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  const Shares shares(comm_, static_cast<std::int64_t>(all[0]));
  body.nodes = static_cast<std::int64_t>(all[0]), body.first = shares.first(rank);
  const hsize_t first = body.first, own = shares.size(rank), width = body.width;
  body.positions = columns3(read_block<double>(file_, group + "/shapes/positions", all, {first, 0}, {own, 3}));
  body.cells = static_cast<std::int64_t>(series_extent(file_, group + "/shapes/cells/nodes").at(0));
  if (body.elastic >= 0 && has(file_, group + "/shapes/basis")) {
    Extent shape = series_extent(file_, group + "/shapes/basis");
    if (shape.size() != 3 || shape[1] != all[0] || shape[2] != width)
      fail(group + "/shapes/basis", "columns x nodes x dofs", "another shape");
    const hsize_t k = std::min(shape[0], static_cast<hsize_t>(body.coordinates));
    const auto numbers = read_block<double>(file_, group + "/shapes/basis", shape, {0, first, 0}, {k, own, width});
    body.basis = Eigen::MatrixXd::Zero(3 * own, k);
    const hsize_t moves = width == 6 ? 3 : 2;
    for (hsize_t j = 0; j < k; ++j)
      for (hsize_t i = 0; i < own; ++i)
        for (hsize_t d = 0; d < moves; ++d) body.basis(3 * i + d, j) = numbers[(j * own + i) * width + d];
  }
  if (!has(file_, group + "/nodes_of_motion")) return;
  const auto rows = read_block<double>(file_, group + "/nodes_of_motion", {all[0], 4}, {first, 0}, {own, 4});
  body.arms.resize(3, own);
  for (hsize_t i = 0; i < own; ++i) {
    body.columns.push_back(std::lround(rows[4 * i]));
    body.arms.col(i) << rows[4 * i + 1], rows[4 * i + 2], rows[4 * i + 3];
    if (body.columns.back() < 0 || body.columns.back() + body.width > static_cast<std::int64_t>(unknowns_))
      fail(group + "/nodes_of_motion", "columns of motion/U", "others");
  }
}

MotionRow MotionSource::row(std::size_t index) const {
  MotionRow row{times_[index], finite_row(file_, "motion/U", index), {}};
  if (attitudes_ > 0) row.attitude = finite_row(file_, "motion/attitude", index);
  return row;
}

Integers MotionSource::cells(const MovingBody& body, std::int64_t& first) const {
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  const Shares shares(comm_, body.cells);
  first = shares.first(rank);
  const std::string group = "bodies/" + body.name + "/shapes/cells/";
  const hsize_t start = first, own = shares.size(rank), all = body.cells;
  const auto nodes = read_block<std::int64_t>(file_, group + "nodes", {all, 4}, {start, 0}, {own, 4});
  const auto part = read_block<std::int64_t>(file_, group + "part", {all}, {start}, {own});
  const auto kind = read_block<std::int64_t>(file_, group + "kind", {all}, {start}, {own});
  Integers rows;
  for (hsize_t c = 0; c < own; ++c) {
    rows.insert(rows.end(), nodes.begin() + 4 * c, nodes.begin() + 4 * c + 4);
    rows.insert(rows.end(), {part[c], kind[c]});
  }
  return rows;
}

namespace {

/// Displacements in the axes in which the dofs are given.
Eigen::Matrix3Xd displacements(const MovingBody& body, const MotionRow& row) {
  Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Zero(3, body.positions.cols());
  if (body.basis.cols() > 0) {
    const Eigen::Map<const Eigen::VectorXd> eta(row.U.data() + body.elastic, body.basis.cols());
    u.reshaped() = body.basis * eta;
  }
  for (Eigen::Index i = 0; i < std::ssize(body.columns); ++i) {
    const double* dofs = row.U.data() + body.columns[i];
    const Eigen::Vector3d arm = body.arms.col(i);
    if (body.width == 6 && body.dofs_in_world) {
      const Eigen::Vector3d rotation(dofs[3], dofs[4], dofs[5]), arm_there = body.axes * arm;
      const Eigen::Matrix3d Q = rotation.norm() > 0
                                    ? Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix()
                                    : Eigen::Matrix3d::Identity();
      u.col(i) =
          Eigen::Vector3d(dofs[0], dofs[1], dofs[2]) + Q * arm_there - body.place - body.axes * body.positions.col(i);
    } else if (body.width == 6)
      u.col(i) = Eigen::Vector3d(dofs[0], dofs[1], dofs[2]) + Eigen::Vector3d(dofs[3], dofs[4], dofs[5]).cross(arm);
    else
      u.col(i) << dofs[0] - dofs[2] * arm.y(), dofs[1] + dofs[2] * arm.x(), 0;
  }
  return u;
}

}  // namespace

MovedNodes moved(const MovingBody& body, const MotionRow& row, double amplify) {
  Eigen::Vector3d R = body.place;
  Eigen::Matrix3d A = body.axes;
  if (body.attitude >= 0) {
    const double* q = row.attitude.data() + body.attitude;
    A = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    R = Eigen::Map<const Eigen::Vector3d>(row.U.data() + body.frame);
  } else if (body.frame >= 0) {
    const double* frame = row.U.data() + body.frame;
    A = Eigen::AngleAxisd(frame[2], Eigen::Vector3d::UnitZ()).toRotationMatrix();
    R = Eigen::Vector3d(frame[0], frame[1], 0);
  }
  MovedNodes at;
  at.deformation = body.dofs_in_world ? displacements(body, row) : Eigen::Matrix3Xd(A * displacements(body, row));
  at.x = (A * body.positions + amplify * at.deformation).colwise() + R;
  return at;
}

}  // namespace floe::output
