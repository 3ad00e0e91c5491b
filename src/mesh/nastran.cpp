#include "floe/mesh/nastran.h"

#include <algorithm>
#include <limits>

#include "deck_file.h"
#include "floe/petsc/error.h"
#include "nas_build.h"
#include "text.h"

namespace floe::mesh {
namespace {

bool ignores(const DeckRequest& request, const std::string& name) {
  return std::any_of(request.ignore.begin(), request.ignore.end(), [&](const auto& one) { return upper(one) == name; });
}

/// Elements that are read, and left out where the scene asks.
bool left_out(const NasCard& card, const DeckRequest& request, NasModel& model) {
  const char* kinds[] = {"CELAS1", "CELAS2", "CBUSH", "CROD", "CTUBE", "CONROD", "RBE3", "CONM1", "CMASS1", "CMASS2"};
  if (std::find(std::begin(kinds), std::end(kinds), card.name) == std::end(kinds) || !ignores(request, card.name))
    return false;
  model.refused.try_emplace(card.name, NasCount{card.where(), 0}).first->second.times++;
  return true;
}

void refuse_cards(const NasModel& model, const DeckRequest& request, std::vector<std::string>& notices,
                  Faults& faults) {
  for (const auto& [name, count] : model.refused) {
    const std::string many = counted(count.times, "card");
    if (ignores(request, name))
      notices.push_back(faults.text_of(count.where) + ": " + many + " " + name + " left out, as the scene asks");
    else
      faults.add(count.where, name + " (" + nas_refusal(name) + ", " + many +
                                  ") is not read; to leave them out: file: {ignore: [" + name + "]}");
  }
  for (const auto& [name, count] : model.unknown) {
    if (ignores(request, name))
      notices.push_back(faults.text_of(count.where) + ": " + counted(count.times, "card") + " " + name +
                        " left out, as the scene asks");
    else
      faults.add(count.where, "card " + in_quotes(name) + " is not known" + suggestion(name, nas_names()) +
                                  (count.times > 1 ? " (" + std::to_string(count.times) + " of them)" : ""));
  }
  for (const auto& [name, count] : model.ignored) {
    const std::string why = nas_reason(name);
    notices.push_back(faults.text_of(count.where) + ": " + name + " is ignored" + (why.empty() ? "" : ": " + why) +
                      " (" + counted(count.times, "card") + ")");
  }
}

void refuse_empty(const NasModel& model, Faults& faults) {
  if (model.grids.empty()) faults.add({0, 1}, "the file has no GRID: is this bulk data of Nastran?");
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<PetscInt>::max());
  if (model.grids.size() > most || model.shells.size() + model.beams.size() > most)
    faults.add({0, 1}, "more than " + std::to_string(most) + " grids or elements");
}

}  // namespace

bool is_nastran(const std::string& path) {
  return path.ends_with(".bdf") || path.ends_with(".nas") || path.ends_with(".dat");
}

DeckFile read_nastran(MPI_Comm comm, const std::string& path, const DeckRequest& request) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Faults faults;
  FileMesh mesh;
  Deck deck;
  std::vector<std::string> notices;
  petsc::agree(comm, [&] {
    NasModel model;
    const NasControl control = each_card(path, faults, [&](const NasCard& card) {
      if (!left_out(card, request, model)) read_nas_card(card, model, faults);
    });
    if (control.lines > 0)
      notices.push_back(faults.text_of(control.where) + ": " + counted(control.lines, "line") +
                        " before BEGIN BULK ignored: the scene says what is computed");
    refuse_cards(model, request, notices, faults);
    refuse_empty(model, faults);
    if (faults.any()) return;
    NasBuild build(model, request, faults, rank, ranks);
    build.build();
    mesh = std::move(build.mesh);
    deck = std::move(build.deck);
    notices.insert(notices.end(), build.notices.begin(), build.notices.end());
  });
  faults.throw_together(comm);
  return deck_file(comm, path, std::move(mesh), std::move(deck), faults, std::move(notices));
}

}  // namespace floe::mesh
