#include <catch2/catch.hpp>
#include <cmath>

#include "floe/reduction/projection.h"
#include "floe/reduction/reduce.h"
#include "structures.h"

using namespace floe;
using Eigen::VectorXd;
using reduction::ColumnOrigin;
using reduction::Columns;

// The columns of the manual's page on extending floe: from [columns] to [end] they stand there word by word.
namespace {

// [columns]
/// Load-dependent columns: the static answer to a load, and what its inertia asks for in turn,
///
///   u_1 = K^-1 f,   u_(i+1) = K^-1 M u_i
///
/// @param load  f; the columns are in the floating frame
/// Collective. `count` solves with the factor that modes and derivatives use. Source: Wilson, Yuan, Dickens 1982.
Columns load_dependent(const fem::Structure& structure, const reduction::Statics& statics, Vec load, int count) {
  const petsc::MatHandle M = fem::mass(structure, {});
  Columns all;
  petsc::VecHandle f = reduction::copy(load);
  for (int i = 0; i < count; ++i) {
    Columns loads;
    loads.push_back(std::move(f));
    all.push_back(std::move(statics.solve(loads)[0]));
    petsc::check(VecScale(all.back(), 1 / reduction::mass_norm(M, all.back())));
    petsc::check(VecDuplicate(load, f.out()));
    petsc::check(MatMult(M, all.back(), f));
  }
  return all;
}

/// The basis of these alone. Any candidates will do: modes, derivatives, measured shapes; in their order, each without
/// what those before it hold.
reduction::Basis load_dependent_basis(const fem::Structure& structure, const reduction::Statics& statics, Vec load,
                                      int count) {
  std::vector<ColumnOrigin> origins;
  for (int i = 1; i <= count; ++i)
    origins.push_back({ColumnOrigin::Kind::attachment, "attachment tip.inertia" + std::to_string(i)});
  return reduction::orthonormal_basis(structure, load_dependent(structure, statics, load, count), origins, 1e-9);
}
// [end]

/// A cantilever along x, its frame at the clamp, a unit force across its tip.
struct Cantilever {
  fem::Structure structure = testing::straight(PETSC_COMM_WORLD, 12, 1, {1e4, 1, 1, 0});
  fem::ReferenceFrame frame = fem::reference_frame(structure, fem::ReferenceFrame::Kind::clamped, 0, 12);
  fem::Holding holding = fem::holding(structure, frame, {0, 1, 2});
  reduction::Statics statics{structure, frame, holding};
  petsc::VecHandle load = [this] {
    VectorXd f = VectorXd::Zero(structure.dofs());
    f[3 * 12 + 1] = 1;
    return testing::field_of(structure, f);
  }();
};

/// Tip deflection under exp(iwt) at the tip, by all modes: sum phi^2 / (omega^2 - w^2).
double exact(const Cantilever& beam, double w) {
  const auto modes = reduction::vibration_modes(beam.structure, beam.frame, beam.holding, beam.statics, 36);
  double sum = 0;
  for (std::size_t i = 0; i < modes.omega.size(); ++i)
    sum += std::pow(testing::everywhere(modes.raw[i])[3 * 12 + 1], 2) / (std::pow(modes.omega[i], 2) - w * w);
  return sum;
}

double reduced(const Cantilever& beam, double w, int count) {
  const auto basis = load_dependent_basis(beam.structure, beam.statics, beam.load, count);
  const body::FlexibleBody body = reduction::project(beam.structure, basis);
  const VectorXd f = reduction::place_map(beam.structure, basis, 12).S.row(1).transpose();
  const Eigen::MatrixXd M = body::planar(body.inertia).M, K = body.elasticity.linear_stiffness();
  return f.dot((K - w * w * M).ldlt().solve(f));
}

}  // namespace

// r columns match 2r terms of the answer's series in w^2: with w at half the first frequency (3.516), each further
// column gains more than two digits.
TEST_CASE("worked example, columns: load-dependent columns follow a slow load, each better than the last") {
  const Cantilever beam;
  const double w = 3.516 / 2, full = exact(beam, w);
  double last = 1;
  for (int count = 1; count <= 3; ++count) {
    const double error = std::abs(reduced(beam, w, count) / full - 1);
    INFO(count << " columns: " << error);
    CHECK(error < last / 100);
    last = error;
  }
  CHECK(reduced(beam, 0, 1) == Approx(1.0 / 3).epsilon(1e-9));  // static: L^3 / 3 EI
}
