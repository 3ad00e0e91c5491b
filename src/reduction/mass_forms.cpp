#include "mass_forms.h"

#include <algorithm>
#include <cmath>

namespace floe::reduction {
namespace {

constexpr int together = 480;  // samples of one product

}  // namespace

MassForms::MassForms(const fem::Structure& structure, const fem::FieldRows& fields, const fem::DofRanges& ranges,
                     bool cross)
    : structure_(structure),
      fields_(fields),
      ranges_(ranges),
      cross_(cross),
      inertia_(structure.dimension(), static_cast<int>(fields.cols())) {
  for (Samples* samples : {&single_, &pairs_}) {
    samples->along.fill(RowStack(static_cast<int>(fields.cols()), together));
    samples->moments.resize(4, together);
  }
}

void MassForms::push(const fem::PieceRows& piece, const fem::MassRows& sample, Samples& samples) {
  const double root = std::sqrt(sample.mass);
  for (int a = 0; a < structure_.dimension() && fields_.cols() > 0; ++a) {
    RowStack& stack = samples.along[a];
    stack.range.include(fem::multiply(structure_, piece, root * sample.N.row(a), fields_, ranges_, stack.next()));
    ++stack.count;
  }
  samples.moments.col(samples.count) << root, root * sample.x;
  if (++samples.count == together) flush(samples, !sample.pair);
}

void MassForms::add(const fem::PieceRows& piece, const std::vector<fem::MassRows>& samples) {
  const int d = structure_.dimension();
  for (const fem::MassRows& sample : samples) {
    inertia_.C0 += sample.mass * (sample.x * sample.x.transpose()).topLeftCorner(d, d);
    if (!sample.pair) inertia_.m += sample.mass, inertia_.s0 += sample.mass * sample.x.head(d);
    push(piece, sample, sample.pair ? pairs_ : single_);
  }
}

void MassForms::add(const fem::PieceRows& piece, const std::vector<fem::RotaryRows>& masses) {
  for (const fem::RotaryRows& mass : masses) {
    if (rotations_.columns == 0) rotations_ = RowStack(static_cast<int>(fields_.cols()), together);
    if (fields_.cols() == 0) return inertia_.allocate_rotary();
    rotations_.range.include(fem::multiply(structure_, piece, mass.rotation, fields_, ranges_, rotations_.next()));
    rotations_.count += 3;
    forms_.push_back(mass);
    if (rotations_.count + 3 > together) flush_rotary();
  }
}

void MassForms::flush_rotary() {
  if (forms_.empty()) return;
  inertia_.allocate_rotary();
  const int d = structure_.dimension();
  if (!rotations_.range.empty()) {
    const Eigen::Index begin = rotations_.range.begin, count = rotations_.range.end - rotations_.range.begin;
    const Eigen::Map<const Eigen::MatrixXd> all(rotations_.rows.data(), rotations_.columns, rotations_.count);
    const auto rows = all.middleRows(begin, count);
    Eigen::MatrixXd weighted(count, rotations_.count);
    const auto add_forms = [&](auto&& form, Eigen::MatrixXd& to) {
      for (std::size_t i = 0; i < forms_.size(); ++i) {
        const auto at = 3 * static_cast<Eigen::Index>(i);
        weighted.middleCols<3>(at).noalias() = rows.middleCols<3>(at) * form(forms_[i]);
      }
      to.block(begin, begin, count, count).noalias() += rows * weighted.transpose();
    };
    const bool arms = std::any_of(forms_.begin(), forms_.end(), [](const auto& forms) { return forms.has_first(); });
    if (arms) inertia_.allocate_first();
    for (int a = 0; a < d; ++a) {
      if (arms) add_forms([&](const auto& forms) { return forms.first[a]; }, inertia_.Q[a]);
      for (int b = 0; b < d; ++b) add_forms([&](const auto& forms) { return forms.moments[a][b]; }, inertia_.W[a][b]);
    }
  }
  rotations_.clear();
  forms_.clear();
}

void MassForms::flush(Samples& samples, bool first_moments) {
  const int d = structure_.dimension();
  for (int a = 0; a < d; ++a) {
    RowStack& stack = samples.along[a];
    if (stack.range.empty()) continue;
    const Eigen::Index begin = stack.range.begin, count = stack.range.end - stack.range.begin;
    const Eigen::Map<const Eigen::MatrixXd> rows(stack.rows.data(), stack.columns, stack.count);
    const Eigen::MatrixXd with = rows.middleRows(begin, count) * samples.moments.leftCols(samples.count).transpose();
    if (first_moments) inertia_.S.row(a).segment(begin, count) += with.col(0).transpose();
    for (int b = 0; b < d; ++b) inertia_.h[b][a].segment(begin, count) += with.col(1 + b);
    for (int b = a; b < (cross_ ? d : a + 1); ++b) add_product(stack, samples.along[b], inertia_.M[a][b]);
  }
  for (RowStack& stack : samples.along) stack.clear();
  samples.count = 0;
}

namespace {

/// The constants in body axes from those in the axes R (columns).
body::Inertia rotated(const body::Inertia& of, const Eigen::Matrix3d& R) {
  body::Inertia to(3, of.coordinates());
  to.m = of.m, to.s0 = R * of.s0, to.C0 = R * of.C0 * R.transpose(), to.S = R * of.S;
  if (!of.Q.empty()) {
    to.allocate_first();
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) to.Q[a] += R(a, c) * of.Q[c];
  }
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) {
          const double factor = R(a, c) * R(b, d);
          if (factor == 0) continue;
          to.h[a][b] += factor * of.h[c][d];
          to.M[a][b] += factor * of.M[c][d];
          if (!of.W.empty()) to.allocate_rotary(), to.W[a][b] += factor * of.W[c][d];
        }
  return to;
}

}  // namespace

body::Inertia MassForms::sums() {
  flush(single_, true);
  flush(pairs_, false);
  flush_rotary();
  for (int a = 0; a < structure_.dimension(); ++a) {
    mirror(inertia_.M[a][a]);
    for (int b = 0; b < a; ++b) inertia_.M[a][b] = inertia_.M[b][a].transpose();
  }
  const fem::FlatBody* flat = fem::flat_body(structure_);
  return flat && !flat->axes.isIdentity(0) ? rotated(inertia_, flat->axes) : inertia_;
}

Eigen::MatrixXd mass_gram(const fem::Structure& structure, const fem::FieldRows& fields) {
  const fem::DofRanges ranges = fem::dof_ranges(structure, fields);
  MassForms forms(structure, fields, ranges, false);
  std::vector<fem::PieceRows> pieces;
  for (const auto& cell : structure.mesh.cells) {
    fem::piece_rows(structure, cell, {.mass = true}, pieces);
    for (const fem::PieceRows& piece : pieces) forms.add(piece, piece.mass);
  }
  const body::Inertia sums = forms.sums();
  Eigen::MatrixXd gram = sums.M[0][0];
  for (int a = 1; a < structure.dimension(); ++a) gram += sums.M[a][a];
  return gram;
}

}  // namespace floe::reduction
