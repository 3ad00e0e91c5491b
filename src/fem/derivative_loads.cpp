#include "floe/fem/field_rows.h"
#include "floe/petsc/stage.h"

namespace floe::fem {

using petsc::check;

namespace {

using Pairs = std::vector<std::array<int, 2>>;

/// Strains e(a, b) of the pairs, and the slopes' forces e(a, .)' L b + e(b, .)' L a: rows x pairs.
struct PairTerms {
  FieldRows strain, pull;
  bool stressed = false;
};

void add_term(const StrainRows::Term& term, Eigen::Index strains, const FieldRows& slope, const FieldRows& stress,
              const Pairs& pairs, PairTerms& out) {
  const int p = term.p, q = term.q;
  const Eigen::Map<const Eigen::VectorXd> C(term.C.data(), strains);
  for (std::size_t t = 0; t < pairs.size(); ++t) {
    const auto [i, j] = pairs[t];
    const double product = slope(p, i) * slope(q, j) + (p == q ? 0 : slope(q, i) * slope(p, j));
    for (Eigen::Index r = 0; r < strains; ++r) out.strain(r, t) += C[r] * product;
    if (!out.stressed) continue;
    const double tension_i = C.dot(stress.col(i).head(strains)), tension_j = C.dot(stress.col(j).head(strains));
    out.pull(p, t) += tension_j * slope(q, i) + tension_i * slope(q, j);
    if (p != q) out.pull(q, t) += tension_j * slope(p, i) + tension_i * slope(p, j);
  }
}

}  // namespace

petsc::MatHandle derivative_loads(const Structure& structure, const FieldRows& fields, const Pairs& pairs) {
  const petsc::Stage stage("derivatives' loads");
  const DofRanges ranges = dof_ranges(structure, fields);
  const Eigen::Index n = static_cast<Eigen::Index>(pairs.size());
  FieldRows sums = FieldRows::Zero(structure.local_dofs(), n), slope, stress(most_strains, fields.cols());
  PairTerms terms{FieldRows(most_strains, n), {}, false};
  std::vector<PieceRows> pieces;
  for (const Mesh::Cell& cell : structure.mesh.cells) {
    piece_rows(structure, cell, {.strain = true}, pieces);
    for (const PieceRows& piece : pieces)
      for (const StrainRows& point : piece.strain) {
        const Eigen::Index strains = point.L.rows(), slopes = point.G.rows();
        if (slope.rows() < slopes) slope.resize(slopes, fields.cols()), terms.pull.resize(slopes, n);
        if (multiply(structure, piece, point.G, fields, ranges, slope.data()).empty()) continue;
        terms.stressed = !multiply(structure, piece, point.L, fields, ranges, stress.data()).empty();
        terms.strain.topRows(strains).setZero(), terms.pull.topRows(slopes).setZero();
        for (const StrainRows::Term& term : point.terms) add_term(term, strains, slope, stress, pairs, terms);
        terms.strain.topRows(strains) *= -1, terms.pull.topRows(slopes) *= -1;
        add_transposed(structure, piece, point.L, terms.strain.data(), sums);
        if (terms.stressed) add_transposed(structure, piece, point.G, terms.pull.data(), sums);
      }
  }
  petsc::MatHandle loads;
  check(MatCreateDense(structure.mesh.comm, structure.owned_dofs(), PETSC_DECIDE, structure.dofs(),
                       static_cast<PetscInt>(n), nullptr, loads.out()));
  add(structure, sums, loads);
  check(MatAssemblyBegin(loads, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(loads, MAT_FINAL_ASSEMBLY));
  return loads;
}

}  // namespace floe::fem
