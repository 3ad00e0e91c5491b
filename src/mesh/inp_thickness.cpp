#include <algorithm>

#include "corner_thickness.h"
#include "deck_file.h"
#include "floe/mesh/labels.h"
#include "floe/petsc/all_ranks.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

struct Given {
  long long label;
  int line;  // of those in the deck: a later one overrides
  double value;
};

/// What each node has, ascending by label, the same on all ranks. Collective.
std::vector<Given> given_thicknesses(MPI_Comm comm, InpReading& reading) {
  std::vector<Given> mine;
  for (std::size_t i = 0; i < reading.thicknesses.size(); ++i) {
    const auto& one = reading.thicknesses[i];
    const int line = static_cast<int>(i);
    if (const auto label = number<long long>(one.nodes)) {
      if (reading.rank == 0) mine.push_back({*label, line, one.value});
      continue;
    }
    const int set = reading.node_sets.find(reading.scopes.own(one.nodes, InpName::nodes));
    if (set < 0) {
      reading.faults.add(
          one.where, "there is no node set " + in_quotes(one.nodes) + suggestion(one.nodes, reading.node_sets.names()));
      continue;
    }
    for (const long long label : reading.mesh.places[set].labels) mine.push_back({label, line, one.value});
  }
  std::vector<Given> all = petsc::of_all_ranks(comm, mine);
  std::sort(all.begin(), all.end(),
            [](const Given& a, const Given& b) { return std::pair(a.label, -a.line) < std::pair(b.label, -b.line); });
  all.erase(std::unique(all.begin(), all.end(), [](const Given& a, const Given& b) { return a.label == b.label; }),
            all.end());
  return all;
}

/// A part and the thickness of an element of it.
struct Variant {
  int part;
  CornerThickness thickness;
  auto operator<=>(const Variant&) const = default;
};

}  // namespace

void assign_thicknesses(MPI_Comm comm, InpReading& reading) {
  if (reading.thicknesses.empty()) return;
  if (reading.nodal.empty()) {
    reading.notices.push_back(reading.faults.text_of(reading.thicknesses.front().where) +
                              ": *NODAL THICKNESS is ignored: no *SHELL SECTION has NODAL THICKNESS");
    return;
  }
  const std::vector<Given> given = given_thicknesses(comm, reading);
  auto& mesh = reading.mesh;
  auto& sections = reading.deck.shell_sections;
  const auto section_of = [&](int part) {
    return std::find_if(sections.begin(), sections.end(), [&](const auto& s) { return s.number == part; });
  };
  std::vector<Variant> mine(mesh.cells.size(), {-1, {0}});
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& cell = mesh.cells[c];
    const auto section = section_of(cell.part);
    const bool asked = std::count(reading.nodal.begin(), reading.nodal.end(), cell.part) > 0;
    if (section == sections.end() || section->plies.size() != 1 || !asked) continue;
    std::vector<double> corners;
    bool any = false;
    for (int i = 0; i < corner_count(cell.kind); ++i) {
      const auto at = std::lower_bound(given.begin(), given.end(), cell.nodes[i],
                                       [](const Given& g, long long label) { return g.label < label; });
      const bool has = at != given.end() && at->label == cell.nodes[i];
      any = any || has;
      corners.push_back(has ? at->value : section->plies[0].thickness);
    }
    if (any) mine[c] = {cell.part, corner_thickness(corners)};
  }
  std::vector<Variant> own;
  long long elements = 0;
  for (const auto& variant : mine)
    if (variant.part >= 0) own.push_back(variant), ++elements;
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  std::vector<Variant> variants = petsc::of_all_ranks(comm, own);
  std::sort(variants.begin(), variants.end());
  variants.erase(std::unique(variants.begin(), variants.end()), variants.end());
  MPI_Allreduce(MPI_IN_PLACE, &elements, 1, MPI_LONG_LONG, MPI_SUM, comm);
  const int first = static_cast<int>(mesh.parts.size());
  for (const auto& variant : variants) {
    ShellSection section = *section_of(variant.part);
    section.number = static_cast<int>(mesh.parts.size());
    section.plies[0].thickness = variant.thickness.mean;
    section.taper = variant.thickness.taper, section.thickest = variant.thickness.thickest;
    mesh.parts.push_back(std::string(mesh.parts[variant.part]));
    sections.push_back(std::move(section));
  }
  for (std::size_t c = 0; c < mine.size(); ++c)
    if (mine[c].part >= 0)
      mesh.cells[c].part =
          first + static_cast<int>(std::lower_bound(variants.begin(), variants.end(), mine[c]) - variants.begin());
  reading.notices.push_back(reading.faults.text_of(reading.thicknesses.front().where) +
                            ": *NODAL THICKNESS: " + counted(elements, "shell") +
                            " with the mean thickness of the corners (in bending of its cube), " +
                            std::to_string(variants.size()) + " different");
}

}  // namespace floe::mesh
