#include <fmt/format.h>

#include <filesystem>

#include "readers.h"

namespace floe::scene {
namespace {

void read_file(Document& document, ReducedSpec& reduced) {
  std::error_code ignored;
  if (!std::filesystem::exists(reduced.path, ignored)) {
    document.fault(reduced.where, fmt::format("there is no file \"{}\"", reduced.path),
                   "a file written by `floe reduce`, relative to the folder of the scene");
    return;
  }
  try {
    reduced.file = document.reduced_file(reduced.path);
  } catch (const InputError& error) {
    document.fault(reduced.where, error.what());
    return;
  }
  const int dimension = reduced.file->dimension;
  if (dimension == document.dimension) return;
  document.fault(reduced.where, fmt::format("\"{}\" contains a planar body, and the scene is spatial", reduced.path),
                 "bodies that are all planar, or all spatial");
  reduced.file = nullptr;
}

void refuse_deformation(Document& document, Reading& body) {
  const auto initial = body.value("initial");
  if (!initial || !initial->node.IsMap()) return;
  Reading reading(document, *initial, "initial");
  for (const char* key : {"deformation", "deformation_rate"})
    if (reading.given(key))
      document.fault(reading.where(key), "does not apply to a body from a file", "this key only with a mesh");
}

}  // namespace

Body read_reduced(Document& document, const std::string& name, Reading& reading) {
  Body body;
  body.name = name;
  body.where = reading.where();
  const std::size_t before = document.fault_count();
  body.reduced = ReducedSpec{reading.text("reduced"), nullptr, reading.where("reduced")};
  for (const Key& key : schema_section("body").keys)
    if (key.name != "reduced" && key.name != "initial" && reading.given(key.name))
      document.fault(reading.where(key.name), "does not apply together with reduced", "this key only with a mesh");
  if (body.reduced->path.empty()) {
    if (document.fault_count() == before)
      document.fault(body.reduced->where, "is empty", "a file written by `floe reduce`");
    return body;
  }
  body.reduced->path = document.beside(body.reduced->path);
  read_file(document, *body.reduced);
  if (!body.reduced->file) return body;  // nothing is known that the rest could be judged by
  const std::size_t sound = document.fault_count();
  body.initial = read_initial(document, reading);
  if (document.fault_count() == sound) refuse_deformation(document, reading);
  return body;
}

}  // namespace floe::scene
