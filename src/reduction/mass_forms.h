#pragma once
#include <array>
#include <vector>

#include "row_stack.h"

namespace floe::reduction {

/// Sums the inertia constants of k fields over mass samples, many samples at a time by BLAS.
class MassForms {
 public:
  /// @param cross  whether M_ab with a != b are wanted
  MassForms(const fem::Structure& structure, const fem::FieldRows& fields, const fem::DofRanges& ranges, bool cross);
  void add(const fem::PieceRows& piece, const std::vector<fem::MassRows>& samples);
  void add(const fem::PieceRows& piece, const std::vector<fem::RotaryRows>& masses);
  /// Of this rank.
  body::Inertia sums();

 private:
  /// Displacements of samples of one kind in each direction, times the root of mass.
  struct Samples {
    std::array<RowStack, 3> along;
    Eigen::Matrix4Xd moments;  ///< root of mass times (1, x, y, z)
    int count = 0;
  };
  void push(const fem::PieceRows& piece, const fem::MassRows& sample, Samples& samples);
  void flush(Samples& samples, bool first_moments);
  void flush_rotary();

  const fem::Structure& structure_;
  const fem::FieldRows& fields_;
  const fem::DofRanges& ranges_;
  const bool cross_;
  body::Inertia inertia_;
  Samples single_, pairs_;
  RowStack rotations_;  ///< three rows of each rotating mass
  std::vector<body::RotatingForms> forms_;
};

/// V'MV of this rank's share of mass: the sum of M_aa.
Eigen::MatrixXd mass_gram(const fem::Structure& structure, const fem::FieldRows& fields);

}  // namespace floe::reduction
