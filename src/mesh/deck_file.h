#pragma once
#include "file_mesh.h"
#include "floe/mesh/deck.h"

namespace floe::mesh {

/// The last step of every reader of decks: numbers nodes and cells, and rotates the nodes of masses and links, which
/// are numbers of mentions of `mesh`, into nodes. Collective.
/// @throws InputError  as number_labels; no cell at all
DeckFile deck_file(MPI_Comm comm, const std::string& path, FileMesh mesh, Deck deck, Faults& faults,
                   std::vector<std::string> notices);

/// Of all sections the number of the next part: sections become parts in the order of the file.
int next_part(const Deck& deck);

}  // namespace floe::mesh
