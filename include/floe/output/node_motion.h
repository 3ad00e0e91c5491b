#pragma once
#include <mpi.h>

#include <Eigen/Dense>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace floe::output {

class MotionSource;
struct MovingBody;

/// All dofs of nodes along the motion that the results of a run hold, for what is recovered from them afterwards.
///
///   u(t) = fields x coefficients(t)     reduced: basis and coordinates; full order: states and none
///
/// Opened by each rank for itself; every rank asks for nodes of its own.
class NodeMotion {
 public:
  /// @throws InputError  `motion 'FOLDER': WHAT`. Rank-local: call it within petsc::agree.
  NodeMotion(MPI_Comm comm, const std::filesystem::path& folder);
  ~NodeMotion();
  NodeMotion(const NodeMotion&) = delete;
  NodeMotion& operator=(const NodeMotion&) = delete;

  const std::vector<double>& times() const;
  std::string scene_file() const;  ///< as the run got it
  std::string scene_text() const;
  std::string formulation() const;
  bool has(const std::string& body) const;  ///< with a mesh
  bool reduced(const std::string& body) const;
  std::int64_t nodes(const std::string& body) const;
  /// Undeformed positions in the frame's axes, 3 x nodes.
  Eigen::Matrix3Xd positions(const std::string& body, std::span<const std::int64_t> nodes) const;

  /// Reduced: displacements and rotations of the nodes for a unit of each coordinate, and of the further vectors of the
  /// error estimate, (w nodes) x columns. `corrected`: with the latter.
  Eigen::MatrixXd basis(const std::string& body, std::span<const std::int64_t> nodes, bool corrected) const;
  /// Its coefficients at some instants (rows of times()), columns x instants; `corrected`: with the deviation that the
  /// estimate found, linear between its instants.
  Eigen::MatrixXd coordinates(const std::string& body, std::span<const std::size_t> rows, bool corrected) const;
  /// Whether the results have the deviation of the estimate.
  bool has_correction() const;
  /// Full order: the dofs of the nodes, always the same of a body, at an instant; in formulation cfr in world axes
  /// (motion_source.h).
  Eigen::VectorXd state(const std::string& body, std::span<const std::int64_t> nodes, std::size_t row) const;

 private:
  const MovingBody& body_of(const std::string& name) const;
  std::unique_ptr<MotionSource> source_;
  mutable std::map<std::string, std::vector<double>> where_;  // nodes_of_motion of the nodes asked for last
};

}  // namespace floe::output
