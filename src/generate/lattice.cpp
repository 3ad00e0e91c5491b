#include "floe/generate/generate.h"
#include "share.h"

namespace floe::generate {
namespace {

using Corner = std::array<int, 3>;
using Counts = std::array<PetscInt, 3>;

// Beams from corner `from` to corner `to` of every box; one for boxes that share it.
struct Family {
  Corner from, to;
};

constexpr std::array<Family, 3> struts{{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 0, 1}}}};
constexpr std::array<Family, 6> of_faces{{{{0, 0, 0}, {1, 1, 0}},
                                          {{1, 0, 0}, {0, 1, 0}},
                                          {{0, 0, 0}, {1, 0, 1}},
                                          {{1, 0, 0}, {0, 0, 1}},
                                          {{0, 0, 0}, {0, 1, 1}},
                                          {{0, 1, 0}, {0, 0, 1}}}};
constexpr std::array<Family, 4> through{
    {{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {0, 1, 1}}, {{0, 1, 0}, {1, 0, 1}}, {{1, 1, 0}, {0, 0, 1}}}};

std::vector<Family> families(LatticeDiagonals diagonals) {
  std::vector<Family> all(struts.begin(), struts.end());
  if (diagonals != LatticeDiagonals::none) all.insert(all.end(), of_faces.begin(), of_faces.end());
  if (diagonals == LatticeDiagonals::all) all.insert(all.end(), through.begin(), through.end());
  return all;
}

// How often a family is there along an axis: once a box where it spans it, else once a layer of nodes.
PetscInt repeats(const Family& family, const Counts& boxes, int axis) {
  return boxes[axis] + (family.from[axis] == family.to[axis] ? 1 : 0);
}

double total_of(const Family& family, const Counts& boxes) {
  double total = 1;
  for (int axis = 0; axis < 3; ++axis)
    total *= static_cast<double>(boxes[axis]) + (family.from[axis] == family.to[axis] ? 1 : 0);
  return total;
}

Counts unfolded(PetscInt number, PetscInt nx, PetscInt ny) { return {number % nx, number / nx % ny, number / nx / ny}; }

PetscInt node_at(const Counts& boxes, PetscInt i, PetscInt j, PetscInt k) {
  return i + (boxes[0] + 1) * (j + (boxes[1] + 1) * k);
}

Cell cell(const std::vector<Family>& all, const Counts& boxes, PetscInt number) {
  int f = 0;
  for (PetscInt size; number >= (size = static_cast<PetscInt>(total_of(all[f], boxes))); ++f) number -= size;
  const Counts at = unfolded(number, repeats(all[f], boxes, 0), repeats(all[f], boxes, 1));
  const auto node = [&](const Corner& c) { return node_at(boxes, at[0] + c[0], at[1] + c[1], at[2] + c[2]); };
  return {CellKind::line, {node(all[f].from), node(all[f].to), -1, -1}, f < static_cast<int>(struts.size()) ? 0 : 1};
}

PlaceRule face(const Counts& boxes, int axis, bool last) {
  const int second = axis == 0 ? 1 : 0, third = axis == 2 ? 1 : 2;
  const std::string name = std::string(1, "xyz"[axis]) + (last ? "max" : "min");
  return {name, (boxes[second] + 1) * (boxes[third] + 1), [=](PetscInt n) {
            Counts at{};
            at[axis] = last ? boxes[axis] : 0;
            at[second] = n % (boxes[second] + 1);
            at[third] = n / (boxes[second] + 1);
            return node_at(boxes, at[0], at[1], at[2]);
          }};
}

std::vector<PlaceRule> places(const Counts& boxes) {
  std::vector<PlaceRule> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool last : {false, true}) all.push_back(face(boxes, axis, last));
  for (int k = 0; k < 8; ++k) {
    const int x = (k + 1) / 2 % 2, y = k / 2 % 2, z = k / 4;
    all.push_back(single("p" + std::to_string(k + 1), node_at(boxes, x * boxes[0], y * boxes[1], z * boxes[2])));
  }
  return all;
}

}  // namespace

RawMesh lattice(MPI_Comm comm, const Lattice& lattice) {
  Checks checks("lattice");
  const Counts boxes{lattice.nx, lattice.ny, lattice.nz};
  for (int axis = 0; axis < 3; ++axis) {
    checks.at_least(1, std::string("n") + "xyz"[axis], boxes[axis]);
    checks.positive(std::string("unit cell size along ") + "xyz"[axis], lattice.cell[axis]);
  }
  checks.finish();
  const auto all = families(lattice.diagonals);
  double nodes = 1, cells = 0;
  for (const PetscInt n : boxes) nodes *= static_cast<double>(n) + 1;
  for (const auto& family : all) cells += total_of(family, boxes);
  require_countable("lattice", nodes, cells);
  Recipe recipe{"lattice", static_cast<PetscInt>(nodes), static_cast<PetscInt>(cells), {"struts"}, places(boxes)};
  if (lattice.diagonals != LatticeDiagonals::none) recipe.parts.push_back("diagonals");
  const auto position = [&](PetscInt number) {
    const auto [i, j, k] = unfolded(number, boxes[0] + 1, boxes[1] + 1);
    return Eigen::Vector3d(lattice.cell.cwiseProduct(
        Eigen::Vector3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))));
  };
  return generated(comm, recipe, position, [&](PetscInt number) { return cell(all, boxes, number); });
}

}  // namespace floe::generate
