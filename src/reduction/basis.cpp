#include "floe/reduction/basis.h"

#include <fmt/format.h>
#include <petscblaslapack.h>
#include <petscsf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "floe/fem/element_stiffness.h"
#include "floe/fem/field_rows.h"
#include "floe/fem/piece_rows.h"
#include "floe/petsc/stage.h"
#include "floe/petsc/values.h"
#include "mass_forms.h"

namespace floe::reduction {

using petsc::check;

namespace {

/// Columns whose new part is below this share wait for the next pass: of a share s, Cholesky of a Gram matrix sees all
/// but eps / s^2.
constexpr double weak = 1e-4;

/// A pass that finds columns no further from orthogonal leaves them so to round-off.
constexpr double nearly = 1e-3;

/// V'MV of all ranks, the same on all.
Eigen::MatrixXd gram(const fem::Structure& structure, const fem::FieldRows& X) {
  Eigen::MatrixXd mine = mass_gram(structure, X), all = mine;
  const int count = static_cast<int>(mine.size());
  MPI_Reduce(mine.data(), all.data(), count, MPI_DOUBLE, MPI_SUM, 0, structure.mesh.comm);
  MPI_Bcast(all.data(), count, MPI_DOUBLE, 0, structure.mesh.comm);
  return all;
}

/// Divides by the norms of both columns; what is round-off becomes zero, so that columns that have nothing in common
/// keep their zeros.
Eigen::MatrixXd scaled(const Eigen::MatrixXd& G, const Eigen::VectorXd& norms) {
  const Eigen::VectorXd inverse = (norms.array() > 0).select(norms.cwiseInverse(), 0);
  const Eigen::MatrixXd S = inverse.asDiagonal() * G * inverse.asDiagonal();
  return (S.array().abs() > 4e-16).select(S, 0);
}

struct Column {
  double share = 1;  ///< that those before it lack
  bool kept = true;
  /// Whether it may be round-off of those before it.
  bool suspect() const { return kept && share < weak; }
};

/// One pass: the columns of X T are orthonormal, but for weak ones, which are left as they are without their parts
/// along those before them; dropped ones are zero.
struct Step {
  Eigen::MatrixXd T;
  bool done = true;
};

/// @param S  Gram matrix of the columns scaled to norm 1
Step orthogonalise(const Eigen::MatrixXd& S, double tolerance, std::vector<Column>& columns) {
  const Eigen::Index k = S.cols();
  Step step{Eigen::MatrixXd::Zero(k, k)};
  std::vector<Eigen::Index> accepted;
  for (Eigen::Index i = 0; i < k; ++i) {
    Column& column = columns[i];
    if (!column.kept) continue;
    Eigen::VectorXd t = Eigen::VectorXd::Unit(k, i);
    double common = 0;
    for (Eigen::Index j : accepted) {
      const double along = step.T.col(j).dot(S.col(i));
      if (along == 0) continue;
      t -= along * step.T.col(j);
      common += along * along;
      step.done = step.done && std::abs(along) < nearly;
    }
    const double share = std::sqrt(std::max(0.0, 1 - common));
    if (share < weak) {
      step.done = false;
      step.T.col(i) = t;
      continue;
    }
    column.share *= share;
    column.kept = column.share > tolerance;
    if (!column.kept) continue;
    step.T.col(i) = t / share;
    accepted.push_back(i);
  }
  return step;
}

/// X <- X T, some rows at a time, those of each dof of a node by themselves with the columns that are not zero there; T
/// is upper triangular.
void multiply(const fem::Structure& structure, fem::FieldRows& X, const Eigen::MatrixXd& T) {
  constexpr Eigen::Index together = 1024;
  const int per_node = structure.dofs_per_node;
  const Eigen::Index nodes = X.rows() / per_node, columns = X.cols();
  const fem::DofRanges ranges = fem::dof_ranges(structure, X);
  fem::FieldRows product(together, columns);
  const double one = 1, zero = 0;
  const PetscBLASInt lead = static_cast<PetscBLASInt>(columns), apart = static_cast<PetscBLASInt>(per_node * columns);
  for (int d = 0; d < per_node; ++d) {
    const PetscBLASInt begin = ranges[d].begin, inner = ranges[d].end - begin, many = lead - begin;
    if (ranges[d].empty()) continue;
    for (Eigen::Index first = 0; first < nodes; first += together) {
      const PetscBLASInt rows = static_cast<PetscBLASInt>(std::min(together, nodes - first));
      double* block = X.row(per_node * first + d).data() + begin;  // T is upper triangular: nothing before `begin`
      BLASgemm_("T", "N", &many, &rows, &inner, &one, &T(begin, begin), &lead, block, &apart, &zero, product.data(),
                &lead);
      for (PetscBLASInt i = 0; i < rows; ++i)
        std::copy_n(product.row(i).data(), many, block + static_cast<std::ptrdiff_t>(i) * apart);
    }
  }
}

/// Takes the rows of foreign nodes from their owners: what a pass makes of almost dependent columns is round-off of
/// theirs, in which the copies would differ.
class ForeignRows {
 public:
  explicit ForeignRows(const fem::Structure& structure, Eigen::Index columns) {
    const fem::Mesh& mesh = structure.mesh;
    const PetscInt first = mesh.owned_nodes;
    std::vector<PetscInt> rows(mesh.foreign.size());
    std::iota(rows.begin(), rows.end(), first);
    PetscLayout layout = nullptr;
    check(PetscLayoutCreateFromSizes(mesh.comm, first, PETSC_DECIDE, 1, &layout));
    check(PetscSFCreate(mesh.comm, owners_.out()));
    check(PetscSFSetGraphLayout(owners_, layout, static_cast<PetscInt>(rows.size()), rows.data(), PETSC_COPY_VALUES,
                                mesh.foreign.data()));
    check(PetscLayoutDestroy(&layout));
    MPI_Type_contiguous(static_cast<int>(structure.dofs_per_node * columns), MPI_DOUBLE, &row_);
    MPI_Type_commit(&row_);
  }
  ForeignRows(const ForeignRows&) = delete;
  ForeignRows& operator=(const ForeignRows&) = delete;
  ~ForeignRows() { MPI_Type_free(&row_); }

