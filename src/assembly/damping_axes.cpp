#include "damping_axes.h"

#include <algorithm>
#include <numeric>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/damping.h"
#include "floe/dynamics/damping.h"
#include "floe/fem/assembly.h"
#include "floe/math/rotation.h"
#include "floe/petsc/values.h"
#include "floe/scene/joint_events.h"

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

/// Joints to the ground that are not driven or switched, alone.
bool firmly_grounded(const Plan& plan, const DampedWhole& whole) {
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const auto& [first, second] = plan.joints[j];
    if (first.ground() == second.ground() || !whole.has(first.ground() ? second.body : first.body)) continue;
    const Joint& joint = plan.scene.joints[j];
    if (joint.kind == Joint::Kind::driven || joint.kind == Joint::Kind::driven_slide) return false;
    if (is_switched(plan.scene, joint.name)) return false;
  }
  return true;
}

/// Sum of the dofs' products of rigid motions. Collective.
Eigen::Matrix<double, 6, 6> products_of_dofs(const Plan& plan, const DampedWhole& whole,
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

std::vector<AccompanyingAxes::Row> rows_of(const DampedWhole& whole, const CarriedMass& mass) {
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

std::vector<AccompanyingAxes::Row> rows_of(const DampedWhole& whole, const ConstrainedPlace& place, int dofs_per_node) {
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

std::optional<dynamics::MovingAxes> DampedWhole::axes() const {
  return fixed ? std::nullopt : std::optional<dynamics::MovingAxes>(f);
}

bool DampedWhole::has(int body) const { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); }

int DampedWhole::place_in(int body) const {
  return static_cast<int>(std::find(bodies.begin(), bodies.end(), body) - bodies.begin());
}

std::vector<DampedWhole> damped_wholes(const Plan& plan, bool corotational, const std::vector<bool>& still) {
  std::vector<DampedWhole> all;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    const Body& spec = plan.bodies[b].spec;
    const bool modal = corotational && has_modal_damping(spec);
    if ((spec.damping.mass == 0 && !modal) || spec.rigid || spec.reduced) continue;
    const std::string name = whole_name(spec);
    if (name == spec.name && !corotational) continue;
    if (all.empty() || whole_name(plan.bodies[all.back().bodies.front()].spec) != name) {
      all.emplace_back();
      all.back().alpha = spec.damping.mass;
    }
    all.back().bodies.push_back(static_cast<int>(b));
  }
  for (DampedWhole& whole : all) {
    whole.length = 0;
    for (int b : whole.bodies) whole.length += fem::extent(plan.bodies[b].structure);
    std::vector<fem::Conditions> by_ground;
    for (int b : whole.bodies) {
      by_ground.push_back(plan.bodies[b].constrained);
      whole.constrained.push_back(constrained_for_damping(plan, whole.bodies, b));
    }
    const int dimension = plan.scene.dimension;
    whole.fixed =
        firmly_grounded(plan, whole) && split(products_of_dofs(plan, whole, by_ground), dimension).second.cols() == 0;
    for (int b : whole.bodies) whole.fixed = whole.fixed || still[b];
    // Modes need axes in which deformations are measured.
    if (corotational && has_modal_damping(plan.bodies[whole.bodies.front()].spec)) whole.fixed = false;
    std::tie(whole.seen, whole.free) = split(products_of_dofs(plan, whole, whole.constrained), dimension);
  }
  return all;
}

std::vector<std::unique_ptr<AccompanyingAxes>> conditions(
    const DampedWhole& whole, int dofs_per_node, const std::function<std::vector<CarriedMass>(int)>& masses,
    const std::function<std::vector<ConstrainedPlace>(int)>& places) {
  std::vector<std::unique_ptr<AccompanyingAxes>> terms;
  for (int b : whole.bodies) {
    for (const CarriedMass& mass : masses(b))
      if (whole.free.cols() > 0 && !whole.fixed) {
        const int first = whole.multipliers + static_cast<int>(whole.seen.cols());
        terms.push_back(
            std::make_unique<AccompanyingAxes>(mass.axes, mass.elastic, whole.f, first, rows_of(whole, mass)));
      }
    if (whole.fixed || whole.seen.cols() == 0) continue;
    for (const ConstrainedPlace& place : places(b))
      if (!place.dofs.empty())
        terms.push_back(std::make_unique<AccompanyingAxes>(place.axes, place.elastic, whole.f, whole.multipliers,
                                                           rows_of(whole, place, dofs_per_node)));
  }
  return terms;
}

JointMultipliers unknowns_of(const DampedWhole& whole) {
  std::vector<int> rows(2 * whole.f.coordinates().size());
  std::iota(rows.begin(), rows.end(), 0);
  return {whole.f.position, std::move(rows)};
}

VectorXd begin(const DampedWhole& whole, std::vector<std::unique_ptr<AccompanyingAxes>>& terms, const VectorXd& q,
               const VectorXd& v, MPI_Comm comm) {
  const std::vector<int> own = whole.f.coordinates();
  const Index n = static_cast<Index>(own.size());
  VectorXd open = VectorXd::Zero(n);
  MatrixXd J = MatrixXd::Zero(n, n);
  for (auto& term : terms) {
    const std::vector<int>& at = term->coordinates();
    const VectorXd q_at = q(at), v_at = v(at), a_at = VectorXd::Zero(q_at.size());
    const Index all = q_at.size(), rows = term->rows(), first = at[all - rows] - whole.multipliers;
    term->begin_at(q_at);
    VectorXd r = VectorXd::Zero(all);
    MatrixXd K = MatrixXd::Zero(all, all);
    const dynamics::Motion motion{0, q_at, v_at, a_at, dynamics::ConstraintLevel::velocity};
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
  return -J.fullPivLu().solve(open);
}

std::vector<std::unique_ptr<AccompanyingAxes>> modal_rows(const DampedWhole& whole, const PlannedBody& body,
                                                          const std::function<dynamics::MovingAxes(int)>& axes_of,
                                                          std::vector<std::unique_ptr<dynamics::Term>>& terms) {
  const reference::ModalDamping& modal = *whole.modal;
  const fem::Structure& s = body.structure;
  const Matrix3d A0 = undeformed_axes(body);
  const int n = s.dofs_per_node, k = static_cast<int>(modal.forces.size());
  std::vector<std::unique_ptr<petsc::ConstValues>> forces;
  for (const petsc::VecHandle& f : modal.forces) forces.push_back(std::make_unique<petsc::ConstValues>(f));
  std::vector<std::unique_ptr<AccompanyingAxes>> all;
  for (int node = 0; node < s.mesh.owned_nodes; ++node) {
    const Vector3d* spin = n == 6 ? fem::spin_axis(s.mesh, node) : nullptr;
    std::vector<AccompanyingAxes::Row> rows;
    bool any = false;
    for (const auto& f : forces) {
      Vector3d force = Vector3d::Zero(), moment = force;
      for (int d = 0; d < n; ++d) {
        const double value = (*f)[n * (s.mesh.first_node + node) + d];
        const bool rotation = d >= (n == 3 ? 2 : 3);
        if (!rotation)
          force[d] = value;
        else if (spin)
          moment += d - 3 == fem::spin_slot(*spin) ? Vector3d(value * *spin) : Vector3d::Zero();
        else
          moment[n == 3 ? 2 : d - 3] = value;
        any = any || value != 0;
      }
      AccompanyingAxes::Row row = zero_row(0);
      row.b = A0 * force;
      set_part(row, 0, 0.5 * skew(A0 * moment) * A0);
      rows.push_back(std::move(row));
    }
    if (any)
      all.push_back(std::make_unique<AccompanyingAxes>(axes_of(node), std::vector<int>{}, whole.f, modal.multipliers,
                                                       std::move(rows)));
  }
  int rank = 0, size = 1;
  MPI_Comm_rank(s.mesh.comm, &rank);
  MPI_Comm_size(s.mesh.comm, &size);
  if (rank + 1 < size) return all;
  std::vector<int> y(k);
  std::iota(y.begin(), y.end(), modal.y);
  terms.push_back(std::make_unique<dynamics::LinearDamping>(y, modal.viscosity.asDiagonal()));
  for (int i = 0; i < k; ++i) y.push_back(modal.multipliers + i);
  terms.push_back(std::make_unique<reference::LinearConstraint>(std::move(y), -MatrixXd::Identity(k, k)));
  return all;
}

VectorXd begin_modal(const DampedWhole& whole, std::vector<std::unique_ptr<AccompanyingAxes>>& rows, const VectorXd& q,
                     const VectorXd& v, MPI_Comm comm) {
  const Index k = static_cast<Index>(whole.modal->forces.size());
  VectorXd rate = VectorXd::Zero(k);
  for (auto& term : rows) {
    const std::vector<int>& at = term->coordinates();
    const VectorXd q_at = q(at), v_at = v(at), a_at = VectorXd::Zero(q_at.size());
    VectorXd r = VectorXd::Zero(q_at.size());
    term->begin_at(q_at);
    term->residual({0, q_at, v_at, a_at, dynamics::ConstraintLevel::velocity}, r);
    rate += r.tail(k);
  }
  MPI_Allreduce(MPI_IN_PLACE, rate.data(), static_cast<int>(k), MPI_DOUBLE, MPI_SUM, comm);
  return rate;
}

}  // namespace floe::assembly
