#include "floe/reduction/products.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace floe::reduction {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int sample_count = 32;
constexpr double deflection = 0.05;  // of the length, root mean square

/// A deformation, and how the body gives way there.
struct Sample {
  VectorXd q;
  Eigen::LDLT<MatrixXd> tangent;  ///< K_T
};

/// What each of some terms moves the body by, a column each, of the displacement's norm.
using Effects = std::vector<MatrixXd>;

/// Of variance 1; about normal: by the standard library's own distributions libraries would differ.
double random_number(std::mt19937& engine) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += double(engine()) / double(std::mt19937::max());
  return sum;
}

double length_of(const body::Inertia& inertia) {
  return std::sqrt(12 * std::max(0.0, inertia.C0.trace() - inertia.s0.squaredNorm() / inertia.m) / inertia.m);
}

VectorXd monomials(const body::Elasticity& e, const VectorXd& q) {
  VectorXd s(e.pairs.size());
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    s[static_cast<Index>(p)] = (a == b ? 0.5 : 1) * q[a] * q[b];
  }
  return s;
}

/// sum over the pairs of C_p (ds_p/dq)', rows x k.
MatrixXd slopes(const MatrixXd& C, const body::Elasticity& e, const VectorXd& q) {
  MatrixXd sum = MatrixXd::Zero(C.rows(), q.size());
  for (std::size_t p = 0; p < e.pairs.size(); ++p) {
    const auto [a, b] = e.pairs[p];
    sum.col(a) += q[b] * C.col(static_cast<Index>(p));
    if (a != b) sum.col(b) += q[a] * C.col(static_cast<Index>(p));
  }
  return sum;
}

/// Static amplitudes of the coordinates that lead, or those of one energy; of the same energy altogether.
VectorXd amplitudes(const VectorXd& stiffness, const std::vector<Index>& leads, double size, bool of_one_energy) {
  VectorXd all = VectorXd::Zero(stiffness.size());
  for (const Index i : leads) all[i] = 1 / stiffness[i];
  all *= size / all.norm();
  if (!of_one_energy) return all;
  const double energy = all.cwiseAbs2().dot(stiffness) / static_cast<double>(leads.size());
  for (const Index i : leads) all[i] = std::sqrt(energy / stiffness[i]);
  return all;
}

std::vector<Sample> samples_of(const body::FlexibleBody& body, const std::vector<char>& follows) {
  const body::Elasticity& e = body.elasticity;
  const Index k = body.coordinates();
  const MatrixXd K = e.linear_stiffness(), F = e.F.leftCols(k), bilinear = e.F.rightCols(e.F.cols() - k);
  std::vector<Index> leads, others;
  for (Index i = 0; i < k; ++i) (follows[i] ? others : leads).push_back(i);
  const double size = deflection * length_of(body.inertia) * std::sqrt(body.inertia.m);  // V'MV = 1
  const Eigen::LDLT<MatrixXd> statics(K(others, others).eval());
  std::vector<Sample> samples(leads.empty() || others.empty() || !(size > 0) ? 0 : sample_count);
  std::mt19937 engine;
  body::ElasticityWork work;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    VectorXd& q = samples[n].q = amplitudes(K.diagonal(), leads, size, n % 2 == 1);
    for (const Index i : leads) q[i] *= random_number(engine);
    VectorXd force = VectorXd::Zero(k);  // twice its part of second order
    add_force(e, q, work, force);
    add_force(e, -q, work, force);
    q(others) = (-0.5 * statics.solve(force(others).eval())).eval();
    const MatrixXd T = F + slopes(bilinear, e, q);
    samples[n].tangent.compute(e.bending + T.transpose() * T);
    if (samples[n].tangent.info() != Eigen::Success || !(q.norm() > 0)) return {};
  }
  return samples;
}

