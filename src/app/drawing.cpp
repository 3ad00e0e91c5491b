#include "drawing.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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
       {(program.parent_path().parent_path() / "share" / "floe").string(), std::string(FLOE_SCRIPTS_INSTALLED),
        std::string(FLOE_SCRIPTS_SOURCE) + "/exchange"})
    if (readable(folder + file)) return folder + file;
  return std::string(FLOE_SCRIPTS_SOURCE) + "/plot" + file;
}

std::string python() { return readable("/usr/bin/python3") ? "/usr/bin/python3" : "python3"; }

/// Whether mpirun has started this process as another than the first.
bool later_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* rank = std::getenv(name)) return std::string(rank) != "0";
  return false;
}

}  // namespace

std::string draw(const std::string& name, const std::string& folder) {
  const std::string script = script_of(name);
  const std::string command = shell_quoted(python()) + " -B " + shell_quoted(script) + " " + shell_quoted(folder);
  if (std::system((command + " >/dev/null").c_str()) != 0)
    return "no picture: " + script + " failed (it needs python3 and matplotlib)";
  return folder + "/" + name + ".png";
}

int become_script(const std::string& name, const std::vector<std::string>& words) {
  if (later_rank()) return 0;
  const std::string script = script_of(name);
  if (!readable(script)) {
    std::fprintf(stderr, "floe: %s is missing: the installation of floe is incomplete\n", script.c_str());
    return 1;
  }
  std::vector<std::string> all = {python(), "-B", script};  // -B: leaves nothing beside the script
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers.front(), pointers.data());
  std::fprintf(stderr, "floe: cannot start python3: %s; install python3, python3-matplotlib and python3-h5py\n",
               std::strerror(errno));
  return 1;
}

}  // namespace floe::app