  void update(fem::FieldRows& X) const {
    check(PetscSFBcastBegin(owners_, row_, X.data(), X.data(), MPI_REPLACE));
    check(PetscSFBcastEnd(owners_, row_, X.data(), X.data(), MPI_REPLACE));
  }

 private:
  petsc::ScatterHandle owners_;
  MPI_Datatype row_ = MPI_DATATYPE_NULL;
};

/// Makes the columns of X orthonormal; those that are not kept become zero.
std::vector<Column> orthonormalise(const fem::Structure& structure, double tolerance, fem::FieldRows& X,
                                   Eigen::VectorXd& norms) {
  std::vector<Column> columns(X.cols());
  const ForeignRows foreign(structure, X.cols());
  norms = Eigen::VectorXd::Zero(X.cols());
  for (bool first = true, done = X.cols() == 0; !done; first = false) {
    const Eigen::MatrixXd G = gram(structure, X);
    const Eigen::VectorXd sizes = G.diagonal().cwiseMax(0).cwiseSqrt();
    if (first) norms = sizes;
    for (Eigen::Index i = 0; i < X.cols(); ++i) {
      if (!columns[i].kept) continue;
      columns[i].share *= first ? (sizes[i] > 0 ? 1 : 0) : sizes[i];
      columns[i].kept = columns[i].share > tolerance;
    }
    Step step = orthogonalise(scaled(G, sizes), tolerance, columns);
    const Eigen::VectorXd inverse = (sizes.array() > 0).select(sizes.cwiseInverse(), 0);
    multiply(structure, X, inverse.asDiagonal() * step.T);
    foreign.update(X);
    done = step.done;
  }
  return columns;
}

/// Of a mesh of shells whose drilling rotations, which have no mass, follow: far above the squares of all frequencies
/// [1/s2], of this rank; 0: of no shells.
double shells_limit(const fem::Structure& structure) {
  double most = 0;
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    const auto* shell = std::get_if<fem::ShellSection>(&structure.sections[cell.part]);
    if (!shell || !(shell->mass > 0)) continue;
    const auto corners = cell.corners();
    const auto at = [&](std::size_t i) { return structure.mesh.positions[corners[i % corners.size()]]; };
    double h2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) h2 = std::min(h2, (at(i + 1) - at(i)).squaredNorm());
    most = std::max(most, (shell->A.trace() / h2 + shell->bending.trace() / (h2 * h2)) / shell->mass);
  }
  return 1e6 * most;
}

