#include "shell_stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "floe/dynamics/local_indices.h"
#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "floe/petsc/all_ranks.h"
#include "floe/petsc/error.h"

namespace floe::assembly {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d ShellPoint::value(double t, const VectorXd& q) const {
  Vector3d sum = Vector3d::Zero();
  VectorXd own, deformation;
  for (const Share& share : shares) {
    dynamics::pick(share.coordinates, q, own);
    if (share.element) {
      const VectorXd none = VectorXd::Zero(own.size());
      deformation = share.element->deformation({t, own, none, none});
    }
    const VectorXd& d = share.element ? deformation : own;
    sum += share.L * d;
    for (int r = 0; r < 3; ++r) sum[r] += 0.5 * d.dot(share.Q[static_cast<std::size_t>(r)] * d);
  }
  return sum;
}

namespace {

/// This rank's shells with one of the nodes.
std::vector<int> shells_at(const fem::Mesh& mesh, const std::set<PetscInt>& nodes) {
  std::vector<int> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& cell = mesh.cells[c];
    if (!mesh::is_shell(cell.kind)) continue;
    const auto places = cell.places();
    if (std::any_of(places.begin(), places.end(), [&](int node) { return nodes.contains(mesh.global_node(node)); }))
      cells.push_back(static_cast<int>(c));
  }
  return cells;
}

/// A sample as all ranks know it.
struct Seen {
  int rank, cell, number, part, first_ring;
  PetscInt order;  ///< of elements, the same on any number of ranks
  double at[3], axes[9], spread[9], share;
  Vector3d position() const { return Eigen::Map<const Vector3d>(at); }
  Matrix3d moments() const { return Eigen::Map<const Matrix3d>(spread); }
  Matrix3d directions() const { return Eigen::Map<const Matrix3d>(axes); }
};

/// Of the elements to the given ring around the node. Collective.
std::vector<Seen> samples_around(const fem::Structure& structure, PetscInt node, int rings) {
  const fem::Mesh& mesh = structure.mesh;
  int rank = 0;
  MPI_Comm_rank(mesh.comm, &rank);
  const std::vector<int> first = shells_at(mesh, {node});
  std::vector<int> cells = first;
  for (int ring = 1; ring < rings; ++ring) {
    std::vector<PetscInt> near;
    for (const int c : cells)
      for (const int place : mesh.cells[c].places()) near.push_back(mesh.global_node(place));
    const std::vector<PetscInt> all = petsc::of_all_ranks(mesh.comm, near);
    cells = shells_at(mesh, {all.begin(), all.end()});
  }
  std::vector<Seen> mine;
  for (const int c : cells) {
    const auto& cell = mesh.cells[c];
    PetscInt order = 0;
    for (const int place : cell.places()) order = std::max(order, mesh.original_node(place));
    const bool in_first = std::find(first.begin(), first.end(), c) != first.end();
    const std::vector<fem::ShellSample> samples = fem::shell_samples(structure, cell);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      Seen seen{rank, c, static_cast<int>(i), cell.part, in_first, order, {}, {}, {}, samples[i].share};
      Eigen::Map<Vector3d>(seen.at) = samples[i].at;
      Eigen::Map<Matrix3d>(seen.axes) = samples[i].axes;
      Eigen::Map<Matrix3d>(seen.spread) = samples[i].spread;
      mine.push_back(seen);
    }
  }
  return petsc::of_all_ranks(mesh.comm, mine);
}

/// Points in two axes from the node, and the second moments (xx, yy, xy) of what the samples are the means of.
struct Cloud {
  Eigen::Matrix2Xd x;
  Eigen::Matrix3Xd moments;
  VectorXd shares;
};

/// The first row of the pseudo-inverse; empty where the samples do not determine the coefficients.
VectorXd fit(const MatrixXd& B, const VectorXd& shares) {
  const VectorXd root = shares.cwiseSqrt();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(root.asDiagonal() * B);
  qr.setThreshold(1e-3);
  if (qr.rank() < B.cols() || shares.sum() < 1.4 * static_cast<double>(B.cols())) return {};
  return qr.solve(MatrixXd(root.asDiagonal())).row(0);
}

