#include "floe/mesh/inp.h"

#include <algorithm>

#include "floe/petsc/error.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

template <class Named>
void refuse_unnamed(const std::vector<std::pair<std::string, Where>>& used, const std::vector<Named>& defined,
                    const char* kind, Faults& faults) {
  std::vector<std::string> names;
  for (const auto& one : defined) names.push_back(one.name);
  for (const auto& [name, where] : used)
    if (std::none_of(names.begin(), names.end(), [&](const auto& other) { return upper(other) == upper(name); }))
      faults.add(where, std::string("there is no ") + kind + " " + in_quotes(name) + suggestion(name, names));
}

void refuse_incomplete(const InpBlocks& deck, InpReading& reading) {
  auto& faults = reading.faults;
  refuse_unnamed(reading.materials_used, reading.deck.materials, "material", faults);
  refuse_unnamed(reading.orientations_used, reading.deck.orientations, "orientation", faults);
  for (const char* keyword : {"NODE", "ELEMENT"})
    if (std::none_of(deck.blocks.begin(), deck.blocks.end(), [&](const auto& b) { return b.keyword == keyword; }))
      faults.add({0, 1}, std::string("the deck has no *") + keyword);
}

Deck finished(InpReading& reading, const Numbered& numbered, const std::vector<double>& masses,
              const std::vector<LinkMentions>& links) {
  Deck deck = std::move(reading.deck);
  for (std::size_t i = 0; i < masses.size(); ++i) deck.masses.push_back({numbered.mentioned[i], masses[i]});
  for (const auto& link : links) {
    auto& nodes = deck.links.emplace_back(RigidLink{numbered.mentioned[link.reference], {}}).nodes;
    for (const auto mention : link.nodes) nodes.push_back(numbered.mentioned[mention]);
  }
  return deck;
}

}  // namespace

InpFile read_inp(MPI_Comm comm, const std::string& path) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Faults faults;
  InpReading reading{faults, rank, ranks, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  petsc::agree(comm, [&] {
    const InpBlocks deck = inp_blocks(path, faults);
    read_blocks(deck.blocks, reading);
    refuse_incomplete(deck, reading);
  });
  faults.throw_together(comm);
  agree_members(comm, reading);
  const auto masses = assign_sections(comm, reading);
  const auto links = resolve_nodes(comm, reading);
  faults.throw_together(comm);
  Numbered numbered = number_labels(comm, std::move(reading.mesh), faults);
  if (numbered.mesh.cell_count == 0) throw InputError(path + ": the deck has no beams or shells");
  numbered.mesh.source = path;
  if (numbered.dropped > 0)
    reading.notices.push_back(path + ": " + std::to_string(numbered.dropped) + " unused nodes are ignored");
  Deck deck = finished(reading, numbered, masses, links);
  return {std::move(numbered.mesh), std::move(deck), std::move(reading.notices)};
}

}  // namespace floe::mesh
