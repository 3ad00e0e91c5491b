#include "floe/dynamics/local_indices.h"
#include "floe/dynamics/relative_damping.h"
#include "floe/math/rotation.h"
#include "seen_axes.h"

// With N = A_f B A' and ax M = (M_32 - M_23, M_13 - M_31, M_21 - M_12) the gradient of a row by displacements and
// rotations of (R, A), of f, and by e_k is
//     g = A_f b,  m = ax N;    -g,  g x (R - R_f) - m;    tr(B_k'A_f'A)
// and  d ax N = (tr N - N) dphi_f - (tr N - N') dphi + sum ax N_k de_k.
namespace floe::dynamics {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using math::skew;

namespace {

Vector3d ax(const Matrix3d& M) { return {M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1)}; }

/// A row, or a sum of rows, at a configuration.
struct SeenRow {
  Vector3d g, m, rotation;  ///< on R, A and the rotation of f
  VectorXd e;
  Matrix3d N;
  Eigen::Matrix3Xd m_e;  ///< ax N_k
  double value = 0;
  Vector3d rho;

  SeenRow(const AccompanyingAxes::Row& row, const SeenAxes& at, const SeenAxes& f, const VectorXd& elastic)
      : rho(at.R - f.R) {
    const Matrix3d relative = f.A.transpose() * at.A;
    const auto part = [&](Index k) { return Matrix3d(row.B.col(k).reshaped(3, 3)); };
    Matrix3d B = part(0);
    e.resize(elastic.size()), m_e.resize(3, elastic.size());
    for (Index k = 0; k < elastic.size(); ++k) {
      B += elastic[k] * part(k + 1);
      e[k] = part(k + 1).cwiseProduct(relative).sum();
      m_e.col(k) = ax(f.A * part(k + 1) * at.A.transpose());
    }
    N = f.A * B * at.A.transpose();
    g = f.A * row.b, m = ax(N), rotation = g.cross(rho) - m;
    value = g.dot(rho) + B.cwiseProduct(relative).sum();
  }
};

/// A motion: of R - R_f, of A, of f, of e; columns.
struct Change {
  MatrixXd rho, phi, phi_f, e;
};

/// Of the gradient's parts.
struct Curvature {
  MatrixXd g, m, rotation, e;
  Curvature(const SeenRow& row, const Change& c) {
    const Matrix3d trace = row.N.trace() * Matrix3d::Identity();
    g = -skew(row.g) * c.phi_f;
    m = (trace - row.N) * c.phi_f - (trace - row.N.transpose()) * c.phi + row.m_e * c.e;
    rotation = -skew(row.rho) * g + skew(row.g) * c.rho - m;
    e = row.m_e.transpose() * (c.phi - c.phi_f);
  }
};

}  // namespace

AccompanyingAxes::Row& AccompanyingAxes::Row::operator+=(const Row& other) {
  b += other.b, B += other.B;
  return *this;
}

AccompanyingAxes::Row AccompanyingAxes::Row::operator*(double factor) const { return {factor * b, factor * B}; }

AccompanyingAxes::AccompanyingAxes(const MovingAxes& axes, std::vector<int> elastic, const MovingAxes& f,
                                   int multipliers, std::vector<Row> rows)
    : axes_(axes),
      f_(f),
      elastic_(static_cast<int>(elastic.size())),
      rows_(std::move(rows)),
      start_(VectorXd::Zero(static_cast<Index>(rows_.size()))),
      coordinates_(std::move(elastic)) {
  place_all(axes_.coordinates(), coordinates_);
  place_all(f_.coordinates(), coordinates_);
  for (std::size_t i = 0; i < rows_.size(); ++i) coordinates_.push_back(multipliers + static_cast<int>(i));
}

void AccompanyingAxes::begin_at(const VectorXd& q) {
  const Motion motion{0, q, q, q};
  const SeenAxes at = see(axes_, coordinates_, motion), f = see(f_, coordinates_, motion);
  for (int i = 0; i < rows(); ++i) start_[i] = SeenRow(rows_[i], at, f, q.head(elastic_)).value;
}

void AccompanyingAxes::begin_at(const Vector3d& R, const Matrix3d& A) {
  for (int i = 0; i < rows(); ++i) start_[i] = rows_[i].b.dot(R) + rows_[i].B.col(0).dot(A.reshaped());
}