/// Weights w with f(0) = sum w mean(f) of polynomials of second degree; empty where the samples do not determine them.
VectorXd quadratic_weights(const Cloud& cloud) {
  const double size = cloud.x.colwise().norm().maxCoeff();
  const Eigen::Matrix2Xd x = cloud.x / size;
  const Eigen::Matrix3Xd s = cloud.moments / (size * size);
  MatrixXd B(x.cols(), 6);
  B << VectorXd::Ones(x.cols()), x.transpose(), x.row(0).cwiseAbs2().transpose() + s.row(0).transpose(),
      x.row(1).cwiseAbs2().transpose() + s.row(1).transpose(),
      x.row(0).cwiseProduct(x.row(1)).transpose() + s.row(2).transpose();
  return fit(B, cloud.shares);
}

/// Where there are fewer: of linear ones, of second or first degree along the line on which the samples are, the mean.
VectorXd simpler_weights(const Cloud& cloud) {
  const double size = cloud.x.colwise().norm().maxCoeff();
  const Eigen::Matrix2Xd x = cloud.x / size;
  const auto n = x.cols();
  MatrixXd B(n, 3);
  B << VectorXd::Ones(n), x.transpose();
  if (VectorXd w = fit(B, cloud.shares); w.size() > 0) return w;
  const Eigen::Matrix2Xd centred = x.colwise() - x.rowwise().mean().eval();
  const Eigen::Matrix2d second = centred * centred.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(second);
  const VectorXd along = x.transpose() * spread.eigenvectors().col(1);
  B << VectorXd::Ones(n), along, along.cwiseAbs2();
  for (const Eigen::Index columns : {3, 2, 1})
    if (VectorXd w = fit(B.leftCols(columns), cloud.shares); w.size() > 0) return w;
  return cloud.shares / cloud.shares.sum();
}

/// Stress-like components in axes rotated by `angle` about the normal.
Matrix3d rotated(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Matrix3d T;
  T << c * c, s * s, 2 * c * s, s * s, c * c, -2 * c * s, -c * s, c * s, c * c - s * s;
  return T;
}

/// Strains with gamma_xy = 2 eps_xy likewise: sigma' eps is the same in all axes.
Matrix3d rotated_strain(double angle) { return rotated(-angle).transpose(); }

/// The layers that a probe of stresses or strains is of: the one that it names, or all.
std::vector<fem::ShellLayer> layers_of(const Probe& probe, const fem::StressPoints& points) {
  const auto refuse = [&](const char* key, const std::string& what) {
    throw InputError(fmt::format("{}.{}: {}", probe.where.text(), key, what));
  };
  const std::vector<fem::ShellLayer>& all = points.layers;
  if (all.empty())
    refuse("quantity",
           "the section there is given by its stiffness, without layers; expected membrane_force or "
           "bending_moment");
  if (probe.layer > static_cast<int>(all.size()))
    refuse("layer", fmt::format("is {}, but the section there has {} layer{}; expected 1 to {}", probe.layer,
                                all.size(), all.size() > 1 ? "s" : "", all.size()));
  if (probe.layer > 0) return {all[static_cast<std::size_t>(probe.layer - 1)]};
  for (const fem::ShellLayer& one : all)
    if (probe.quantity != Probe::Quantity::strain && (one.Q - all.front().Q).norm() > 1e-9 * one.Q.norm())
      refuse("quantity",
             "the section there is a laminate, whose stresses jump between layers; expected layer: N (from "
             "1 at the bottom), or membrane_force or bending_moment");
  return all;
}

