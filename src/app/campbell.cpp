#include "campbell.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "campbell_check.h"
#include "campbell_estimate.h"
#include "campbell_tracks.h"
#include "floe/assembly/rotation.h"
#include "floe/assess/validity.h"
#include "floe/output/progress.h"
#include "floe/solve/deviation.h"
#include "interruption.h"
#include "run.h"

namespace floe::app {
namespace {

Eigen::Vector3d vector_of(const scene::Point& p) { return {p[0], p[1], p[2]}; }

Eigen::Vector3d direction_of(const scene::Scene& scene, const CampbellRequest& request, const scene::Joint* hub) {
  if (request.about) {
    const Eigen::Vector3d about = parse_point(*request.about, "--about");
    if (about.norm() == 0) throw InputError("--about: is the zero vector; expected three numbers, as [0,0,1]");
    if (scene.dimension == 2 && about.normalized().z() < 1 - 1e-12)
      throw InputError("--about: a planar scene rotates about [0,0,1]");
    return about.normalized();
  }
  if (scene.dimension == 2) return Eigen::Vector3d::UnitZ();
  if (hub && hub->axis_given) return vector_of(hub->axis).normalized();
  throw InputError(
      fmt::format("{}: {}; expected --about X,Y,Z and --through X,Y,Z", scene.file,
                  hub ? fmt::format("the only driven or revolute joint to the ground, {}, has no `axis`", hub->name)
                      : "the axis is not that of one driven or revolute joint to the ground"));
}

/// The scene with a probe more, that shows where the hub is at the start.
scene::Scene with_hub(scene::Scene scene, const scene::Joint& hub) {
  scene::Probe probe;
  probe.name = "hub";
  probe.at = hub.first.ground() ? hub.second : hub.first;
  probe.quantity = scene::Probe::Quantity::position;
  scene.probes.push_back(probe);
  return scene;
}

Eigen::Vector3d hub_position(const assembly::Model& model, int dimension) {
  const std::vector<double> values = assembly::probe_values(model, 0, model.U, model.V);
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int i = 0; i < dimension; ++i) at[i] = values[values.size() - dimension + i];
  return at;
}

/// The steady rotation in the model's unknowns.
solve::State state_at(const assembly::Model& model, const solve::RotationAxis& axis, double speed) {
  const petsc::VecHandle rest = model.system->create_vector();
  solve::State state = solve::state_of(*model.system, 0, model.U, rest, rest);
  for (const assembly::BodyReport& body : model.bodies) {
    const int first = body.first_coordinate;
    if (!body.attitude)
      state.v[first + 2] = speed;
    else
      state.v.segment<3>(first + 3) =
          speed * body.attitude->axes(state.q.segment<3>(first + 3)).transpose() * axis.direction;
  }
  return state;
}

/// What the fastest steady rotation says of the model.
void warn(double speed, const std::vector<solve::State>& fastest, MPI_Comm comm, assembly::Model& model) {
  for (const assess::OutOfRange& one : assess::shapes_out_of_range(model, fastest, comm))
    model.warnings.push_back(fmt::format("at {:.6g} rad/s: {}", speed, one.text));
}

void warn_of_branch(const CampbellPoint& point, CampbellDiagram& diagram) {
  if (const std::string words = solve::other_rotation(point.search); !words.empty())
    diagram.model.warnings.push_back(fmt::format("at {:.6g} rad/s: {}", point.speed, words));
  const solve::BranchJump& jump = point.search.jump;
  if (jump.ratio == 0) return;
  diagram.model.warnings.push_back(
      fmt::format("between {:.6g} and {:.6g} rad/s the steady rotation jumps to another branch: the change is {:.2g} "
                  "times that predicted by the tangents (limit {:.2g}). The results from there on belong to the other "
                  "branch; start from a speed or a shape (`initial`) on the intended branch",
                  jump.from, jump.to, jump.ratio, solve::least_jump));
}

}  // namespace

CampbellDiagram campbell(const scene::Scene& given, scene::Formulation formulation, MPI_Comm comm,
                         const CampbellRequest& request, std::exception_ptr& fault) {
  const std::vector<double> speeds = parse_speeds(request.speeds);
  if (formulation == scene::Formulation::cfr && given.dimension == 2)
    throw InputError("--formulation: cfr has no rotating frames in the plane; expected nlffr, lffr, vm or vm+md");
  const scene::Joint* hub = assembly::hub_of(given);
  CampbellDiagram diagram;
  diagram.axis.direction = direction_of(given, request, hub);
  if (request.through) diagram.axis.point = parse_point(*request.through, "--through");
  const bool look = !request.through && !request.about && hub;
  if (!request.through && !request.about && !hub)
    throw InputError(given.file +
                     ": the axis is not that of one driven or revolute joint to the ground; expected --through X,Y");
  const double begin = MPI_Wtime();
  diagram.model = plan_rotation(look ? with_hub(given, *hub) : given, formulation, comm);
  if (look) diagram.axis.point = hub_position(diagram.model, given.dimension);
  diagram.label = label_of(diagram.model);
  const solve::RotatingSystem rotating = assembly::rotating_system(given, diagram.model, diagram.axis);
  const PetscInt unknowns = diagram.model.coordinates + diagram.model.multipliers;
  if (unknowns > solve::largest_rotating_system)
    throw InputError(
        fmt::format("{} unknowns are too many for the vibrations of steady rotations, which take up to {}; expected a "
                    "reduced formulation (vm+md, vm), fewer modes or a coarser mesh",
                    unknowns, solve::largest_rotating_system));
  solve::check_rotations(rotating, diagram.model.U);
  if (given.motion.start != scene::Motion::Start::steady_rotation)  // which says so by itself
    for (std::string& warning : assembly::drives_beside_rotation(given))
      diagram.model.warnings.push_back(std::move(warning));
  const double started = MPI_Wtime();
  diagram.offline_seconds = started - begin;
  try {
    const Interruption interruption;
    output::Progress progress(comm, 0, static_cast<double>(speeds.size()));
    double from = 0, fastest = 0;
    std::vector<solve::State> state;
    CampbellTracks tracks;
    for (const double speed : speeds) {
      CampbellPoint point{speed, {}, 0, {}};
      from = visit_speed(rotating, from, request.modes, diagram.model.U, point);
      if (point.steady && std::abs(speed) >= std::abs(fastest))
        fastest = speed, state = {state_at(diagram.model, diagram.axis, speed)};
      warn_of_branch(point, diagram);
      tracks.follow(point);
      diagram.points.push_back(std::move(point));
      progress.update(static_cast<double>(diagram.points.size()), static_cast<PetscInt>(diagram.points.size()));
      interruption.check(comm);
    }
    warn(fastest, state, comm, diagram.model);
    if (request.estimate) estimate_frequencies(given, request.modes, fastest, comm, diagram);
    check_instability(given, request.modes, comm, diagram);
    if (!state.empty()) check_rotating_model(given, fastest, request.modes, comm, diagram);
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  diagram.seconds = MPI_Wtime() - started;
  return diagram;
}

}  // namespace floe::app
