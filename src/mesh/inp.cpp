#include "floe/mesh/inp.h"

#include <algorithm>

#include "deck_file.h"
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

template <class Named>
void spell_as_defined(std::string& name, const std::vector<Named>& defined) {
  for (const auto& one : defined)
    if (upper(one.name) == upper(name)) name = one.name;
}

/// Names do not depend on case: sections get them as materials and orientations are defined.
void spell_names(Deck& deck, const std::vector<Orientation>& orientations) {
  for (ShellSection& section : deck.shell_sections) {
    spell_as_defined(section.orientation, orientations);
    for (Ply& ply : section.plies) {
      spell_as_defined(ply.material, deck.materials);
      spell_as_defined(ply.orientation, orientations);
    }
  }
  for (BeamSection& section : deck.beam_sections) spell_as_defined(section.material, deck.materials);
}

void refuse_incomplete(const InpBlocks& deck, InpReading& reading) {
  auto& faults = reading.faults;
  refuse_unnamed(reading.materials_used, reading.deck.materials, "material", faults);
  std::vector<Orientation> orientations = reading.deck.orientations;
  for (const InpCylinder& cylinder : reading.cylinders) orientations.push_back({cylinder.name, {}, {}});
  refuse_unnamed(reading.orientations_used, orientations, "orientation", faults);
  spell_names(reading.deck, orientations);
  for (const char* keyword : {"NODE", "ELEMENT"})
    if (std::none_of(deck.blocks.begin(), deck.blocks.end(), [&](const auto& b) { return b.keyword == keyword; }))
      faults.add({0, 1}, std::string("the deck has no *") + keyword);
}

// Materials that no section names.
void report_unused(const std::string& path, InpReading& reading) {
  std::vector<std::string> unused;
  for (const auto& material : reading.deck.materials)
    if (std::none_of(reading.materials_used.begin(), reading.materials_used.end(),
                     [&](const auto& used) { return upper(used.first) == upper(material.name); }))
      unused.push_back(material.name);
  if (!unused.empty())
    reading.notices.push_back(path + ": " + (unused.size() > 1 ? "materials " : "material ") + listed(unused) +
                              (unused.size() > 1 ? " are" : " is") + " not used by any section");
}

}  // namespace

DeckFile read_inp(MPI_Comm comm, const std::string& path, const DeckRequest& request) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Faults faults;
  InpReading reading{faults, request, rank, ranks, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
                     {},     {},      {},   {},    {}, {}, {}, {}, {}, {}, {}, {}, {}};
  petsc::agree(comm, [&] {
    InpBlocks deck = inp_blocks(path, faults);
    choose_instance(deck, request, faults, reading.notices);
    read_blocks(deck.blocks, reading);
    refuse_incomplete(deck, reading);
    report_ignored(reading);
    report_unused(path, reading);
  });
  faults.throw_together(comm);
  agree_members(comm, reading);
  assign_sections(comm, reading);
  resolve_springs(comm, reading);
  resolve_surfaces(comm, reading);
  add_places(reading);
  resolve_links(comm, reading);
  resolve_equations(comm, reading);
  assign_thicknesses(comm, reading);
  assign_ply_angles(comm, reading);
  assign_cylinders(comm, reading);
  faults.throw_together(comm);
  return deck_file(comm, path, std::move(reading.mesh), std::move(reading.deck), faults, std::move(reading.notices));
}

}  // namespace floe::mesh
