#include "drawing.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "floe/version.h"

namespace floe::app {
namespace {

std::string shell_quoted(const std::string& word) {
  std::string safe = "'";
  for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return safe + "'";
}

bool readable(const std::string& path) { return access(path.c_str(), R_OK) == 0; }

/// Beside this program where it was installed, wherever that was moved to; else in the source.
std::string script_of(const std::string& name) {
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::string file = "/" + name + ".py";
  for (const std::string& folder :
       {(program.parent_path().parent_path() / "share" / "floe").string(), std::string(FLOE_SCRIPTS_INSTALLED)})
    if (readable(folder + file)) return folder + file;
  return std::string(FLOE_SCRIPTS_SOURCE) + file;
}

}  // namespace

std::string draw(const std::string& name, const std::string& folder) {
  const std::string script = script_of(name);
  const std::string python = readable("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  if (std::system(
          (shell_quoted(python) + " " + shell_quoted(script) + " " + shell_quoted(folder) + " >/dev/null").c_str()) !=
      0)
    return "no picture: " + script + " failed (it needs python3 and matplotlib)";
  return folder + "/" + name + ".png";
}

}  // namespace floe::app
