#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campbell.h"
#include "tradeoff.h"

namespace CLI {
class App;
}

namespace floe::app {

/// What the commands that compute were asked for; must live as long as the command line is read.
struct Arguments {
  std::string scene, formulation = "vm+md", body, reference;
  std::vector<std::string> formulations, varied;
  std::optional<std::string> out, matrices, restart, checkpoint, accuracy, explicit_scene;
  std::optional<double> at, until;
  int steps = 10, frequencies = 0, points = 1000, ranks_per_member = 1;
  CampbellRequest campbell;
  TradeoffRequest tradeoff;
  bool formulation_given = false, together = false, estimate = false, force = false, no_reference_error = false,
       no_estimate = false, path = false, markdown = false;
};

/// Adds run, compare, tradeoff, static, campbell, sweep, modes, reduce, info, check and schema.
/// @param work  set, when the command line is read, to what the command does: in a session (in_session), collective
void add_computing(CLI::App& app, Arguments& arguments, std::function<void()>& work);

}  // namespace floe::app