void AccompanyingAxes::residual(const Motion& motion, VectorXd& r) const {
  const SeenAxes at = see(axes_, coordinates_, motion), f = see(f_, coordinates_, motion);
  const VectorXd e = motion.q.head(elastic_), v = motion.v.head(elastic_), a = motion.a.head(elastic_);
  Row sum{Vector3d::Zero(), MatrixXd::Zero(9, 1 + elastic_)};
  const Index first = motion.q.size() - rows();
  for (int i = 0; i < rows(); ++i) {
    sum += rows_[i] * motion.q[first + i];
    const SeenRow row(rows_[i], at, f, e);
    const auto along = [&](const Vector3d& rho, const Vector3d& w, const Vector3d& w_f, const VectorXd& rate) {
      return row.g.dot(rho) + row.m.dot(w) + row.rotation.dot(w_f) + row.e.dot(rate);
    };
    double& value = r[first + i];
    if (motion.level == ConstraintLevel::position) {
      value += row.value - start_[i];
    } else if (motion.level == ConstraintLevel::velocity) {
      value += along(at.v - f.v, at.w, f.w, v);
    } else {
      const Vector3d rho = at.v - f.v;
      const Curvature c(row, {rho, at.w, f.w, v});
      value += along(at.vd - f.vd, at.wd, f.wd, a) + c.g.col(0).dot(rho) + c.m.col(0).dot(at.w) +
               c.rotation.col(0).dot(f.w) + c.e.col(0).dot(v);
    }
  }
  const SeenRow force(sum, at, f, e);
  r.head(elastic_) += force.e;
  r.segment(at.p, at.d) += force.g.head(at.d);
  r.segment(at.o, at.n) += at.E.transpose() * force.m;
  r.segment(f.p, f.d) -= force.g.head(f.d);
  r.segment(f.o, f.n) += f.E.transpose() * force.rotation;
}

void AccompanyingAxes::tangent(const Motion& motion, Weights weights, MatrixXd& J) const {
  const SeenAxes at = see(axes_, coordinates_, motion), f = see(f_, coordinates_, motion);
  const VectorXd e = motion.q.head(elastic_);
  const Index all = motion.q.size(), first = all - rows();
  Row sum{Vector3d::Zero(), MatrixXd::Zero(9, 1 + elastic_)};
  for (int i = 0; i < rows(); ++i) {
    sum += rows_[i] * motion.q[first + i];
    const SeenRow row(rows_[i], at, f, e);
    VectorXd on = VectorXd::Zero(all), by = on;  // a force of the row, and its derivatives
    on.head(elastic_) = row.e;
    on.segment(at.p, at.d) = row.g.head(at.d), on.segment(f.p, f.d) = -row.g.head(f.d);
    by = on;
    on.segment(at.o, at.n) = at.E.transpose() * row.m, on.segment(f.o, f.n) = f.E.transpose() * row.rotation;
    by.segment(at.o, at.n) = at.T.transpose() * on.segment(at.o, at.n);
    by.segment(f.o, f.n) = f.T.transpose() * on.segment(f.o, f.n);
    J.col(first + i) += on;
    J.row(first + i) += by.transpose();
  }
  if (weights.q == 0) return;
  Change c{MatrixXd::Zero(3, all), MatrixXd::Zero(3, all), MatrixXd::Zero(3, all), MatrixXd::Zero(elastic_, all)};
  c.rho.topRows(at.d).middleCols(at.p, at.d).diagonal().array() += 1;
  c.rho.topRows(f.d).middleCols(f.p, f.d).diagonal().array() -= 1;
  c.phi.middleCols(at.o, at.n) = at.E * at.T, c.phi_f.middleCols(f.o, f.n) = f.E * f.T;
  c.e.leftCols(elastic_).setIdentity();
  const SeenRow force(sum, at, f, e);
  const Curvature d(force, c);
  J.topRows(elastic_) += weights.q * d.e;
  J.middleRows(at.p, at.d) += weights.q * d.g.topRows(at.d);
  J.middleRows(f.p, f.d) -= weights.q * d.g.topRows(f.d);
  J.middleRows(at.o, at.n) += weights.q * at.E.transpose() * (d.m + skew(force.m) * c.phi);
  J.middleRows(f.o, f.n) += weights.q * f.E.transpose() * (d.rotation + skew(force.rotation) * c.phi_f);
}

}  // namespace floe::dynamics
