#pragma once
#include <memory>

#include "floe/fem/assembly.h"

namespace floe::fem {

/// q less the rigid motion of the element's first node: u_i - u_1 - theta_1 x (x_i - x_1), theta_i - theta_1.
///
/// K_e T q = K_e q in exact numbers. In rounded ones the differences are formed before they are multiplied by EI/h^3,
/// and the error falls from eps (L/h)^4 of the strain energy to eps (L/h)^2.
///
/// @param q     columns of displacements: per node u (2) and a rotation in the plane, u (3) and rotations (3) in space
/// @param arms  x_i - x_1 of the element's nodes
void take_rigid_motion(Eigen::Ref<Eigen::MatrixXd> q, const Eigen::Matrix3Xd& arms);

/// x_i - x_1 of an element's nodes.
Eigen::Matrix3Xd arms(const Mesh& mesh, const Mesh::Cell& cell);

/// K as the sum of its elements, never assembled: element by element the rigid motion is taken off first.
///
/// An assembled K, and with it every factor of K, misses the energy of the lowest modes by eps (L/h)^4 of it, h the
/// size of an element: 1e-3 at 4096 elements along a beam, more than all of it at 16384. Keeps each element's matrix in
/// the plane; in space they would fill the memory: those of beams are made anew, shells are squares of a few rows.
class ElementStiffness {
 public:
  /// @param structure  borrowed. Rank-local.
  explicit ElementStiffness(const Structure& structure);
  /// f = K q, without conditions. Collective.
  void multiply(Vec q, Vec f) const;
  /// U = 1/2 q'K q, a sum over elements. Collective.
  double strain_energy(Vec q) const;
  /// sums += K X of this rank's elements. Rank-local.
  void add_forces(const FieldRows& X, FieldRows& sums) const;
  /// X'K X, the same on all ranks. Collective.
  Eigen::MatrixXd gram(const FieldRows& X) const;
  /// Of the elements of all ranks. Collective at the first call.
  double largest_diagonal() const;
  const Structure& structure() const { return structure_; }

 private:
  /// K_e T q_e of every line (or point) element, handed to `sink` with T q_e.
  template <class Sink>
  void each_line(const FieldRows& X, Sink&& sink) const;
  /// Rows R of every piece of a shell, K_e = sum R'R, handed to `sink` with R T q_e by rows.
  template <class Sink>
  void each_shell(const FieldRows& X, Sink&& sink) const;
  const Structure& structure_;
  mutable double largest_ = -1;     ///< not known yet
  std::vector<Eigen::MatrixXd> K_;  ///< in the plane
};

/// The same K as a MATSHELL under conditions: their rows and columns are empty but for the largest diagonal entry, as
/// those of stiffness(). The shell keeps `elements` alive. Collective.
petsc::MatHandle stiffness_operator(std::shared_ptr<const ElementStiffness> elements, const Conditions& conditions);

}  // namespace floe::fem
