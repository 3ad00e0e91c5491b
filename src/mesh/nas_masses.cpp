#include "nas_reader.h"

namespace floe::mesh {

/// The lower triangle of a mass matrix of the six motions of a grid, row by row.
void read_conm1(NasReader& r) {
  NasMassMatrix found{r.card.integer(1, "a grid"), std::max(0LL, r.card.integer(2, "axes (CID)", 0)),
                      "CONM1 " + std::to_string(r.card.integer(0, "the element's number")), r.where()};
  std::size_t field = 3;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j)
      found.matrix(i, j) = found.matrix(j, i) = r.card.real(field++, "a term of the mass matrix", 0);
  if (r.card.good()) r.model.mass_matrices.push_back(found);
}

void read_pmass(NasReader& r) {
  for (const std::size_t first : {0, 2, 4, 6}) {
    if (r.card.card.blank(first)) continue;
    const long long id = r.card.integer(first, "the property's number");
    r.define(r.model.scalar_masses, id, r.card.real(first + 1, "a mass"), "property");
  }
}

/// A mass of one component of a grid; the other end, if any, is ground.
void read_cmass(NasReader& r) {
  const auto& card = r.card.card;
  NasScalarMass mass{r.card.integer(0, "the element's number"), card.name, 0, 0, 0, 0, r.where()};
  if (card.name == "CMASS1")
    mass.property = card.blank(1) ? mass.id : r.card.integer(1, "a property");
  else
    mass.mass = r.card.real(1, "a mass");
  const long long a = r.card.integer(2, "a grid", 0), b = r.card.integer(4, "a grid", 0);
  if (a > 0 && b > 0)
    r.card.refuse_card(
        "couples two degrees of freedom, which the mass of a rigid body does not; expected one grid, or CONM2");
  const std::size_t field = a > 0 ? 2 : 4;
  mass.grid = a > 0 ? a : b;
  const long long component = r.card.integer(field + 1, "a component (1 to 6)", 0);
  if (r.card.good() && (mass.grid <= 0 || component < 1 || component > 6))
    r.card.refuse(field + 1, "expects a component from 1 to 6 of a grid (scalar points are not read)");
  mass.component = static_cast<int>(component);
  if (r.card.good()) r.model.component_masses.push_back(mass);
}

}  // namespace floe::mesh
