#pragma once
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "floe/error.h"
#include "floe/mesh/raw_mesh.h"
#include "structures.h"

namespace floe::testing {

/// Rank 0 writes a file into a folder of this run; all ranks learn its path. Collective.
inline std::string written(const std::string& name, const std::string& content) {
  int process = getpid();
  MPI_Bcast(&process, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  const auto folder = std::filesystem::temp_directory_path() / ("floe_mesh_test_" + std::to_string(process));
  if (this_rank() == 0) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary) << content;
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  return (folder / name).string();
}

/// The text of the InputError that `work` throws, without the folder; it must be the same on every rank. Collective.
template <class Work>
std::string fault_of(Work&& work) {
  std::string text = "nothing was thrown";
  try {
    work();
  } catch (const InputError& error) {
    text = error.what();
  }
  std::string first = text;
  int size = static_cast<int>(first.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  first.resize(size);
  MPI_Bcast(first.data(), size, MPI_CHAR, 0, PETSC_COMM_WORLD);
  CHECK(text == first);
  const auto folder = std::filesystem::temp_directory_path().string() + "/floe_mesh_test_";
  for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder))
    text.erase(at, text.find('/', at + folder.size()) + 1 - at);
  return text;
}

/// All values of all ranks, one rank after the other. Collective.
template <class Value>
std::vector<Value> of_all_ranks(const std::vector<Value>& mine) {
  int bytes = static_cast<int>(mine.size() * sizeof(Value));
  std::vector<int> counts(ranks()), starts(ranks() + 1, 0);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
  std::vector<Value> all(starts.back() / sizeof(Value));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(), starts.data(), MPI_BYTE, PETSC_COMM_WORLD);
  return all;
}

/// The file's numbers of the nodes of a place, ascending, each once. Collective.
inline std::vector<long long> labels_at(const mesh::RawMesh& raw, const std::string& place) {
  const auto labels = of_all_ranks(raw.node_labels);
  const auto found = std::find(raw.places.begin(), raw.places.end(), place);
  REQUIRE(found != raw.places.end());
  std::vector<long long> result;
  for (const PetscInt node : of_all_ranks(raw.place_nodes[found - raw.places.begin()]))
    result.push_back(labels.at(node));
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Area of the shells and length of the lines of a part. Collective.
double measure(const mesh::RawMesh& raw, int part);

}  // namespace floe::testing
