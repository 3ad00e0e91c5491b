#include "floe/reduction/reduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "floe/fem/field_rows.h"
#include "floe/petsc/values.h"
#include "static_columns.h"

namespace floe::reduction {

using petsc::check;

double mass_norm(Mat M, Vec field) {
  petsc::VecHandle product;
  check(VecDuplicate(field, product.out()));
  check(MatMult(M, field, product));
  double square = 0;
  check(VecDot(field, product, &square));
  return std::sqrt(std::max(0.0, square));
}

Generators generators(const fem::Structure& structure, const fem::ReferenceFrame& frame, const fem::Holding& holding,
                      const Statics& statics, int modes, const std::vector<Attachment>& attachments, double tolerance) {
  return generators(structure, statics, vibration_modes(structure, frame, holding, statics, modes), attachments,
                    tolerance);
}

Generators generators(const fem::Structure& structure, const Statics& statics, Modes modes,
                      const std::vector<Attachment>& attachments, double tolerance) {
  Generators result;
  result.modes = std::move(modes);
  Columns candidates;
  std::vector<ColumnOrigin> origins;
  for (std::size_t i = 0; i < result.modes.omega.size(); ++i) {
    candidates.push_back(copy(result.modes.shapes[i]));
    origins.push_back({ColumnOrigin::Kind::mode, fmt::format("mode {}", i + 1), result.modes.omega[i]});
  }
  StaticColumns statically = static_columns(structure, statics, attachments);
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (!statically.origins[i].kept) {
      result.dropped.push_back(statically.origins[i]);
      continue;
    }
    fix_sign(structure, statically.columns[i]);
    candidates.push_back(std::move(statically.columns[i]));
    origins.push_back(statically.origins[i]);
  }
  const Basis independent = orthonormal_basis(structure, candidates, std::move(origins), tolerance);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!independent.origins[i].kept) {
      result.dropped.push_back(independent.origins[i]);
      continue;
    }
    check(VecScale(candidates[i], 1 / independent.norms[static_cast<Eigen::Index>(i)]));
    result.fields.push_back(std::move(candidates[i]));
    result.origins.push_back(independent.origins[i]);
  }
  return result;
}

namespace {

/// Mean square displacement of the nodes. Collective.
Eigen::VectorXd mean_squares(const fem::Structure& structure, const fem::FieldRows& fields) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(fields.cols());
  for (PetscInt node = 0; node < structure.mesh.owned_nodes; ++node)
    sums +=
        fields.middleRows(structure.dofs_per_node * node, structure.dimension()).colwise().squaredNorm().transpose();
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return sums / static_cast<double>(structure.mesh.node_count);
}

/// Whether each field rotates the body's line or surface anywhere, by root mean squares. Fields that do not (axial
/// modes of a straight body) have no derivatives among themselves; what a solver leaves there is round-off. Collective.
std::vector<bool> with_slope(const fem::Structure& structure, const Columns& fields) {
  const fem::FieldRows rows = fem::gather(structure, fields);
  const fem::Slopes slopes = fem::slopes(structure, rows);
  const Eigen::VectorXd squares = slopes.squares();
  const Eigen::VectorXd displacements = mean_squares(structure, rows);
  const double length = fem::extent(structure);
  std::vector<bool> sloped;
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    sloped.push_back(squares[j] * length * length > 1e-18 * displacements[j] * slopes.measure);
  return sloped;
}

/// sqrt(phi'K phi) of each field: omega of modes. Collective.
std::vector<double> energy_norms(const Statics& statics, const Generators& generators) {
  std::vector<double> norms = generators.modes.omega;
  for (std::size_t i = norms.size(); i < generators.fields.size(); ++i)
    norms.push_back(std::sqrt(2 * statics.elements()->strain_energy(generators.fields[i])));
  return norms;
}

