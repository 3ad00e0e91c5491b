#include <set>

#include "fold.h"

namespace floe::generate {
namespace {

void check(const std::vector<NamedPlate>& plates) {
  Checks checks("folded plates");
  checks.require(!plates.empty(), "there is no plate");
  std::set<std::string> names;
  for (const auto& plate : plates) {
    checks.require(!plate.name.empty(), "a plate has no name");
    checks.require(names.insert(plate.name).second, "two plates are called " + plate.name);
  }
  checks.finish();
  for (const auto& plate : plates) check_plate(plate.name, plate.plate);
}

}  // namespace

RawMesh folded_plates(MPI_Comm comm, const std::vector<NamedPlate>& plates) {
  check(plates);
  const Fold fold(plates);
  Recipe recipe{"folded plates", fold.nodes(), fold.cells(), {}, {}};
  for (std::size_t p = 0; p < plates.size(); ++p) {
    recipe.parts.push_back(plates[p].name);
    auto places = plate_places(plates[p].plate, plates[p].name + ".",
                               [&fold, p](GridNode node) { return fold.number(static_cast<int>(p), node); });
    recipe.places.insert(recipe.places.end(), places.begin(), places.end());
  }
  return generated(
      comm, recipe, [&](PetscInt i) { return fold.position(i); }, [&](PetscInt i) { return fold.cell(i); });
}

}  // namespace floe::generate