Effects of_products(const body::Elasticity& e, const std::vector<Sample>& samples) {
  const Index k = e.bending.rows();
  const MatrixXd F = e.F.leftCols(k), bilinear = e.F.rightCols(e.F.cols() - k);
  Effects effects;
  for (const Sample& sample : samples) {
    const VectorXd& q = sample.q;
    const VectorXd s = monomials(e, q), w = bilinear.transpose() * (F * q + bilinear * s);
    const MatrixXd T = F + slopes(bilinear, e, q);
    MatrixXd force = T.transpose() * bilinear * s.asDiagonal();
    for (std::size_t p = 0; p < e.pairs.size(); ++p) {
      const auto [a, b] = e.pairs[p];
      const Index at = static_cast<Index>(p);
      force(a, at) += w[at] * q[b];
      if (a != b) force(b, at) += w[at] * q[a];
    }
    effects.push_back(sample.tangent.solve(force) / q.norm());
  }
  return effects;
}

/// Of squares without linear part: f = T_i' y_i.
Effects of_squares(const MatrixXd& rows, const body::Elasticity& e, const std::vector<Sample>& samples) {
  Effects effects;
  for (const Sample& sample : samples) {
    const VectorXd y = rows * monomials(e, sample.q);
    const MatrixXd force = slopes(rows, e, sample.q).transpose() * y.asDiagonal();
    effects.push_back(sample.tangent.solve(force) / sample.q.norm());
  }
  return effects;
}

/// Of each term whether it stays: from the least on they go, while all that go have an effect of at most `share`.
/// @param may_go  of each; empty: all
std::vector<char> kept(const Effects& effects, double share, const std::vector<char>& may_go = {}) {
  const Index count = effects[0].cols();
  VectorXd sizes = VectorXd::Zero(count);
  for (const MatrixXd& one : effects) sizes += one.colwise().squaredNorm().transpose();
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return sizes[i] < sizes[j]; });
  MatrixXd gone = MatrixXd::Zero(effects[0].rows(), static_cast<Index>(effects.size()));
  std::vector<char> stays(count, 1);
  for (const Index i : order) {
    if (!may_go.empty() && !may_go[i]) continue;
    for (Index n = 0; n < gone.cols(); ++n) gone.col(n) += effects[n].col(i);
    if (gone.norm() > share * std::sqrt(static_cast<double>(gone.cols()))) break;
    stays[i] = 0;
  }
  return stays;
}

/// Rows of F: first those that the linear columns span, in which nothing is omitted, then fewer of the others.
MatrixXd fewer_squares(const body::Elasticity& e, const std::vector<Sample>& samples, double share) {
  const Index k = e.bending.rows(), count = e.F.cols() - k;
  const Eigen::ColPivHouseholderQR<MatrixXd> linear(e.F.leftCols(k));
  const Index rank = linear.rank();
  MatrixXd F = linear.householderQ().adjoint() * e.F;
  F.bottomLeftCorner(F.rows() - rank, k).setZero();
  if (rank == F.rows() || count == 0) return F;
  VectorXd squares = VectorXd::Zero(count);
  for (const Sample& sample : samples) squares += (monomials(e, sample.q) / sample.q.norm()).cwiseAbs2();
  const MatrixXd others = F.bottomRightCorner(F.rows() - rank, count);
  const MatrixXd weighted = others * squares.asDiagonal() * others.transpose();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> main(weighted);
  const MatrixXd rotated = main.eigenvectors().transpose() * others;
  const std::vector<char> stays = kept(of_squares(rotated, e, samples), share);
  Index rows = rank;
  for (Index i = 0; i < rotated.rows(); ++i)
    if (stays[i]) F.row(rows++).tail(count) = rotated.row(i);
  return F.topRows(rows);
}

}  // namespace

std::vector<VectorXd> sampled_deformations(const body::FlexibleBody& body, const std::vector<char>& follows) {
  std::vector<VectorXd> all;
  for (Sample& sample : samples_of(body, follows)) all.push_back(std::move(sample.q));
  return all;
}

body::Elasticity with_fewer_products(const body::FlexibleBody& body, const std::vector<char>& follows, double share) {
  const std::vector<Sample> samples = body.elasticity.pairs.empty() ? std::vector<Sample>() : samples_of(body, follows);
  if (samples.empty()) return body.elasticity;
  std::vector<char> may_go;
  for (const auto& [a, b] : body.elasticity.pairs) may_go.push_back(follows[a] || follows[b]);
  body::Elasticity some =
      body::part(body.elasticity, body.coordinates(), kept(of_products(body.elasticity, samples), share, may_go));
  some.F = fewer_squares(some, samples, share);
  return some;
}

}  // namespace floe::reduction
