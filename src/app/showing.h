#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stress.h"

namespace CLI {
class App;
}

namespace floe::app {

/// A script that stands for a command, and the words that it gets.
struct Script {
  std::string name;
  std::vector<std::string> words;
};

/// What the commands that show results were asked for; must live as long as the command line is read.
struct Showing {
  std::string folder, amplify = "1", times, format, view, body;
  std::vector<std::string> paths, kinds, probes;
  std::optional<std::string> out;
  int frames = 200, pictures = 100, dpi = 150, shapes = 6;  ///< frames: of motion; pictures: of an animation
  double fps = 20;
  bool force = false, with_shapes = false, no_geometric_stiffness = false, components = false;
  std::string columns, gyroscopic_columns;  ///< of what is exported
  StressRequest stress;
  std::optional<Script> script;  ///< to become, instead of working in a session
};

/// Adds `motion`, `stress`, `plot`, `report` and `export`. @param work  of motion and stress
void add_showing(CLI::App& app, Showing& showing, std::function<void()>& work);

}  // namespace floe::app
