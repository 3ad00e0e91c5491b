#include "floe/error.h"
#include "floe/petsc/error.h"
#include "grid.h"

namespace floe::generate {
namespace {

// Position of a node, checked: where u closes and at the poles the map gives one point.
class Surface {
 public:
  Surface(const MappedGrid& given, const Grid& grid) : given_(given), grid_(grid) {}

  Eigen::Vector3d at(GridNode node) const {
    const double half = node.centre ? 0.5 : 0, nv = static_cast<double>(grid_.nv);
    const double v = (static_cast<double>(node.j) + half) / nv;
    Eigen::Vector3d x = at((static_cast<double>(node.i) + half) / static_cast<double>(grid_.nu), v);
    const bool bottom = grid_.pole_bottom && node.j == 0, top = grid_.pole_top && node.j == grid_.nv;
    if (bottom || top) {
      const double step = (x - at(0, v + (bottom ? 1 : -1) / nv)).norm();
      for (const double u : {1 / 3., 1 / 2., 1.})
        require_one(x, at(u, v), step, bottom ? "v = 0 is not a pole" : "v = 1 is not a pole");
    } else if (grid_.closed && node.i == 0 && !node.centre) {
      const double step = (x - at(1 / static_cast<double>(grid_.nu), v)).norm();
      require_one(x, at(1, v), step, "u = 0 and u = 1 do not coincide");
    }
    return x;
  }

 private:
  Eigen::Vector3d at(double u, double v) const {
    Eigen::Vector3d x = given_.position(u, v);
    if (!x.allFinite())
      throw InputError("shell: position(" + std::to_string(u) + ", " + std::to_string(v) +
                       ") has coordinates that are not finite");
    return x;
  }
  static void require_one(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double step, const char* text) {
    constexpr double same = 1e-6;  // of the length of a cell
    if (!((a - b).norm() <= same * step)) throw InputError(std::string("shell: ") + text);
  }

  const MappedGrid& given_;
  const Grid& grid_;
};

}  // namespace

RawMesh shell_of(MPI_Comm comm, const MappedGrid& given) {
  const Grid grid{given.nu, given.nv, given.cells, given.diagonals, given.closed_u, given.pole_bottom, given.pole_top};
  Checks checks("shell");
  check_grid(checks, grid, "nu", "nv");
  checks.require(static_cast<bool>(given.position), "there is no position(u, v)");
  checks.finish();
  require_countable("shell", node_total(grid), cell_total(grid));
  const auto number = [grid](GridNode node) { return number_of(grid, node); };
  const Recipe recipe{"shell",
                      static_cast<PetscInt>(node_total(grid)),
                      static_cast<PetscInt>(cell_total(grid)),
                      {given.part},
                      edge_places(grid, "", number)};
  RawMesh mesh;
  const Surface surface(given, grid);
  petsc::agree(comm, [&] {
    mesh = generated(
        comm, recipe, [&](PetscInt i) { return surface.at(node_of(grid, i)); },
        [&](PetscInt i) { return numbered(cell_of(grid, i), 0, number); });
  });
  return mesh;
}

}  // namespace floe::generate
