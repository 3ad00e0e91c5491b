#pragma once
#include "floe/reduction/reduce.h"

namespace floe::reduction {

/// Responses to attachments, in their order, and what became of each.
struct StaticColumns {
  Columns columns;                    ///< of all; of those that are dropped anything
  std::vector<ColumnOrigin> origins;  ///< kept: whether it stays; those that go tell which they repeat
};

/// Responses to unit loads, and constraint modes.
///
/// Where a body is much softer one way than another, oblique loads all bend it: of u_j = K^-1 f_j, what u_i lacks is
/// (t/L)^2 of it, and no difference of rounded u recovers it. So the difference is taken of the loads. With the
/// compliance c_ij = f_i' u_j, S its matrix scaled to a unit diagonal, loads in the order of the greatest compliance
/// that is left (pivoted Cholesky of S): where those before hold all but 1 % of c_jj,
///
///   f_j <- f_j - sum_i b_i f_i,  sum_i c_ki b_i = c_kj,    u_j = K^-1 f_j by a further solve,
///
/// so that u_j is K-orthogonal to u_i, vanishes at the earlier places along their loads, and has its own size. Again
/// until nothing is left to take off: a contrast of 1e8 needs two passes, each sees eps c_jj / c of its predecessors.
/// The span is the same; other columns are left as they are. A load that vanishes repeats those it was made of.
///
/// A moment counts as the force that has it over the body's extent. Collective; the same on all ranks.
StaticColumns static_columns(const fem::Structure& structure, const Statics& statics,
                             const std::vector<Attachment>& attachments);

}  // namespace floe::reduction
