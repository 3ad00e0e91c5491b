#pragma once
#include <mpi.h>
#include <petscsys.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

/// A folder that all ranks share for the time of a test case.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "floe-output-XXXXXX").string();
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);
    if (rank_ == 0 && !mkdtemp(name.data())) throw std::runtime_error("no scratch folder");
    MPI_Bcast(name.data(), static_cast<int>(name.size()), MPI_CHAR, 0, PETSC_COMM_WORLD);
    path_ = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    MPI_Barrier(PETSC_COMM_WORLD);
    std::error_code ignored;
    if (rank_ == 0) std::filesystem::remove_all(path_, ignored);
  }
  operator const std::filesystem::path&() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  int rank() const { return rank_; }

 private:
  int rank_ = 0;
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// All ranks meet, so that what rank 0 did to the file system is there for the others.
inline void meet() { MPI_Barrier(PETSC_COMM_WORLD); }
