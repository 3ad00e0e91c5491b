#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "floe/fem/stress_rows.h"
#include "floe/output/motion_file.h"
#include "floe/output/node_motion.h"
#include "floe/plan/prepare.h"

namespace floe::assess {
using namespace plan;

/// Why stresses at an element need not converge with the mesh.
enum class Singular { none = 0, point = 1, end_of_edge = 2, corner = 3 };

/// Stresses of the elements of a body along a motion, from the displacements of their nodes: of shells at the middle of
/// each element (of second order: at what stands for it in pictures), of beams at both ends.
///
/// Rows are made once for each element; instants are products with them:
///
///   s = L q + 1/2 (G q)'P(G q),   q = V (eta + d) + W zeta (reduced; d, zeta what the error estimate found) or u
///
/// Formulation cfr: q is what is left of the nodes' displacements and rotations in the mean axes of the element.
class BodyStress {
 public:
  /// @param name       of the body in the results
  /// @param corrected  with the deviation of the error estimate
  /// @throws InputError  the body is not that of the results. Collective.
  BodyStress(const Plan& plan, int body, std::string name, const output::NodeMotion& motion, bool corrected);

  const std::vector<output::ReducedShapes::Cell>& cells() const { return cells_; }
  const std::vector<Eigen::Vector3d>& centres() const { return centres_; }  ///< of cells(), undeformed, mesh axes
  const std::vector<Singular>& singular() const { return singular_; }       ///< of cells()
  /// What is recovered of each element, in this order: stress_max, stress_min, von_mises, then those of shells, then
  /// those of beams; not a number where the element has none.
  const std::vector<output::CellField>& fields() const { return fields_; }
  int width() const { return width_; }
  static constexpr int stress_max = 0, stress_min = 1, von_mises = 2;  ///< their places

  /// Calls with the number of each of cells() and its values at instants [first, first + values.cols()) of `rows`.
  /// @param wanted  of cells(); null: all. Collective.
  void evaluate(std::span<const std::size_t> rows,
                const std::function<void(std::size_t cell, std::size_t first, const fem::SmallRows& values)>& use,
                const std::vector<char>* wanted = nullptr) const;

 private:
  struct Fields;  // displacements of the nodes at some instants
  void find_fields();
  void find_singular(const Plan& plan, int body);
  fem::SmallRows displacements(const fem::Mesh::Cell& cell, const Fields& fields) const;
  void add_shell(const fem::Mesh::Cell& cell, const Fields& fields, std::vector<fem::SmallRows>& values) const;
  void add_beam(const fem::Mesh::Cell& cell, const Fields& fields, std::vector<fem::SmallRows>& values) const;

  const PlannedBody& body_;
  std::string name_;
  const output::NodeMotion& motion_;
  bool corrected_, corotational_, linear_;
  std::vector<std::int64_t> nodes_;  // original numbers of the local ones
  std::vector<output::ReducedShapes::Cell> cells_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Singular> singular_;
  std::vector<output::CellField> fields_;
  int width_ = 0, shells_ = -1, beams_ = -1, layers_ = 0;  // where the fields of each begin; of laminates
  Eigen::MatrixXd basis_;                                  // reduced: at the local dofs
};

}  // namespace floe::assess
