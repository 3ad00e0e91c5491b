#include "draw.h"

#include <unistd.h>

#include <cstdlib>

#include "floe/version.h"

namespace floe::app {
namespace {

std::string shell_quoted(const std::string& word) {
  std::string safe = "'";
  for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

bool readable(const std::string& path) { return access(path.c_str(), R_OK) == 0; }

}  // namespace

std::string draw(const std::string& folder, const std::string& name) {
  std::string script = std::string(FLOE_SCRIPTS_INSTALLED) + "/" + name + ".py";
  if (!readable(script)) script = std::string(FLOE_SCRIPTS_SOURCE) + "/" + name + ".py";
  const std::string python = readable("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  if (std::system(
          (shell_quoted(python) + " " + shell_quoted(script) + " " + shell_quoted(folder) + " >/dev/null").c_str()) !=
      0)
    return "no picture: " + script + " failed (it needs python3 and matplotlib)";
  return folder + "/" + name + ".png";
}

}  // namespace floe::app
