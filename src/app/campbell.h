#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "floe/assembly/model.h"
#include "floe/output/folder.h"
#include "floe/output/table.h"
#include "floe/solve/steady_rotation.h"

namespace floe::app {

/// What `floe campbell` is asked for, as on the command line.
struct CampbellRequest {
  std::string speeds;                         ///< `from:to:step` or `a,b,c` [rad/s]
  std::optional<std::string> about, through;  ///< `x,y,z`, brackets as one likes
  int modes = 6;
  bool estimate = true;  ///< of the frequencies of reduced models
};

/// `from:to:step` or `a,b,c`, at most 10000 numbers. @throws what `fault` makes of what is wrong
std::vector<double> parse_values(const std::string& text,
                                 const std::function<InputError(const std::string& what)>& fault);
/// @throws InputError  no such list, or one of more than 10000 speeds
std::vector<double> parse_speeds(const std::string& text);
/// @param option  for messages  @throws InputError  not two or three numbers
Eigen::Vector3d parse_point(const std::string& text, const std::string& option);

/// A vibration, and its number among those that are followed from speed to speed.
struct TrackedVibration : solve::Vibration {
  int track = 0;         ///< from 1 on; 0: without oscillation
  double assurance = 0;  ///< solve::modal_assurance with the speed before; 0: the track begins, or has no shape
};

/// One speed of the diagram.
struct CampbellPoint {
  double speed = 0;
  std::string fault;  ///< why there is no steady rotation, or why its vibrations are not found; empty: there is
  PetscInt iterations = 0;
  std::vector<TrackedVibration> vibrations;
  bool steady = true;
  solve::RotationSearch search = {};  ///< on the way from the speed before
};

/// Estimated error of a reduced model's frequency (campbell_estimate.h).
struct FrequencyError {
  int track = 0;
  double relative = 0;
};

/// Estimated errors at the fastest steady rotation of a reduced model.
struct CampbellEstimate {
  double speed = 0;
  bool full_order = false;   ///< by the full-order model; else by one on larger bases
  PetscInt coordinates = 0;  ///< of that model
  std::vector<FrequencyError> errors;
  std::string missing;  ///< why there is none; empty: there is, or the model is not reduced
};

struct CampbellDiagram {
  std::vector<CampbellPoint> points;
  solve::RotationAxis axis;
  assembly::Model model;  ///< at the last steady rotation
  CampbellEstimate estimate = {};
  std::string label = {};
  double offline_seconds = 0, seconds = 0;
};

/// Builds one scene in one formulation, rotates it steadily at each speed in turn, each from the one before and the
/// first from rest, and finds its vibrations.
///
/// @param fault  why it ended before the last speed, to be thrown once what was reached is written
/// @throws InputError  no axis, a scene that cannot rotate, formulation cfr; RunError. Collective.
CampbellDiagram campbell(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
                         const CampbellRequest& request, std::exception_ptr& fault);

/// A row for each vibration at each speed; remarks say what is unstable, a zero mode, or not there.
output::Table campbell_table(const CampbellDiagram& diagram);
nlohmann::ordered_json campbell_summary(const scene::Scene& scene, const CampbellDiagram& diagram, MPI_Comm comm);

/// `floe campbell`: the diagram as a table, campbell.csv and summary.json. Collective.
/// @throws RunError  also where there is no steady rotation at any speed
void campbell_one(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm,
                  const CampbellRequest& request, const output::ResultFolder& folder);

}  // namespace floe::app