/// What is nothing beside the others becomes zero, by the displacements of the nodes and their rotations, which count
/// by the extent of the body (a derivative of bending in two planes twists a straight line and does not displace it):
/// of modes without a derivative in common a solver leaves round-off. Collective.
/// @param scales  of the fields that each column is a derivative of: with fields of the same strain energy the
///                stretching ones are as many times smaller as they are stiffer
void drop_round_off(const fem::Structure& structure, const std::vector<double>& scales, Columns& columns) {
  const int per_node = structure.dofs_per_node, d = structure.dimension();
  const double length = fem::extent(structure);
  std::vector<double> squares;
  for (const auto& column : columns) {
    petsc::Values values(column);
    const Eigen::Map<const Eigen::MatrixXd> nodes(values.begin(), per_node, structure.mesh.owned_nodes);
    const double scale = scales[squares.size()];
    const double square =
        nodes.topRows(d).squaredNorm() + length * length * nodes.bottomRows(per_node - d).squaredNorm();
    squares.push_back(square / (scale > 0 ? scale * scale : 1));
  }
  MPI_Allreduce(MPI_IN_PLACE, squares.data(), static_cast<int>(squares.size()), MPI_DOUBLE, MPI_SUM,
                structure.mesh.comm);
  const double greatest = squares.empty() ? 0 : *std::max_element(squares.begin(), squares.end());
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (squares[i] <= 1e-20 * greatest) check(VecSet(columns[i], 0));
}

