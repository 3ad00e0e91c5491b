#include "whole_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "floe/error.h"
#include "floe/fem/assembly.h"
#include "floe/math/rotation.h"

namespace floe::assembly {

using dynamics::AccompanyingAxes;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using math::skew;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The direction of a node's dof in mesh axes, and whether it is a rotation.
struct Direction {
  Vector3d e;
  bool rotation;
  Direction(int dof, const Matrix3d& A0, int dofs_per_node)
      : e(dofs_per_node == 3 && dof == 2 ? A0.col(2) : A0.col(dof % 3)),
        rotation(dof >= (dofs_per_node == 3 ? 2 : 3)) {}
  /// What rigid motions (t, w length) do on the dof, rotations times the length.
  Vector6 on(const Vector3d& X, double length) const {
    Vector6 row;
    if (rotation)
      row << Vector3d::Zero(), e;
    else
      row << e, X.cross(e) / length;
    return row;
  }
};

/// Sum of the dofs' products of rigid motions. Collective.
Eigen::Matrix<double, 6, 6> products_of_dofs(const Plan& plan, const WholeAxes& whole,
                                             const std::vector<fem::Conditions>& constrained) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t i = 0; i < whole.bodies.size(); ++i) {
    const PlannedBody& body = plan.bodies[whole.bodies[i]];
    const fem::Structure& s = body.structure;
    const Matrix3d A0 = undeformed_axes(body);
    for (PetscInt dof : constrained[i]) {
      const PetscInt node = dof / s.dofs_per_node - s.mesh.first_node;
      if (node < 0 || node >= s.mesh.owned_nodes) continue;
      const Vector3d X = undeformed_origin(body) + A0 * s.mesh.positions[node];
      const Vector6 row = Direction(static_cast<int>(dof % s.dofs_per_node), A0, s.dofs_per_node).on(X, whole.length);
      sum += row * row.transpose();
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 36, MPI_DOUBLE, MPI_SUM, plan.comm);
  return sum;
}

/// Rigid motions that dofs see, and the rest.
std::pair<MatrixXd, MatrixXd> split(const Eigen::Matrix<double, 6, 6>& products, int dimension) {
  std::vector<int> motions = {0, 1, 2, 3, 4, 5};
  if (dimension == 2) motions = {0, 1, 5};
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(products(motions, motions)));
  const double least = 1e-10 + 1e-13 * eigen.eigenvalues().tail<1>()[0];  // round-off of places far from the origin
  const Index free = (eigen.eigenvalues().array() <= least).count(), all = static_cast<Index>(motions.size());
  MatrixXd vectors = MatrixXd::Zero(6, all);
  vectors(motions, Eigen::all) = eigen.eigenvectors();
  return {vectors.rightCols(all - free), vectors.leftCols(free)};
}

AccompanyingAxes::Row zero_row(std::size_t elastic) {
  return {Vector3d::Zero(), MatrixXd::Zero(9, 1 + static_cast<Index>(elastic))};
}

void set_part(AccompanyingAxes::Row& row, Index part, const Matrix3d& B) { row.B.col(part) = B.reshaped(); }

