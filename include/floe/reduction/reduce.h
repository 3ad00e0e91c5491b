#pragma once
#include <functional>

#include "floe/body/flexible_body.h"
#include "floe/reduction/projection.h"

namespace floe::reduction {

/// An attachment mode asked for: the response to a unit load, or to a displacement of dofs that are constrained.
struct Attachment {
  std::string label;              ///< `root.moment`
  petsc::VecHandle load;          ///< null: a displacement
  petsc::VecHandle moved;         ///< of dofs among Statics::conditions, zero elsewhere
  bool of_higher_vector = false;  ///< an interface vector beyond the first one of a cut, whose effect is near the cut
};

/// Which derivatives join the basis.
struct DerivativeChoice {
  enum class Which { none, all, count, pairs } which = Which::all;
  int count = 0;  ///< Which::count
  Pairs pairs;    ///< Which::pairs
  bool full = false;
};

/// The basis vectors that derivatives are taken of: modes and attachment modes, independent of one another.
struct Generators {
  Modes modes;
  Columns fields;                     ///< in the floating frame, M-normalised; modes first
  std::vector<ColumnOrigin> origins;  ///< of every field
  std::vector<ColumnOrigin> dropped;  ///< attachment modes that vanish or repeat others
};

/// Modes and attachment modes for the attachments, without what repeats. Collective.
Generators generators(const fem::Structure& structure, const Statics& statics, Modes modes,
                      const std::vector<Attachment>& attachments, double tolerance);

/// The same with the lowest `modes` modes. @param holding  how the body is constrained for its modes. Collective.
Generators generators(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int modes, const std::vector<Attachment>& attachments, double tolerance);

/// Derivative basis vectors with their origins.
struct DerivativeColumns {
  Columns columns;
  std::vector<ColumnOrigin> origins;
};

/// theta of the pairs (of fields). Full derivatives exist for pairs of modes; with attachment columns they are static.
/// Pairs of fields without slope (axial modes of a straight body) have none: their basis vectors are zero.
/// Collective.
DerivativeColumns derivative_columns(const fem::Structure& structure, const fem::ReferenceFrame& frame,
                                     const fem::Holding& holding, const Statics& statics, const Generators& generators,
                                     const Pairs& pairs, bool full);

/// `derivative 1,2` of two generators; with inertia that of the first by the second.
std::string derivative_label(const Generators& generators, int i, int j);

/// Generators and derivatives as one M-orthonormal basis. Collective.
/// @param left_out  of each generator whether it stays out of the basis; empty: none does
Basis basis_of(const fem::Structure& structure, const Generators& generators, DerivativeColumns derivatives,
               double tolerance, const std::vector<char>& left_out = {});

/// Keeps beside a basis of shells (Basis::without_mass) what is left of dropped derivatives without their parts along
/// it, where they have no mass: drilling rotations. In the inner product of M it is nothing, but without it the body
/// locks. Where there are more nodes than columns nothing is left. Collective.
/// @param columns  that the basis was made of, the first of its origins
void keep_without_mass(const fem::Structure& structure, const std::vector<Vec>& columns, Basis& basis);

/// M-norm of a field. Collective.
double mass_norm(Mat M, Vec field);

}  // namespace floe::reduction
