#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floe/assembly/body_stage.h"
#include "floe/assembly/combination.h"
#include "floe/assembly/offline.h"
#include "floe/fem/missing_stiffness.h"
#include "floe/math/rounded.h"
#include "floe/petsc/values.h"
#include "floe/plan/interface.h"
#include "floe/reduction/stiffness_change.h"
#include "validity_seen.h"

namespace floe::assess {

using Eigen::Vector3d;
using petsc::check;
using solve::State;

namespace {

constexpr std::size_t most_looked_at = 8;  // states, for the one with the most energy
constexpr double most_change = 0.05;

Vector3d spin_of(const BodyReport& body, const State& state) {
  if (body.first_coordinate < 0) return Vector3d::Zero();
  return state.v.segment<3>(body.first_coordinate + 3);
}

/// Zero where it has no coordinates. Collective.
petsc::VecHandle shape_of(const BodyReport& body, const State& state) {
  petsc::VecHandle q = deformation_of(body, state);
  return q.get() ? std::move(q) : fem::field(*body.structure);
}

/// The states that load the body most: by its energy at small strains, and by its spin where that one is not among the
/// fastest. Collective.
std::vector<const State*> most_loaded(const BodyReport& body, const reduction::Statics& statics,
                                      const std::vector<const State*>& states) {
  const std::size_t stride = (states.size() + most_looked_at - 1) / most_looked_at;
  const State *bent = nullptr, *fast = nullptr;
  double most = -1, fastest = -1;
  for (std::size_t i = states.size(); i > 0; i -= std::min(i, stride)) {
    const State& state = *states[i - 1];
    const double energy = statics.elements()->strain_energy(shape_of(body, state)), spin = spin_of(body, state).norm();
    if (energy > most) most = energy, bent = &state;
    if (spin > fastest) fastest = spin, fast = &state;
  }
  if (!bent) return {};  // no energy is a number
  if (fastest <= 1.05 * spin_of(body, *bent).norm()) return {bent};
  return {bent, fast};
}

struct Cause {
  const char* what;
  Mat A;
};

/// x'A x.
double form(Mat A, Vec x) {
  if (!A || !x) return 0;
  const petsc::VecHandle y = reduction::copy(x);
  double value = 0;
  check(MatMult(A, x, y));
  check(VecDot(x, y, &value));
  return value;
}

struct Found {
  std::string what;  // the cause that counts most
  double change = 0;
  bool own = false;  // of the deformation itself
};

/// The cause that counts most in some shapes.
std::string main_of(const std::vector<Cause>& causes, const std::vector<Vec>& shapes) {
  const auto size = [&](const Cause& cause) {
    double sum = 0;
    for (Vec x : shapes) sum += std::abs(form(cause.A, x));
    return sum;
  };
  return std::max_element(causes.begin(), causes.end(),
                          [&](const Cause& a, const Cause& b) { return size(a) < size(b); })
      ->what;
}

/// What moves across the axis of a spin, n n' of rotations and 1 - n n' of displacements.
void take_across(const Vector3d& n, Vec x) {
  petsc::Values values(x);
  for (double* node = values.begin(); node != values.begin() + (values.end - values.first); node += 6) {
    Eigen::Map<Vector3d> u(node), theta(node + 3);
    u -= n * n.dot(u), theta = (n * n.dot(theta)).eval();
  }
}

/// The rest of the model's stiffness about a state: its own initial stresses, and the centrifugal forces -Omega^2 M of
/// what moves across the axis.
reduction::Operator more_than_elastic(const BodyReport& body, Vec q, const Vector3d& spin) {
  const auto stress = std::make_shared<petsc::MatHandle>(fem::initial_stress_stiffness(*body.structure, q));
  if (spin.isZero(0)) return [stress](Vec x, Vec y) { check(MatMult(*stress, x, y)); };
  const auto mass = std::make_shared<petsc::MatHandle>(fem::mass(*body.structure, {}));
  return [spin, stress, mass](Vec x, Vec y) {
    const petsc::VecHandle across = reduction::copy(x);
    take_across(spin.normalized(), across);
    check(MatMult(*mass, across, y));
    take_across(spin.normalized(), y);
    check(VecScale(y, -spin.squaredNorm()));
    check(MatMultAdd(*stress, x, y, y));
  };
}

Found found_at(const BodyReport& body, const reduction::Statics& statics, const State& state) {
  const petsc::VecHandle q = shape_of(body, state);
  const Vector3d spin = spin_of(body, state);
  const fem::MissingStiffness missing = fem::missing_stiffness(*body.structure, q);
  std::vector<Cause> causes;
  for (const Cause& cause :
       {Cause{"in-plane", missing.in_plane}, {"coupling", missing.coupling}, {"tension", missing.tension}})
    if (cause.A) causes.push_back(cause);
  if (causes.empty()) return {};
  const reduction::Operator more = more_than_elastic(body, q, spin);
  double work = 0;
  for (const Cause& cause : causes) work += form(cause.A, q);
  const petsc::VecHandle force = fem::field(*body.structure);
  double energy = 0;
  more(q, force);
  check(VecDot(q, force, &energy));
  energy += 2 * statics.elements()->strain_energy(q);
  const double own = energy > 0 ? work / energy : 0;
  const reduction::StiffnessChange change = reduction::stiffness_change(
      *body.structure, statics,
      [&](Vec x, Vec y) {
        check(MatMult(causes[0].A, x, y));
        for (std::size_t i = 1; i < causes.size(); ++i) check(MatMultAdd(causes[i].A, x, y, y));
      },
      more);
  if (std::abs(own) > most_change) return {main_of(causes, {q}), own, true};
  if (change.relative == 0) return {};
  return {main_of(causes, {change.shapes.begin(), change.shapes.end()}), change.relative};
}

std::string words(const BodyReport& body, const Found& found) {
  const std::string of = found.own ? "for its own deformation" : "of one of its shapes";
  const std::string number = math::percent(std::abs(found.change)), too = found.change > 0 ? "soft" : "stiff";
  if (found.what == "coupling")
    return fmt::format(
        "body {}: second-order coupling of bending and torsion changes the stiffness {} by {} (limit 5 %), and "
        "is not in von Karman's strains: too {}; use strains: second_order, or several frames (frames: N)",
        body.name, of, number, too);
  if (found.what == "tension")
    return fmt::format(
        "body {}: stiffening of torsion by axial force changes the stiffness {} by {} (limit 5 %), and is not part of "
        "its beams: too {}; use wagner: true in their section",
        body.name, of, number, too);
  return fmt::format(
      "body {}: quadratic strains of displacements in the plane of its shells change the stiffness {} by {} "
      "(limit 5 %), and are not part of von Karman's strains: too {}; use strains: second_order",
      body.name, of, number, too);
}

}  // namespace

void judge_missing(const Model& model, std::size_t b, const std::vector<const State*>& states,
                   std::vector<OutOfRange>& out) {
  const BodyReport& body = model.bodies[b];
  if (body.rigid || body.dimension == 2 || !body.structure || !model.offline || states.empty()) return;
  if (model.formulation == Formulation::lffr || model.formulation == Formulation::cfr) return;
  Found worst;
  try {
    std::shared_ptr<const reduction::Statics> statics = model.offline->reduced[b].statics;
    fem::Holding holding;
    if (!statics) {
      const PlannedBody& plan = model.offline->plan.bodies[b];
      holding =
          fem::holding(plan.structure, plan.frame, constrained_by_modes(model.offline->plan, static_cast<int>(b)));
      statics = std::make_shared<const reduction::Statics>(plan.structure, plan.frame, holding);
    }
    for (const State* state : most_loaded(body, *statics, states))
      if (const Found found = found_at(body, *statics, *state); std::abs(found.change) > std::abs(worst.change))
        worst = found;
  } catch (const RunError& error) {  // of a solve with K, on all ranks
    out.push_back({"unchecked", body.name, 0, most_change,
                   fmt::format("body {}: second-order strains were not checked: {}", body.name, error.what())});
    return;
  }
  if (!(std::abs(worst.change) > most_change)) return;
  out.push_back({worst.what, body.name, std::abs(worst.change), most_change, words(body, worst)});
}

}  // namespace floe::assess
