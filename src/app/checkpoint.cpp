#include "checkpoint.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "floe/mesh/deck.h"
#include "floe/output/provenance.h"
#include "floe/petsc/error.h"

namespace floe::app {

using nlohmann::ordered_json;

namespace {

std::string hash_of(const std::string& bytes) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return fmt::format("{:016x}", sum);
}

std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

constexpr const char* vector_name = "vectors/";

}  // namespace

CheckpointEvery checkpoint_every(const std::string& word) {
  double number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, fault] = std::from_chars(word.data(), end, number);
  const bool seconds = stop + 1 == end && *stop == 's';
  const bool whole = fault == std::errc() && (stop == end || seconds) && std::isfinite(number) && number > 0;
  if (!whole || (!seconds && (number != std::floor(number) || number > 2e9)))
    throw InputError(
        fmt::format("--checkpoint: is {}; expected a number of steps, as 1000, or of seconds, as 60s", word));
  return seconds ? CheckpointEvery{0, number} : CheckpointEvery{static_cast<PetscInt>(number), 0};
}

ordered_json identity_of(const scene::Scene& scene, scene::Formulation formulation, MPI_Comm comm) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  ordered_json identity{{"scene", std::filesystem::absolute(scene.file).lexically_normal().string()},
                        {"formulation", scene::name_of(formulation)},
                        {"petsc_options", output::provenance(comm)["petsc_options"]},
                        {"ranks", ranks}};
  std::set<std::string> files(scene.tables.begin(), scene.tables.end());
  for (const scene::Body& body : scene.bodies) {
    if (body.reduced) files.insert(body.reduced->path);
    if (body.mesh.file)
      for (const std::string& file : mesh::files_of(body.mesh.file->path)) files.insert(file);
  }
  identity["files"].push_back({{"path", scene.file}, {"hash", hash_of(scene.text)}});
  for (const std::string& file : files)
    identity["files"].push_back({{"path", file}, {"hash", hash_of(contents_of(file))}});
  return identity;
}

void check_identity(const ordered_json& of_checkpoint, const ordered_json& now, const std::string& folder) {
  std::vector<std::string> faults;
  const auto differs = [&](const char* key) { return of_checkpoint.at(key) != now.at(key); };
  const auto text = [](const ordered_json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  if (differs("formulation"))
    faults.push_back(fmt::format("--restart {}: the run's formulation was {}; expected the same, not {}", folder,
                                 text(of_checkpoint["formulation"]), text(now["formulation"])));
  if (differs("ranks"))
    faults.push_back(fmt::format("--restart {}: the run had {} ranks; expected the same number, not {}", folder,
                                 text(of_checkpoint["ranks"]), text(now["ranks"])));
  if (differs("petsc_options"))
    faults.push_back(fmt::format("--restart {}: the run had the options \"{}\"; expected the same, not \"{}\"", folder,
                                 text(of_checkpoint["petsc_options"]), text(now["petsc_options"])));
  const ordered_json &then = of_checkpoint.at("files"), &files = now.at("files");
  for (std::size_t i = 0; i < std::max(then.size(), files.size()); ++i)
    if (i >= then.size() || i >= files.size() || then[i]["hash"] != files[i]["hash"])
      faults.push_back(fmt::format("--restart {}: {} has changed since; expected the file used by that run", folder,
                                   text((i < files.size() ? files : then)[i]["path"])));
  if (!faults.empty()) throw InputError(faults);
}

void put_state(const solve::MotionState& state, output::Checkpoint& checkpoint) {
  checkpoint.shared["motion"] = state.numbers;
  checkpoint.shared["events"] = state.events;
  checkpoint.shared["stop"] = {state.stop};
  checkpoint.own["carried"] = state.carried;
  checkpoint.own["carried_of_tangent"] = state.carried_of_tangent;
  int number = 0;
  for (const auto& [name, entries] : state.vectors)
    checkpoint.own[fmt::format("{}{:02}/{}", vector_name, number++, name)] = entries;
}

solve::MotionState state_of(const output::Checkpoint& checkpoint) {
  solve::MotionState state;
  state.numbers = checkpoint.shared.at("motion");
  state.events = checkpoint.shared.at("events");
  state.stop = checkpoint.shared.at("stop").at(0);
  state.carried = checkpoint.own.at("carried");
  state.carried_of_tangent = checkpoint.own.at("carried_of_tangent");
  for (const auto& [name, entries] : checkpoint.own)  // in the order of their numbers
    if (name.starts_with(vector_name)) state.vectors.emplace_back(name.substr(name.rfind('/') + 1), entries);
  return state;
}

}  // namespace floe::app
