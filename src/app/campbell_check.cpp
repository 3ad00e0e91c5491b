#include "campbell_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "floe/assembly/rotation.h"
#include "floe/math/rounded.h"
#include "floe/output/progress.h"
#include "floe/solve/deviation.h"

namespace floe::app {

assembly::Model plan_rotation(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm) {
  const output::Waiting waiting(comm, "preparing " + scene::name_of(formulation));
  return assembly::build(scene, formulation, comm, true);
}

double visit_speed(const solve::RotatingSystem& rotating, double from, int modes, Vec U, CampbellPoint& point) {
  try {
    point.iterations = solve::steady_rotation(rotating, from, point.speed, U, &point.search);
  } catch (const RunError& error) {
    point.fault = error.what(), point.steady = false;
    return from;
  }
  try {
    for (solve::Vibration& one : solve::vibrations(rotating, point.speed, U, modes))
      point.vibrations.push_back({std::move(one)});
  } catch (const RunError& error) {
    point.fault = error.what();
  }
  return point.speed;
}

const CampbellPoint* steady_at(const CampbellDiagram& diagram, double speed) {
  const auto at = std::find_if(diagram.points.begin(), diagram.points.end(),
                               [&](const CampbellPoint& point) { return point.steady && point.speed == speed; });
  return at == diagram.points.end() ? nullptr : &*at;
}

void follow(const solve::RotatingSystem& rotating, const CampbellDiagram& diagram, const CampbellPoint& last, int modes,
            Vec U, CampbellPoint& point) {
  double from = 0;
  for (const CampbellPoint& before : diagram.points) {
    if (&before == &last) break;
    if (before.steady) solve::steady_rotation(rotating, from, before.speed, U), from = before.speed;
  }
  visit_speed(rotating, from, modes, U, point);
}

OtherPoint in_other_model(const scene::Scene& scene, scene::Formulation formulation, int modes, const CampbellPoint& at,
                          MPI_Comm comm, const CampbellDiagram& diagram) {
  OtherPoint other{{at.speed, {}, 0, {}}};
  CampbellPoint& point = other.point;
  try {
    const assembly::Model model = plan_rotation(scene, formulation, comm);
    other.coordinates = model.coordinates;
    const PetscInt unknowns = model.coordinates + model.multipliers;
    if (unknowns > solve::largest_rotating_system)
      point.fault =
          fmt::format("the model for comparison has {} unknowns (limit {})", unknowns, solve::largest_rotating_system);
    else
      follow(assembly::rotating_system(scene, model, diagram.axis), diagram, at, modes, model.U, point);
  } catch (const InputError& error) {
    point.fault = error.what();
  } catch (const RunError& error) {
    point.fault = error.what();
  }
  return other;
}

namespace {

bool is_unstable(const CampbellPoint& point) {
  return std::any_of(point.vibrations.begin(), point.vibrations.end(),
                     [](const solve::Vibration& v) { return v.unstable(); });
}

}  // namespace

void check_instability(const scene::Scene& scene, int modes, MPI_Comm comm, CampbellDiagram& diagram) {
  const auto unstable = std::find_if(diagram.points.begin(), diagram.points.end(), is_unstable);
  const auto& bodies = diagram.model.bodies;
  if (unstable == diagram.points.end() || !is_reduced(diagram.model.formulation) ||
      std::all_of(bodies.begin(), bodies.end(), [](const assembly::BodyReport& body) { return body.rigid; }))
    return;
  const std::string what = fmt::format("the instability at {:.6g} rad/s", unstable->speed);
  const CampbellPoint point = in_other_model(scene, scene::Formulation::nlffr, modes, *unstable, comm, diagram).point;
  if (!point.fault.empty())
    diagram.model.warnings.push_back(
        fmt::format("{} was not checked with the full-order model: {}; compare with more modes", what, point.fault));
  else if (!is_unstable(point))
    diagram.model.warnings.push_back(
        fmt::format("{} is an artefact of the reduced model: the full-order model of the same mesh is stable there "
                    "(growth below 0, first frequency {:.4g} rad/s); take more modes and derivatives, or nlffr",
                    what, point.vibrations.empty() ? 0 : point.vibrations.front().omega));
}

namespace {

constexpr PetscInt most_unknowns = 300;
constexpr double most_difference = 0.025;

std::vector<double> frequencies_of(const CampbellPoint& point) {
  std::vector<double> all;
  for (const solve::Vibration& v : point.vibrations)
    if (v.omega > 0 && !v.zero) all.push_back(v.omega);
  std::sort(all.begin(), all.end());
  return all;
}

struct Rotated {
  std::array<std::vector<double>, 2> omega;  ///< at rest and at the speed; empty: not found
  double kinetic = 0;                        ///< energy at the speed [J]
  double undeformed = 0;                     ///< that of the start at this speed [J]
};

/// Whether the moments of inertia about the axis differ by a tenth, and by half of what the deformation makes of them.
bool on_other_branch(const Rotated& a, const Rotated& b) {
  const double apart = std::abs(a.kinetic - b.kinetic);
  return apart > 0.1 * std::min(a.kinetic, b.kinetic) &&
         apart > 0.5 * std::max(std::abs(a.kinetic - a.undeformed), std::abs(b.kinetic - b.undeformed));
}

Rotated at_rest_and_at(const scene::Scene& scene, assembly::Model& model, const CampbellDiagram& diagram,
                       const CampbellPoint& fastest, int modes) {
  const solve::RotatingSystem rotating = assembly::rotating_system(scene, model, diagram.axis);
  const petsc::VecHandle V = model.system->create_vector(), A = model.system->create_vector();
  const solve::State start = solve::state_of(*model.system, 0, model.U, V, A);
  Rotated found;
  const auto kinetic = [&] {
    solve::rotating_velocities(rotating, fastest.speed, model.U, V);
    return model.system->energy(0, model.U, V).kinetic;
  };
  found.undeformed = kinetic();
  std::array<CampbellPoint, 2> points;
  visit_speed(rotating, 0, modes, model.U, points[0]);
  solve::set_state(*model.system, start, model.U, V, A);
  points[1].speed = fastest.speed;
  follow(rotating, diagram, fastest, modes, model.U, points[1]);
  for (const int i : {0, 1})
    if (points[i].fault.empty()) found.omega[i] = frequencies_of(points[i]);
  found.kinetic = kinetic();
  return found;
}

}  // namespace

void check_rotating_model(const scene::Scene& scene, double speed, int modes, MPI_Comm comm, CampbellDiagram& diagram) {
  using scene::Formulation;
  const Formulation formulation = diagram.model.formulation;
  const CampbellPoint* fastest = steady_at(diagram, speed);
  if (scene.dimension == 2 || speed == 0 || !fastest) return;
  if (formulation == Formulation::cfr || formulation == Formulation::lffr) return;
  Rotated mine, exact;
  try {
    assembly::Model cfr = plan_rotation(scene, Formulation::cfr, comm);
    if (cfr.coordinates + cfr.multipliers > most_unknowns) return;
    exact = at_rest_and_at(scene, cfr, diagram, *fastest, modes);
    assembly::Model again = plan_rotation(scene, formulation, comm);
    mine = at_rest_and_at(scene, again, diagram, *fastest, modes);
  } catch (const InputError&) {
    return;
  } catch (const RunError&) {
    return;
  }
  std::size_t count = modes;
  for (const Rotated& one : {mine, exact})
    for (const std::vector<double>& omega : one.omega) count = std::min(count, omega.size());
  if (count > 0 && on_other_branch(mine, exact)) {
    diagram.model.warnings.push_back(fmt::format(
        "at {:.6g} rad/s the steady rotation of geometrically exact beams and shells (cfr) on the same mesh is another "
        "one, with a kinetic energy of {:.3g} J instead of {:.3g} J; their frequencies are not compared",
        speed, exact.kinetic, mine.kinetic));
    return;
  }
  double worst = most_difference;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    double limit = most_difference;  // and what it and its neighbours, which it may cross, differ by at rest
    for (std::size_t j = 0; j < std::min(i + 2, count); ++j)
      limit = std::max(limit, most_difference + std::abs(mine.omega[0][j] / exact.omega[0][j] - 1));
    const double error = std::abs(mine.omega[1][i] / exact.omega[1][i] - 1);
    if (!(error > limit && error - limit > worst - most_difference)) continue;
    worst = error - limit + most_difference;
    text = fmt::format(
        "at {:.6g} rad/s: frequency {} is {:.4g} rad/s, and {:.4g} rad/s with geometrically exact beams and shells "
        "(cfr) "
        "on the same mesh: {} apart (limit {}); use several frames (frames: N), more modes and derivatives, or cfr",
        speed, i + 1, mine.omega[1][i], exact.omega[1][i], math::percent(error), math::percent(limit));
  }
  if (!text.empty()) diagram.model.warnings.push_back(text);
}

}  // namespace floe::app