/// Q of QR of fields that are alike: those of the singular vectors of more than 1e-6 of the greatest. Collective.
Columns independent(const Columns& fields) {
  const auto n = static_cast<Eigen::Index>(fields.size());
  const std::vector<Vec> all(fields.begin(), fields.end());
  Eigen::MatrixXd gram(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    check(VecMDot(all[static_cast<std::size_t>(i)], static_cast<PetscInt>(n), all.data(), gram.col(i).data()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> main(gram);
  Columns found;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double square = main.eigenvalues()[i];
    if (!(square > 1e-12 * main.eigenvalues()[n - 1])) continue;
    found.push_back(copy(fields.front()));
    check(VecSet(found.back(), 0));
    const Eigen::VectorXd factors = main.eigenvectors().col(i) / std::sqrt(square);
    check(VecMAXPY(found.back(), static_cast<PetscInt>(n), factors.data(), const_cast<Vec*>(all.data())));
  }
  return found;
}

/// Norms of the displacements and of the rotations of the nodes. Collective.
std::array<double, 2> norms_of(const fem::Structure& structure, Vec field) {
  petsc::Values values(field);
  const Eigen::Map<const Eigen::MatrixXd> nodes(values.begin(), structure.dofs_per_node, structure.mesh.owned_nodes);
  std::array<double, 2> squares{nodes.topRows<3>().squaredNorm(), nodes.bottomRows<3>().squaredNorm()};
  MPI_Allreduce(MPI_IN_PLACE, squares.data(), 2, MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return {std::sqrt(squares[0]), std::sqrt(squares[1])};
}

/// Whether there are no more nodes than basis vectors, and shells among the elements. Collective.
bool few_shells(const fem::Structure& structure, std::size_t columns) {
  if (structure.dofs_per_node != 6 || static_cast<PetscInt>(columns) < structure.mesh.node_count) return false;
  const auto& cells = structure.mesh.cells;
  int shells = std::any_of(cells.begin(), cells.end(), [](const auto& cell) { return mesh::is_shell(cell.kind); });
  MPI_Allreduce(MPI_IN_PLACE, &shells, 1, MPI_INT, MPI_MAX, structure.mesh.comm);
  return shells != 0;
}

}  // namespace

void keep_without_mass(const fem::Structure& structure, const std::vector<Vec>& columns, Basis& basis) {
  constexpr double of_mass = 1e-6, of_displacements = 1e-4;  // less of the rotations is round-off
  if (!few_shells(structure, columns.size())) return;
  const double length = fem::extent(structure);
  Columns all;
  Eigen::VectorXd q(basis.columns);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnOrigin& origin = basis.origins[i];
    if (origin.kind != ColumnOrigin::Kind::derivative || origin.kept || origin.new_part > of_mass) continue;
    petsc::VecHandle left = copy(columns[i]);
    check(BVDotVec(basis.V, left, q.data()));
    check(BVMultVec(basis.V, -1, 1, left, q.data()));
    const double rotations = norms_of(structure, left)[1];
    if (!(length * rotations > of_displacements * norms_of(structure, columns[i])[0])) continue;
    check(VecScale(left, 1 / rotations));
    all.push_back(std::move(left));
  }
  if (!all.empty()) basis.without_mass = independent(all);
}

std::string derivative_label(const Generators& generators, int i, int j) {
  const auto name = [&](int field) {
    const ColumnOrigin& origin = generators.origins[field];
    return origin.label.substr(
        std::string_view(origin.kind == ColumnOrigin::Kind::mode ? "mode " : "attachment ").size());
  };
  return fmt::format("derivative {},{}", name(i), name(j));
}

DerivativeColumns derivative_columns(const fem::Structure& structure, const fem::ReferenceFrame& frame,
                                     const fem::Holding& holding, const Statics& statics, const Generators& generators,
                                     const Pairs& pairs, bool full) {
  DerivativeColumns result;
  Pairs with_inertia, without;
  const int modes = static_cast<int>(generators.modes.omega.size());
  for (const auto& pair : pairs) (full && pair[0] < modes && pair[1] < modes ? with_inertia : without).push_back(pair);
  Pairs which;
  if (!with_inertia.empty()) {
    result.columns = full_derivatives(structure, frame, holding, statics, generators.modes, with_inertia, which);
  }
  Columns more = static_derivatives(structure, statics, generators.fields, without);
  for (auto& column : more) result.columns.push_back(std::move(column));
  which.insert(which.end(), without.begin(), without.end());
  const std::vector<bool> sloped = with_slope(structure, generators.fields);
  const std::vector<double> norms = energy_norms(statics, generators);
  std::vector<double> scales;
  for (std::size_t p = 0; p < which.size(); ++p) {
    const auto [i, j] = which[p];
    if (!sloped[i] && !sloped[j]) check(VecSet(result.columns[p], 0));
    scales.push_back(norms[i] * norms[j]);
    result.origins.push_back({ColumnOrigin::Kind::derivative, derivative_label(generators, i, j)});
  }
  drop_round_off(structure, scales, result.columns);
  return result;
}

Basis basis_of(const fem::Structure& structure, const Generators& generators, DerivativeColumns derivatives,
               double tolerance, const std::vector<char>& left_out) {
  std::vector<Vec> taken;
  std::vector<ColumnOrigin> origins;
  for (std::size_t i = 0; i < generators.fields.size(); ++i) {
    if (!left_out.empty() && left_out[i]) continue;
    taken.push_back(generators.fields[i]);
    origins.push_back(generators.origins[i]);
  }
  const std::size_t first = taken.size();
  fem::FieldRows candidates = fem::gather(
      structure, static_cast<Eigen::Index>(first + derivatives.columns.size()), [&](Eigen::Index j, double* local) {
        const auto at = static_cast<std::size_t>(j);
        structure.exchange.gather(at < first ? taken[at] : derivatives.columns[at - first].get(), local);
      });
  if (!few_shells(structure, first + derivatives.columns.size())) derivatives.columns.clear();  // their memory
  origins.insert(origins.end(), derivatives.origins.begin(), derivatives.origins.end());
  Basis basis = orthonormal_basis(structure, std::move(candidates), std::move(origins), tolerance);
  taken.insert(taken.end(), derivatives.columns.begin(), derivatives.columns.end());
  keep_without_mass(structure, taken, basis);
  if (left_out.empty())
    for (const auto& origin : generators.dropped) basis.origins.push_back(origin);
  return basis;
}

}  // namespace floe::reduction
