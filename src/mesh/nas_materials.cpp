#include <cmath>

#include "nas_reader.h"
#include "text.h"

namespace floe::mesh {

void read_mat1(NasReader& r) {
  const auto& card = r.card.card;
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT1_", id), Elasticity::isotropic, {}, r.card.real(4, "a density", 0)}, 0, r.where()};
  double e = r.card.real(1, "E", 0), g = r.card.real(2, "G", 0), nu = r.card.real(3, "nu", 0);
  if (e == 0 && g == 0) {
    const std::string name = "MAT1 without E and G";
    r.count_ignored(name);
    return r.define(r.model.other_materials, id, std::string(name), "material");
  }
  const int given = !card.blank(1) + !card.blank(2) + !card.blank(3);
  if (given < 2 && !(given == 1 && !card.blank(1))) r.card.refuse(1, "to 4 expect two of E, G and nu");
  if (card.blank(1)) e = 2 * g * (1 + nu);
  if (card.blank(3) && !card.blank(2)) nu = e / (2 * g) - 1;
  if (card.blank(2)) g = e / (2 * (1 + nu));
  if (r.card.good() && !(e > 0 && g > 0)) r.card.refuse(1, "to 4 expect E and G greater than 0");
  const bool of_shells = nu > -1 && nu <= 0.5;  // beams need no more than E and G
  if (r.card.good() && !of_shells && (card.blank(1) || card.blank(2)))
    r.card.refuse(3, "expects nu between -1 and 1/2, found " + std::to_string(nu));
  if (found.material.density < 0) r.card.refuse(4, "expects a density that is not negative");
  if (r.card.real(7, "GE", 0) != 0) r.count_ignored("GE");
  found.material.constants = {e, nu};
  found.shear = g;
  if (of_shells && std::abs(2 * g * (1 + nu) / e - 1) > 0.01) r.count_ignored("MAT1 G");
  r.define(r.model.materials, id, std::move(found), "material");
}

void read_mat8(NasReader& r) {
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT8_", id), Elasticity::lamina, {}, r.card.real(7, "a density", 0)}, 0, r.where()};
  const double e1 = r.card.positive(1, "E1"), e2 = r.card.positive(2, "E2"), nu = r.card.real(3, "nu12");
  const double g = r.card.positive(4, "G12");
  found.material.constants = {e1, e2, nu, g, r.card.real(5, "G1Z", g), r.card.real(6, "G2Z", g)};
  if (r.card.real(16, "GE", 0) != 0) r.count_ignored("GE");
  if (found.material.density < 0) r.card.refuse(7, "expects a density that is not negative");
  if (r.card.good() && !(nu * nu < e1 / e2)) r.card.refuse(3, "expects nu12^2 < E1 / E2");
  r.define(r.model.materials, id, std::move(found), "material");
}

void read_mat2(NasReader& r) {
  const long long id = r.card.integer(0, "the material's number");
  NasMaterial found{{r.named("MAT2_", id), Elasticity::lamina, {}, r.card.real(7, "a density", 0)}, 0, r.where()};
  const double g11 = r.card.positive(1, "G11"), g12 = r.card.real(2, "G12", 0), g22 = r.card.positive(4, "G22"),
               g33 = r.card.positive(6, "G33");
  for (int i : {3, 5})
    if (r.card.real(i, "G13 or G23", 0) != 0) r.card.refuse(i, "is not 0: materials are orthotropic in their own axes");
  if (r.card.real(12, "GE", 0) != 0) r.count_ignored("GE");
  if (found.material.density < 0) r.card.refuse(7, "expects a density that is not negative");
  if (r.card.good() && !(g11 * g22 > g12 * g12)) r.card.refuse(2, "expects G12^2 < G11 G22");
  if (!r.card.good()) return;
  const double e1 = g11 - g12 * g12 / g22, e2 = g22 - g12 * g12 / g11;
  found.material.constants = {e1, e2, g12 / g22, g33, g33, g33};
  r.define(r.model.materials, id, std::move(found), "material");
}

/// MAT3, MAT9 and others: of solids, which a deck may have beside.
void read_other_material(NasReader& r) {
  const long long id = r.card.integer(0, "the material's number");
  r.define(r.model.other_materials, id, r.card.card.name, "material");
  r.count_ignored(r.card.card.name);
}

}  // namespace floe::mesh
