#include "deck_file.h"

#include <algorithm>

#include "floe/error.h"
#include "floe/mesh/nastran.h"
#include "inp_blocks.h"
#include "nas_cards.h"

namespace floe::mesh {

int next_part(const Deck& deck) { return static_cast<int>(deck.shell_sections.size() + deck.beam_sections.size()); }

std::vector<std::string> files_of(const std::string& path) {
  Faults faults;
  try {
    if (path.ends_with(".inp")) inp_blocks(path, faults);
    if (is_nastran(path)) each_card(path, faults, [](const NasCard&) {});
  } catch (const InputError&) {  // of whoever reads them
  }
  std::vector<std::string> files{path};
  for (const std::string& file : faults.files())
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  return files;
}

DeckFile deck_file(MPI_Comm comm, const std::string& path, FileMesh mesh, Deck deck, Faults& faults,
                   std::vector<std::string> notices) {
  Numbered numbered = number_labels(comm, std::move(mesh), faults);
  if (numbered.mesh.cell_count == 0) throw InputError(path + ": the deck has no beams or shells");
  numbered.mesh.source = path;
  if (numbered.dropped > 0)
    notices.push_back(path + ": " + std::to_string(numbered.dropped) + " unused nodes are ignored");
  for (auto& mass : deck.masses) mass.node = numbered.mentioned[mass.node];
  for (auto& spring : deck.springs)
    for (auto& node : spring.nodes) node = numbered.mentioned[node];
  for (auto& link : deck.links) {
    link.reference = numbered.mentioned[link.reference];
    for (auto& node : link.nodes) node = numbered.mentioned[node];
  }
  return {std::move(numbered.mesh), std::move(deck), std::move(notices)};
}

}  // namespace floe::mesh