std::vector<AccompanyingAxes::Row> rows_of(const WholeAxes& whole, const CarriedMass& mass) {
  const body::Inertia& in = mass.inertia;
  const Index d = in.dimension(), k = in.coordinates();
  Vector3d s0 = Vector3d::Zero();
  Matrix3d C0 = Matrix3d::Zero();
  Matrix3Xd S = Matrix3Xd::Zero(3, k);
  s0.head(d) = in.s0, C0.topLeftCorner(d, d) = in.C0, S.topRows(d) = in.S;
  std::vector<AccompanyingAxes::Row> rows;
  for (Index j = 0; j < whole.free.cols(); ++j) {
    const Vector3d t = whole.free.col(j).head<3>(), w = whole.free.col(j).tail<3>() / whole.length;
    AccompanyingAxes::Row row = zero_row(mass.elastic.size());
    row.b = in.m * t + w.cross(in.m * mass.X + mass.A0 * s0);
    set_part(row, 0, t * s0.transpose() + skew(w) * (mass.X * s0.transpose() + mass.A0 * C0));
    for (Index e = 0; e < k; ++e) {
      Matrix3d h = Matrix3d::Zero();
      for (Index a = 0; a < d; ++a)
        for (Index b = 0; b < d; ++b) h(a, b) = in.h[a][b][e];
      set_part(row, 1 + e, t * S.col(e).transpose() + skew(w) * (mass.X * S.col(e).transpose() + mass.A0 * h));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<AccompanyingAxes::Row> rows_of(const WholeAxes& whole, const ConstrainedPlace& place, int dofs_per_node) {
  std::vector<AccompanyingAxes::Row> rows;
  for (Index j = 0; j < whole.seen.cols(); ++j) {
    AccompanyingAxes::Row sum = zero_row(place.elastic.size());
    for (int dof : place.dofs) {
      const Direction direction(dof, place.A0, dofs_per_node);
      AccompanyingAxes::Row row = zero_row(place.elastic.size());
      const Matrix3d W = 0.5 * whole.length * skew(direction.e) * place.A0;
      if (!direction.rotation) row.b = direction.e;
      set_part(row, 0, direction.rotation ? W : Matrix3d(direction.e * place.x.transpose()));
      for (Index e = 0; e < static_cast<Index>(place.elastic.size()); ++e)
        set_part(row, 1 + e,
                 direction.rotation ? Matrix3d(-W * skew(place.psi.col(e)))
                                    : Matrix3d(direction.e * place.S.col(e).transpose()));
      sum += row * direction.on(place.X + place.A0 * place.x, whole.length).dot(whole.seen.col(j));
    }
    rows.push_back(std::move(sum));
  }
  return rows;
}

}  // namespace

Matrix3d undeformed_axes(const PlannedBody& body) {
  if (body.structure.dimension() == 3) return body.axes;
  return Eigen::AngleAxisd(body.frame_angle, Vector3d::UnitZ()).toRotationMatrix();
}

Vector3d undeformed_origin(const PlannedBody& body) {
  if (body.structure.dimension() == 3) return body.origin;
  return {body.frame_origin.x(), body.frame_origin.y(), 0};
}

std::optional<dynamics::MovingAxes> WholeAxes::axes() const {
  return fixed ? std::nullopt : std::optional<dynamics::MovingAxes>(f);
}

void WholeAxes::split(const Plan& plan, const std::vector<fem::Conditions>& dofs) {
  std::tie(seen, free) = floe::assembly::split(products_of_dofs(plan, *this, dofs), plan.scene.dimension);
}

bool WholeAxes::has(int body) const { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); }

int WholeAxes::place_in(int body) const {
  return static_cast<int>(std::find(bodies.begin(), bodies.end(), body) - bodies.begin());
}

WholeAxes frame_axes(const Plan& plan, int b) {
  const PlannedBody& body = plan.bodies[b];
  WholeAxes axes;
  axes.bodies = {b};
  axes.length = fem::extent(body.structure);
  axes.constrained = {body.frame.conditions};
  axes.split(plan, axes.constrained);
  return axes;
}

bool needs_frame_axes(const Plan& plan, int b, const std::function<bool(std::size_t)>& by_places) {
  for (std::size_t l = 0; l < plan.loads.size(); ++l)
    if (const Load& load = plan.scene.loads[l];
        plan.loads[l].body == b && load.axes == Load::Axes::body && load.kind != Load::Kind::pressure)
      return true;
  for (std::size_t p = 0; p < plan.probes.size(); ++p)
    if (plan.scene.probes[p].quantity == Probe::Quantity::deflection && plan.probes[p][0].body == b && !by_places(p))
      return true;
  return false;
}

StartOfAxes mesh_axes_at_start(const PlannedBody& body) {
  Vector3d R = body.place;
  Matrix3d A = body.attitude;
  if (body.structure.dimension() == 2) {
    R << body.pose.head<2>(), 0;
    A = Eigen::AngleAxisd(body.pose[2], Vector3d::UnitZ()).toRotationMatrix();
  }
  A *= undeformed_axes(body).transpose();
  return {R - A * undeformed_origin(body), A};
}

AxesTerms conditions(const WholeAxes& whole, int dofs_per_node,
                     const std::function<std::vector<CarriedMass>(int)>& masses,
                     const std::function<std::vector<ConstrainedPlace>(int)>& places) {
  AxesTerms terms;
  const auto add = [&](const auto& part, int first, std::vector<AccompanyingAxes::Row> rows) {
    terms.push_back(std::make_unique<AccompanyingAxes>(part.axes, part.elastic, whole.f, first, std::move(rows)));
    terms.back()->begin_at(part.X, part.A0);
  };
  for (int b : whole.bodies) {
    for (const CarriedMass& mass : masses(b))
      if (whole.free.cols() > 0 && !whole.fixed)
        add(mass, whole.multipliers + static_cast<int>(whole.seen.cols()), rows_of(whole, mass));
    if (whole.fixed || whole.seen.cols() == 0) continue;
    for (const ConstrainedPlace& place : places(b))
      if (!place.dofs.empty()) add(place, whole.multipliers, rows_of(whole, place, dofs_per_node));
  }
  return terms;
}

JointMultipliers unknowns_of(const WholeAxes& whole) {
  std::vector<int> rows(2 * whole.f.coordinates().size());
  std::iota(rows.begin(), rows.end(), 0);
  return {whole.f.position, std::move(rows)};
}

namespace {

/// Rows of all terms together at a level, and their derivatives by f or its velocities. Collective.
std::pair<VectorXd, MatrixXd> rows_at(const WholeAxes& whole, const AxesTerms& terms, const VectorXd& q,
                                      const VectorXd& v, dynamics::ConstraintLevel level, MPI_Comm comm) {
  const std::vector<int> own = whole.f.coordinates();
  const Index n = static_cast<Index>(own.size());
  VectorXd open = VectorXd::Zero(n);
  MatrixXd J = MatrixXd::Zero(n, n);
  for (const auto& term : terms) {
    const std::vector<int>& at = term->coordinates();
    const VectorXd q_at = q(at), v_at = v(at), a_at = VectorXd::Zero(q_at.size());
    const Index all = q_at.size(), rows = term->rows(), first = at[all - rows] - whole.multipliers;
    VectorXd r = VectorXd::Zero(all);
    MatrixXd K = MatrixXd::Zero(all, all);
    const dynamics::Motion motion{0, q_at, v_at, a_at, level};
    term->residual(motion, r);
    term->tangent(motion, {0, 0, 0}, K);
    open.segment(first, rows) += r.tail(rows);
    for (Index i = 0; i < n; ++i) {
      const Index column = std::find(at.begin(), at.end(), own[i]) - at.begin();
      J.col(i).segment(first, rows) += K.col(column).tail(rows);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, open.data(), static_cast<int>(n), MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, J.data(), static_cast<int>(n * n), MPI_DOUBLE, MPI_SUM, comm);
  return {std::move(open), std::move(J)};
}

}  // namespace

void begin_at(const AxesTerms& terms, const VectorXd& q) {
  for (const auto& term : terms) term->begin_at(q(term->coordinates()));
}

VectorXd rates_of(const WholeAxes& whole, const AxesTerms& terms, const VectorXd& q, const VectorXd& v, MPI_Comm comm) {
  const auto [open, J] = rows_at(whole, terms, q, v, dynamics::ConstraintLevel::velocity, comm);
  return -J.fullPivLu().solve(open);
}

void place_axes(const WholeAxes& whole, const AxesTerms& terms, const std::string& name, dynamics::Attitude* attitude,
                VectorXd& q, MPI_Comm comm) {
  constexpr int most = 20;
  constexpr double limit = 1e-9;  // far above round-off
  const std::vector<int> own = whole.f.coordinates();
  const VectorXd still = VectorXd::Zero(q.size());
  double left = 0;
  for (int iteration = 0; iteration < most; ++iteration) {
    const auto [open, J] = rows_at(whole, terms, q, still, dynamics::ConstraintLevel::position, comm);
    VectorXd change = -J.fullPivLu().solve(open);
    if (attitude) {
      attitude->base = (attitude->base * math::quaternion(Vector3d(change.tail<3>()))).normalized();
      change.tail<3>().setZero();
    }
    q(own) += change;
    if (open.norm() <= 1e-13 * J.norm()) return;
    left = open.norm() / J.norm();
  }
  if (!(left <= limit * (1 + q(own).norm())))
    throw RunError(
        fmt::format("the axes of {} were not found within {} iterations (residual {:.2g}, limit {:.2g}): its initial "
                    "deformation rotates its parts too far relative to each other; take a smaller one",
                    name, most, left, limit * (1 + q(own).norm())));
}

}  // namespace floe::assembly