/// Columns in which shells by themselves are stiffer for their mass than anything that their mesh can do, and their
/// energies x'K x. Round-off of drilling rotations, which have stiffness and no mass, is all that these can be: what
/// orthonormalisation leaves of a column within the span of others, or a derivative that is zero where there is mass.
/// In a reduced K everything else would be round-off of theirs. Collective.
std::vector<std::pair<Eigen::Index, double>> drilling(const fem::Structure& structure, const fem::FieldRows& X,
                                                      const std::vector<Column>& columns) {
  double limit = shells_limit(structure);
  MPI_Allreduce(MPI_IN_PLACE, &limit, 1, MPI_DOUBLE, MPI_MAX, structure.mesh.comm);
  if (limit == 0) return {};
  const Eigen::Index k = X.cols();
  const fem::DofRanges ranges = fem::dof_ranges(structure, X);
  Eigen::ArrayXXd sums = Eigen::ArrayXXd::Zero(k, 2);  // of each column: of K and of M
  fem::FieldRows values;
  std::vector<fem::PieceRows> pieces;
  for (const fem::Mesh::Cell& cell : structure.mesh.cells) {
    if (!mesh::is_shell(cell.kind)) continue;
    fem::piece_rows(structure, cell, {.bending = true, .strain = true, .mass = true}, pieces);
    for (const fem::PieceRows& piece : pieces) {
      const auto add = [&](const fem::SmallRows& rows, double factor, int to) {
        if (values.rows() < rows.rows()) values.resize(rows.rows(), k);
        if (rows.rows() == 0 || fem::multiply(structure, piece, rows, X, ranges, values.data()).empty()) return;
        sums.col(to) += factor * values.topRows(rows.rows()).array().square().colwise().sum().transpose();
      };
      add(piece.bending, 1, 0);
      for (const fem::StrainRows& point : piece.strain) add(point.L, 1, 0);
      for (const fem::MassRows& sample : piece.mass) add(sample.N, sample.mass, 1);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  MPI_Bcast(sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, 0, structure.mesh.comm);  // to the last bit
  std::vector<std::pair<Eigen::Index, double>> massless;
  for (Eigen::Index i = 0; i < k; ++i)
    if (columns[i].kept && sums(i, 0) > limit * sums(i, 1)) massless.emplace_back(i, sums(i, 0));
  return massless;
}

/// Drops columns of which little was new and that deform the body much less than any other one. Where the others span
/// all elastic motions of a direction (a line has as many along itself as elements), round-off has left a rigid motion
/// of them, which the frame has already: with both, the accelerations would be undetermined.
void drop_rigid(const Eigen::VectorXd& energies, std::vector<Column>& columns, std::vector<ColumnOrigin>& origins) {
  constexpr double of_least = 1e-2;  // of the least square of a frequency
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < energies.size(); ++i)
    if (columns[i].kept && !columns[i].suspect()) least = std::min(least, energies[i]);
  for (Eigen::Index i = 0; i < energies.size(); ++i) {
    if (!columns[i].suspect() || !(energies[i] < of_least * least)) continue;
    columns[i].kept = false;
    origins[static_cast<std::size_t>(i)].dropped = "its new part is a rigid motion";
  }
}

/// Drops columns that are round-off, by their energies. Collective.
void drop_round_off(const fem::Structure& structure, const fem::FieldRows& X, std::vector<Column>& columns,
                    std::vector<ColumnOrigin>& origins) {
  const std::vector<std::pair<Eigen::Index, double>> massless = drilling(structure, X, columns);
  if (massless.empty() &&
      std::none_of(columns.begin(), columns.end(), [](const Column& column) { return column.suspect(); }))
    return;
  Eigen::VectorXd energies = fem::ElementStiffness(structure).gram(X).diagonal();
  MPI_Bcast(energies.data(), static_cast<int>(energies.size()), MPI_DOUBLE, 0, structure.mesh.comm);  // to the last bit
  for (const auto& [i, of_shells] : massless) {  // where the shells have less than half of it, others are as stiff
    if (of_shells < 0.5 * energies[i]) continue;
    columns[i] = {.share = 0, .kept = false};
    origins[static_cast<std::size_t>(i)].dropped = "massless but for round-off (drilling rotations)";
  }
  drop_rigid(energies, columns, origins);
}

/// How many columns can be independent: dofs with mass in which some column moves, and no more than those with mass
/// without the conditions of the frame. Collective.
Eigen::Index most_independent(const fem::Structure& structure, const fem::FieldRows& X) {
  const petsc::VecHandle masses = fem::field(structure);
  check(MatGetDiagonal(fem::mass(structure, {}), masses));
  petsc::Values mass(masses);
  std::array<PetscInt, 2> counts{};  // with mass; of these, those in which columns move
  for (PetscInt i = 0; i < structure.owned_dofs(); ++i) {
    if (!(mass.begin()[i] > 0)) continue;
    ++counts[0];
    counts[1] += !X.row(i).isZero(0);
  }
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), 2, MPIU_INT, MPI_SUM, structure.mesh.comm);
  return std::min(counts[0] - structure.rigid_motion_count(), counts[1]);
}

