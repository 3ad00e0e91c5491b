#pragma once
#include <mpi.h>

#include <Eigen/Dense>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ordered_rows.h"

/// The motion that a result.h5 holds, node by node.
namespace floe::output {

/// A body, and this rank's share of its nodes.
struct MovingBody {
  std::string name;
  std::int64_t nodes = 0, cells = 0;
  std::int64_t first = 0;                 ///< of this rank's nodes
  Eigen::Matrix3Xd positions;             ///< X, in the axes of the frame [m]
  int width = 3;                          ///< dofs of a node: (u, v, rotation), or six
  Eigen::MatrixXd basis;                  ///< 3 own nodes x k: displacements
  std::vector<std::int64_t> columns;      ///< full order: of motion/U, of each own node
  Eigen::Matrix3Xd arms;                  ///< full order
  std::int64_t frame = -1, elastic = -1;  ///< columns of motion/U
  std::int64_t coordinates = 0;           ///< reduced ones; fewer than the basis has in formulation vm
  std::int64_t attitude = -1;             ///< column of motion/attitude
  Eigen::Vector3d place;                  ///< of the frame at the start
  Eigen::Matrix3d axes;                   ///< likewise
  /// Of cfr: displacement and angle in world axes; in space the node's place and its rotation vector there.
  bool dofs_in_world = false;
};

/// What a run kept of an instant.
struct MotionRow {
  double t;
  std::vector<double> U, attitude;
};

/// Opened by each rank for itself, to read its share.
class MotionSource {
 public:
  /// @throws InputError  `motion 'FOLDER': WHAT`. Rank-local: call it within petsc::agree.
  MotionSource(MPI_Comm comm, const std::filesystem::path& folder);
  const std::vector<double>& times() const { return times_; }
  const std::vector<MovingBody>& bodies() const { return bodies_; }
  const std::vector<std::string>& without() const { return without_; }
  MotionRow row(std::size_t index) const;
  hid_t file() const { return file_; }
  const nlohmann::json& summary() const { return summary_; }
  /// Rows (four nodes, part, kind) of this rank's share of the cells; and where it begins.
  Integers cells(const MovingBody& body, std::int64_t& first) const;

 private:
  void read_times();
  void read_body(const std::string& name, int& frames_in_space);
  void read_nodes(MovingBody& body, const std::string& group);
  MPI_Comm comm_;
  std::filesystem::path folder_;
  Hid file_;
  nlohmann::json summary_;
  int dimension_ = 3;
  bool in_world_ = false;
  std::vector<double> times_;
  hsize_t unknowns_ = 0, attitudes_ = 0;
  std::vector<MovingBody> bodies_;
  std::vector<std::string> without_;
};

/// Places of the own nodes, and their deformations in world axes. [m]
struct MovedNodes {
  Eigen::Matrix3Xd x, deformation;
};
MovedNodes moved(const MovingBody& body, const MotionRow& row, double amplify);

}  // namespace floe::output
