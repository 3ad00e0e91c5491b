#pragma once
#include <string>

#include "floe/reduction/derivatives.h"

namespace floe::reduction {

/// What a vector of the basis came from, and whether it stayed.
struct ColumnOrigin {
  enum class Kind { mode, derivative, attachment } kind;
  std::string label;    ///< `mode 3`, `derivative 1,2`, `attachment root.moment`
  double omega = 0;     ///< modes [rad/s]
  double new_part = 1;  ///< share of the scaled basis vector that the basis vectors before it lack
  bool kept = true;
  double interaction = 0;         ///< derivatives chosen by count: modal interaction relative to the maximum
  std::string dropped = {};       ///< why, where it is not its new part: `repeats tip.fx` of an attachment mode
  bool of_higher_vector = false;  ///< an attachment mode that is (Attachment)
};

/// V = [phi theta ...], M-orthonormal: V' M V = 1. k basis vectors.
struct Basis {
  petsc::BvHandle V;
  int columns = 0;
  std::vector<ColumnOrigin> origins;  ///< of every candidate, in order
  Eigen::VectorXd norms;              ///< M-norms of the candidates
  /// What dropped derivatives have without mass (drilling rotations of shells), over which the elastic energy is
  /// condensed. Of shells of no more nodes than candidates.
  Columns without_mass;
};

/// Orthonormalises candidates in their order, in the M inner product; a column whose new part is below `tolerance`
/// times its norm adds nothing and is dropped. Of more columns than elastic dofs those with the smallest new parts are.
///
/// @param candidates  in the floating frame; at least one
/// Collective. Cholesky of the Gram matrix, again and again until it is 1: two or three passes over the elements and
/// products of blocks, where columns that depend much on those before them wait for the next pass.
Basis orthonormal_basis(const fem::Structure& structure, const Columns& candidates, std::vector<ColumnOrigin> origins,
                        double tolerance);
/// The same for the fields of `candidates`, which are used up.
Basis orthonormal_basis(const fem::Structure& structure, fem::FieldRows candidates, std::vector<ColumnOrigin> origins,
                        double tolerance);

}  // namespace floe::reduction