/// (3 x 6) of the quantity from (e, kappa) in the section's axes.
Eigen::Matrix<double, 3, 6> quantity_of(const Probe& probe, const fem::ShellSection& section,
                                        const fem::StressPoints& points) {
  Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
  if (probe.quantity == Probe::Quantity::membrane_force) {
    H.leftCols<3>() = section.A;
    return H;
  }
  if (probe.quantity == Probe::Quantity::bending_moment) {
    H << section.coupling.transpose() * section.A, section.bending;
    return H;
  }
  const std::vector<fem::ShellLayer> layers = layers_of(probe, points);
  const double bottom = layers.front().bottom, top = layers.back().top;
  const double z = probe.surface == Probe::Surface::top      ? top
                   : probe.surface == Probe::Surface::bottom ? bottom
                                                             : (bottom + top) / 2;
  H << Matrix3d::Identity(), z * Matrix3d::Identity() - section.coupling;  // eps = e - C kappa
  if (probe.quantity != Probe::Quantity::strain) H = layers.front().Q * H;
  return H;
}

/// The first of two axes on the surface.
Vector3d first_axis(const PlannedBody& body, const Probe& probe, const fem::ShellSection& section,
                    const Vector3d& normal) {
  const Matrix3d of_mesh = body.axes.transpose();
  std::vector<Vector3d> wanted;
  if (probe.axis)
    wanted.push_back(of_mesh * Vector3d::Map(probe.axis->data()).normalized());
  else if (!section.axis.isZero(0))
    wanted.push_back(section.axis.normalized());
  else
    wanted = {of_mesh.col(0), of_mesh.col(1)};
  for (const Vector3d& axis : wanted)
    if (const Vector3d x = axis - normal.dot(axis) * normal; x.norm() > 0.1) return x.normalized();
  throw InputError(fmt::format("{}.axis: is normal to the shell; expected another direction", probe.where.text()));
}

const Seen& reference_of(const std::vector<Seen>& samples, const Probe& probe, const Anchor& place,
                         const Anchor& toward) {
  const Seen* best = nullptr;
  double most = 0;
  for (const Seen& one : samples) {
    if (!one.first_ring) continue;
    const double along = probe.toward ? (one.position() - place.x).normalized().dot(toward.x - place.x) : 0;
    if (best && (along < most - 1e-9 || (along <= most + 1e-9 && one.order >= best->order))) continue;
    best = &one, most = along;
  }
  return *best;
}

}  // namespace

std::vector<PatchSample> patch_samples(const Plan& plan, std::size_t p) {
  const Probe& probe = plan.scene.probes[p];
  const auto& [place, toward] = plan.probes[p];
  const PlannedBody& body = plan.bodies[place.body];
  const fem::Structure& structure = body.structure;
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}.at: {}", probe.where.text(), what));
  };
  if (place.nodes.size() != 1)
    refuse(fmt::format("is a place of {} nodes of body {}; expected one node of a shell", place.nodes.size(),
                       body.spec.name));
  std::vector<Seen> samples = samples_around(structure, place.nodes.front(), 1);
  if (samples.empty()) refuse(fmt::format("no shell of body {} has a node there", body.spec.name));
  const Seen reference = reference_of(samples, probe, place, toward);
  const Vector3d about = reference.directions().col(2);
  const auto smooth = [&](const Seen& one) {
    return one.part == reference.part && one.directions().col(2).dot(about) > 0.8;
  };
  if (!probe.toward && !std::all_of(samples.begin(), samples.end(), smooth))
    refuse(
        fmt::format("parts or planes of body {} meet there; expected toward: a place on one of them", body.spec.name));
  std::erase_if(samples, [&](const Seen& one) { return !smooth(one); });
  Vector3d normal = Vector3d::Zero();
  for (const Seen& one : samples) normal += one.share * one.directions().col(2);
  normal.normalize();
  const auto& section = std::get<fem::ShellSection>(structure.sections[reference.part]);
  const Vector3d x = first_axis(body, probe, section, normal), y = normal.cross(x);
  VectorXd weights;
  for (const int rings : {2, 3}) {  // on edges two rings are too few
    samples = samples_around(structure, place.nodes.front(), rings);
    std::erase_if(samples, [&](const Seen& one) { return !smooth(one); });
    const auto count = static_cast<Eigen::Index>(samples.size());
    Cloud cloud{Eigen::Matrix2Xd(2, count), Eigen::Matrix3Xd(3, count), VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const Seen& one = samples[static_cast<std::size_t>(i)];
      const Vector3d arm = one.position() - place.x;
      const Matrix3d S = one.moments();
      cloud.x.col(i) << x.dot(arm), y.dot(arm);
      cloud.moments.col(i) << x.dot(S * x), y.dot(S * y), x.dot(S * y);
      cloud.shares[i] = one.share;
    }
    weights = quadratic_weights(cloud);
    if (weights.size() == 0 && rings == 3) weights = simpler_weights(cloud);
    if (weights.size() > 0) break;
  }
  const Eigen::Matrix<double, 3, 6> H = quantity_of(probe, section, body.points[reference.part]);
  int rank = 0;
  MPI_Comm_rank(structure.mesh.comm, &rank);
  std::vector<PatchSample> patch;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Seen& one = samples[i];
    if (one.rank != rank) continue;
    const Vector3d own = one.directions().col(0);
    const double angle = -std::atan2(y.dot(own), x.dot(own));  // from its axes to those of the node
    const Matrix3d T = probe.quantity == Probe::Quantity::strain ? rotated_strain(angle) : rotated(angle);
    patch.push_back({one.cell, static_cast<std::size_t>(one.number), weights[static_cast<Eigen::Index>(i)] * T * H});
  }
  return patch;
}

