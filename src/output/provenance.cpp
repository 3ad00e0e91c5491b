#include "floe/output/provenance.h"

#include <dlfcn.h>
#include <fmt/chrono.h>
#include <hdf5.h>
#include <slepcsys.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "floe/petsc/blas_kernel.h"
#include "floe/petsc/error.h"
#include "floe/version.h"

namespace floe::output {
namespace {

std::string first_line(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string petsc_version() {
  std::array<char, 256> text{};
  petsc::check(PetscGetVersion(text.data(), text.size()));
  return first_line(text.data());
}

std::string slepc_version() {
  std::array<char, 256> text{};
  petsc::check(SlepcGetVersion(text.data(), text.size()));
  return first_line(text.data());
}

std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  return first_line(text.data());
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("HDF5 {}.{}.{}", major, minor, release);
}

std::string blas_file() {
  Dl_info from{};
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  if (!dgemm || !dladdr(dgemm, &from) || !from.dli_fname) return "";
  std::error_code error;
  const auto file = std::filesystem::canonical(from.dli_fname, error);
  return error ? from.dli_fname : file.string();
}

/// The arguments as the shell gave them, quoted where they hold anything but plain characters.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string argument, line;
  while (std::getline(file, argument, '\0')) {
    const bool plain = !argument.empty() && argument.find_first_of(" \t\n'\"\\$*?()[]{}<>|&;#~`!") == std::string::npos;
    if (!plain)
      for (std::size_t at = 0; (at = argument.find('\'', at)) != std::string::npos; at += 4)
        argument.replace(at, 1, "'\\''");
    line += (line.empty() ? "" : " ") + (plain ? argument : "'" + argument + "'");
  }
  return line;
}

std::string petsc_options() {
  char* text = nullptr;
  petsc::check(PetscOptionsGetAll(nullptr, &text));
  std::string options = text ? text : "";
  petsc::check(PetscFree(text));
  options.erase(options.find_last_not_of(' ') + 1);
  return options;
}

}  // namespace

std::string blas_name(const std::string& file) {
  for (const char* name : {"openblas", "mkl", "blis", "atlas"})
    if (file.find(name) != std::string::npos) return name;
  return file.find("/blas/libblas") != std::string::npos ? "reference" : "unknown";
}

nlohmann::ordered_json provenance(MPI_Comm comm) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::string blas = blas_file();
  return {{"floe", {{"version", FLOE_VERSION}, {"commit", FLOE_COMMIT}}},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))},
          {"command", command_line()},
          {"petsc_options", petsc_options()},
          {"ranks", ranks},
          {"cores", std::thread::hardware_concurrency()},
          {"petsc", petsc_version()},
          {"slepc", slepc_version()},
          {"mpi", mpi_version()},
          {"hdf5", hdf5_version()},
          {"blas", {{"name", blas_name(blas)}, {"file", blas}, {"kernel", petsc::blas_kernel()}}}};
}

}  // namespace floe::output
