#pragma once
#include <slepceps.h>

#include <vector>

#include "floe/reduction/statics.h"

/// What the pairs of an eigenvalue solver are worth, and what makes them better.
namespace floe::reduction {

/// Who solves with K - s M: the shift-and-invert of an EPS, or, where the user has chosen another transformation, the
/// statics if they hold the body likewise, or nobody.
struct Transformation {
  KSP ksp = nullptr;
  double shift = 0;
  Transformation(EPS eps, const Statics& statics, const fem::Conditions& constrained);
};

/// Pairs of the matrix, that of round-off included.
struct Found {
  std::vector<double> lambda;
  Columns raw;
  std::vector<double> error;  ///< of lambda, relative, as SLEPc tells it, where it was asked to

  void add(double value, petsc::VecHandle x, double off) {
    lambda.push_back(value), raw.push_back(std::move(x)), error.push_back(off);
  }
  void resize(std::size_t count) { lambda.resize(count), raw.resize(count), error.resize(count); }
};

/// phi <- (lambda - s) (K - s M)^-1 M phi, all in one block: takes out what M does not see (rotations without mass) and
/// the eigenvalue solver leaves in. Returns how far the pairs were from K phi = lambda M phi, in the norm of
/// residuals(). Collective.
std::vector<double> purify(const Transformation& inverse, Mat M, const fem::Conditions& constrained, Found& found);

/// How far the pairs are from satisfying K phi = lambda M phi, by K without its round-off: (lambda - s)/lambda times
/// the M-norm of (K - s M)^-1 (K phi - lambda M phi), s the shift. It bounds |lambda - true lambda| / lambda.
/// Collective.
std::vector<double> residuals(const Transformation& inverse, Mat exact, Mat M, const fem::Conditions& constrained,
                              const Columns& phi, const std::vector<double>& lambda);

/// Rayleigh's quotients with the strain energy of the elements. Collective.
/// @param mix  whether modes are combined until they are stationary (Ritz): what K's round-off has rotated them, the
/// lowest most, is among themselves.
std::vector<double> exact_values(const fem::ElementStiffness& K, Mat M, bool mix, const Columns& phi);

}  // namespace floe::reduction
