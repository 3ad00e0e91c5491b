#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "floe/dynamics/pressure_load.h"
#include "floe/fem/pressure.h"
#include "floe/math/nearest.h"
#include "floe/reduction/pressure.h"
#include "spatial_assembly.h"

namespace floe::assembly {
namespace {

using Chosen = std::function<bool(const fem::Mesh::Cell&)>;

[[noreturn]] void refuse_part(const Load& load, const std::string& body, const std::vector<std::string>& parts) {
  const std::string near = math::nearest(load.part, parts);
  throw InputError(fmt::format("{}.part: {} has no part \"{}\"; expected one of {}{}", load.where.text(), body,
                               load.part, fmt::join(parts, ", "),
                               near.empty() ? "" : "; did you mean \"" + near + "\"?"));
}

/// What the file of a body has of the shells that a pressure acts on, for its first k coordinates.
body::Pressure pressure_of_file(const Load& load, const Body& body, Eigen::Index k) {
  const output::ReducedBodyFile& file = *body.reduced->file;
  if (file.pressures.empty())
    throw InputError(
        fmt::format("{}: acts on body {}, whose file {} contains no shells or was written before floe stored "
                    "pressures; expected a file of shells (write it again by floe reduce), or a body with a mesh",
                    load.where.text(), body.name, body.reduced->path));
  const Eigen::Index all = file.body.coordinates();
  body::Pressure sum(all);
  std::vector<std::string> parts;
  bool found = load.part.empty();
  for (const auto& [part, unit] : file.pressures) {
    parts.push_back(part);
    if (!load.part.empty() && part != load.part) continue;
    sum += unit;
    found = true;
  }
  if (!found) refuse_part(load, body.name, parts);
  return k == all ? sum : body::projected(sum, Eigen::MatrixXd::Identity(all, k));
}

/// The shells that a pressure acts on: several parts of a deck have one name where the thickness, offset or orientation
/// of its elements differs. Collective.
Chosen shells_of(const Load& load, const PlannedBody& body) {
  if (!load.part.empty() && std::find(body.parts.begin(), body.parts.end(), load.part) == body.parts.end())
    refuse_part(load, body.spec.name, body.parts);
  const auto named = [parts = body.parts, name = load.part](int part) {
    return name.empty() || parts[static_cast<std::size_t>(part)] == name;
  };
  Chosen chosen = [named](const fem::Mesh::Cell& cell) { return fem::is_shell(cell) && named(cell.part); };
  const fem::Mesh& mesh = body.structure.mesh;
  int any = std::any_of(mesh.cells.begin(), mesh.cells.end(), chosen) ? 1 : 0;
  if (body.spec.piece > 0)  // another frame of the body may have them
    for (std::size_t i = 0; i < body.structure.sections.size(); ++i)
      if (std::holds_alternative<fem::ShellSection>(body.structure.sections[i]) && named(static_cast<int>(i))) any = 1;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mesh.comm);
  if (any == 0)
    throw InputError(fmt::format("{}: {} of body {} has no shells; expected a pressure on shells", load.where.text(),
                                 load.part.empty() ? "the mesh" : "part " + load.part, body.spec.name));
  return chosen;
}

}  // namespace

std::vector<std::unique_ptr<dynamics::Term>> SpatialAssembly::pressure_terms(const Load& load, int b,
                                                                             const std::function<double(double)>& value,
                                                                             const BodyPart* part) {
  using dynamics::PressureLoad;
  std::vector<std::unique_ptr<dynamics::Term>> terms;
  const PlannedBody& body = plan_.bodies[b];
  const auto add = [&](std::vector<int> coordinates, body::Pressure unit) {
    terms.push_back(std::make_unique<PressureLoad>(
        std::move(coordinates), slots_[b].attitude, std::move(unit), value,
        load.follower ? PressureLoad::Kind::follower : PressureLoad::Kind::dead, body.attitude));
  };
  if (body.spec.reduced) {
    body::Pressure unit = pressure_of_file(load, body.spec, reduced_[b].body.coordinates());
    if (owner_) add(coordinates_of(b), std::move(unit));
    return terms;
  }
  const Chosen chosen = [part, all = shells_of(load, body),
                         first = body.structure.mesh.cells.data()](const fem::Mesh::Cell& cell) {
    return all(cell) && (!part || part->cells[static_cast<std::size_t>(&cell - first)] != 0);
  };
  if (compact(b)) {
    const reduction::Basis none;
    body::Pressure unit = reduction::pressure(body.structure, reduced_[b].basis ? *reduced_[b].basis : none, chosen);
    if (owner_ && !coordinates_of(b).empty()) add(coordinates_of(b), std::move(unit));
    return terms;
  }
  for (const fem::Mesh::Cell& cell : body.structure.mesh.cells) {
    if (!chosen(cell)) continue;
    if (slots_[b].corotated) {
      terms.push_back(corotated_pressure(load, b, value, cell));
      continue;
    }
    const reference::FreeDofs free = reference::free_dofs(body.structure, constrained(b), cell, *slots_[b].nodes);
    std::vector<int> coordinates;
    for (int i = 0; i < 6 && !slots_[b].still; ++i) coordinates.push_back(slots_[b].frame + i);
    coordinates.insert(coordinates.end(), free.coordinates.begin(), free.coordinates.end());
    if (!coordinates.empty()) add(coordinates, body::projected(fem::pressure(body.structure, cell), free.V));
  }
  return terms;
}

}  // namespace floe::assembly
