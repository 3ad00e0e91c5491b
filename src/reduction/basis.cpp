#include "floe/reduction/basis.h"

namespace floe::reduction {

using petsc::check;

Basis orthonormal_basis(const fem::Structure& structure, const Columns& candidates, std::vector<ColumnOrigin> origins,
                        double tolerance) {
  Basis basis;
  basis.origins = std::move(origins);
  const petsc::MatHandle M = fem::mass(structure, {});
  const petsc::VecHandle like = fem::field(structure);
  check(BVCreate(structure.mesh.comm, basis.V.out()));
  check(BVSetSizesFromVec(basis.V, like, std::max<PetscInt>(1, static_cast<PetscInt>(candidates.size()))));
  check(BVSetFromOptions(basis.V));
  check(BVSetMatrix(basis.V, M, PETSC_FALSE));
  check(BVSetOrthogonalization(basis.V, BV_ORTHOG_CGS, BV_ORTHOG_REFINE_ALWAYS, PETSC_DEFAULT, BV_ORTHOG_BLOCK_GS));
  check(BVSetActiveColumns(basis.V, 0, 0));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    double norm = 0, left = 0;
    check(BVInsertVec(basis.V, basis.columns, candidates[i]));
    check(BVNormColumn(basis.V, basis.columns, NORM_2, &norm));
    if (norm > 0) {
      check(BVScaleColumn(basis.V, basis.columns, 1 / norm));
      check(BVOrthogonalizeColumn(basis.V, basis.columns, nullptr, &left, nullptr));
    }
    basis.origins[i].new_part = left;
    basis.origins[i].kept = left > tolerance;
    if (!basis.origins[i].kept) continue;
    check(BVScaleColumn(basis.V, basis.columns, 1 / left));
    check(BVOrthogonalizeColumn(basis.V, basis.columns, nullptr, &left, nullptr));  // what scaling up has brought back
    check(BVScaleColumn(basis.V, basis.columns, 1 / left));
    ++basis.columns;
  }
  check(BVSetActiveColumns(basis.V, 0, basis.columns));
  return basis;
}

}  // namespace floe::reduction