/// Of more columns than dofs those with the smallest new parts are dropped: next to nothing is new in them but
/// round-off of the others.
void drop_surplus(Eigen::Index limit, std::vector<Column>& columns, std::vector<ColumnOrigin>& origins) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].kept) kept.push_back(i);
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return columns[a].share > columns[b].share; });
  for (auto i = static_cast<std::size_t>(limit); i < kept.size(); ++i) {
    columns[kept[i]].kept = false;
    origins[kept[i]].dropped = fmt::format("the body has only {} elastic dofs", limit);
  }
}

/// The columns that are kept, with M as inner product.
void insert(const fem::Structure& structure, const fem::FieldRows& X, const std::vector<Column>& columns,
            Basis& basis) {
  const petsc::VecHandle like = fem::field(structure);
  for (const Column& column : columns) basis.columns += column.kept;
  check(BVCreate(structure.mesh.comm, basis.V.out()));
  check(BVSetSizesFromVec(basis.V, like, std::max(1, basis.columns)));
  check(BVSetFromOptions(basis.V));
  check(BVSetMatrix(basis.V, fem::mass(structure, {}), PETSC_FALSE));
  PetscInt next = 0;
  fem::for_each_field(structure, X, [&](Eigen::Index j, const double* local) {
    if (!columns[j].kept) return;
    Vec into = nullptr;
    check(BVGetColumn(basis.V, next, &into));
    std::copy(local, local + structure.owned_dofs(), petsc::Values(into).begin());
    check(BVRestoreColumn(basis.V, next++, &into));
  });
  check(BVSetActiveColumns(basis.V, 0, basis.columns));
}

}  // namespace

Basis orthonormal_basis(const fem::Structure& structure, const Columns& candidates, std::vector<ColumnOrigin> origins,
                        double tolerance) {
  return orthonormal_basis(structure, fem::gather(structure, candidates), std::move(origins), tolerance);
}

Basis orthonormal_basis(const fem::Structure& structure, fem::FieldRows candidates, std::vector<ColumnOrigin> origins,
                        double tolerance) {
  const petsc::Stage stage("basis");
  Basis basis;
  basis.origins = std::move(origins);
  std::vector<Column> columns = orthonormalise(structure, tolerance, candidates, basis.norms);
  drop_round_off(structure, candidates, columns, basis.origins);
  drop_surplus(most_independent(structure, candidates), columns, basis.origins);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    basis.origins[i].new_part = columns[i].share;
    basis.origins[i].kept = columns[i].kept;
  }
  insert(structure, candidates, columns, basis);
  return basis;
}

}  // namespace floe::reduction