ShellPoint::Share share_of(const fem::ShellSample& sample, const PatchSample& in_patch, const MatrixXd& T) {
  std::vector<Eigen::Index> rows;
  for (const int corner : sample.corners)
    for (int d = 0; d < 6; ++d) rows.push_back(6 * corner + d);
  const MatrixXd own = T(rows, Eigen::all), G = sample.G * own;
  ShellPoint::Share share;
  share.L = in_patch.from * sample.L * own;
  for (std::size_t r = 0; r < 3; ++r) {
    MatrixXd P = MatrixXd::Zero(G.rows(), G.rows());
    for (std::size_t i = 0; i < 6; ++i)
      P += in_patch.from(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(i)) * sample.P[i];
    share.Q[r] = G.transpose() * P * G;
  }
  return share;
}

ShellPoint::Share reduced_share(const PlannedBody& body, const reduction::Basis& basis,
                                const std::vector<PatchSample>& patch, std::vector<int> coordinates) {
  const fem::Structure& structure = body.structure;
  const auto k = static_cast<Eigen::Index>(basis.columns);
  MatrixXd V(structure.local_dofs(), k);
  for (int j = 0; j < basis.columns; ++j) {
    Vec column = nullptr;
    petsc::check(BVGetColumn(basis.V, j, &column));
    structure.exchange.gather(column, V.col(j).data());
    petsc::check(BVRestoreColumn(basis.V, j, &column));
  }
  ShellPoint::Share sum{std::move(coordinates), MatrixXd::Zero(3, k), {}};
  for (MatrixXd& Q : sum.Q) Q = MatrixXd::Zero(k, k);
  for (const PatchSample& one : patch) {
    const fem::Mesh::Cell& cell = structure.mesh.cells[static_cast<std::size_t>(one.cell)];
    const fem::ShellSample sample = fem::shell_samples(structure, cell)[one.number];
    const MatrixXd of_nodes = V(structure.cell_dofs(cell), Eigen::all);
    const ShellPoint::Share share =
        share_of(sample, one, cell.follows() ? MatrixXd(fem::following(structure.mesh, cell) * of_nodes) : of_nodes);
    sum.L += share.L;
    for (std::size_t r = 0; r < 3; ++r) sum.Q[r] += share.Q[r];
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.L.data(), static_cast<int>(sum.L.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  for (MatrixXd& Q : sum.Q)
    MPI_Allreduce(MPI_IN_PLACE, Q.data(), static_cast<int>(Q.size()), MPI_DOUBLE, MPI_SUM, structure.mesh.comm);
  return sum;
}

}  // namespace floe::assembly
