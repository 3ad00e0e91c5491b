#include "floe/fem/congruence.h"

#include <algorithm>
#include <cmath>

#include "floe/petsc/values.h"

namespace floe::fem {
namespace {

constexpr double round_off = 1e-12;

template <class A, class B>
bool near(const A& a, const B& b) {
  return (a - b).norm() <= round_off * std::max(a.norm(), b.norm());
}

bool same(const BeamSection& a, const BeamSection& b) {
  return a.EA == b.EA && a.EI == b.EI && a.rhoA == b.rhoA && a.rhoI == b.rhoI && a.GA == b.GA;
}

bool same(const SpatialBeam& a, const SpatialBeam& b) {
  const SpatialBeamSection &s = a.section, &t = b.section;
  return s.EA == t.EA && s.EIy == t.EIy && s.EIz == t.EIz && s.EIyz == t.EIyz && s.GJ == t.GJ && s.rhoA == t.rhoA &&
         s.rhoIy == t.rhoIy && s.rhoIz == t.rhoIz && s.rhoIyz == t.rhoIyz && s.centroid == t.centroid &&
         s.shear_centre == t.shear_centre && s.GA == t.GA && near(a.orientation, b.orientation) &&
         a.strain.membrane == b.strain.membrane && a.strain.wagner == b.strain.wagner &&
         a.strain.strains == b.strain.strains && a.releases == b.releases && a.alone == b.alone;
}

bool same(const ShellSection& a, const ShellSection& b) {
  return a.A == b.A && a.coupling == b.coupling && a.bending == b.bending && a.shear == b.shear &&
         a.higher_order == b.higher_order && a.mass == b.mass && a.mass_centre == b.mass_centre &&
         a.mass_radius == b.mass_radius && a.strains == b.strains && near(a.axis, b.axis);
}

bool same(const PointMass& a, const PointMass& b) {
  return a.mass == b.mass && near(a.inertia, b.inertia) && near(a.offset, b.offset);
}

bool same(const NodeSpring& a, const NodeSpring& b) {
  return a.stiffness == b.stiffness && near(a.axes, b.axes) && a.at == b.at && a.kind == b.kind;
}

bool same(const Section& a, const Section& b) {
  return a.index() == b.index() &&
         std::visit([&](const auto& s) { return same(s, std::get<std::decay_t<decltype(s)>>(b)); }, a);
}

bool same(const Mesh::Cell& a, const Mesh::Cell& b) {
  return a.kind == b.kind && a.part == b.part && a.place == b.place && a.moving == b.moving && a.line == b.line &&
         std::equal(a.nodes().begin(), a.nodes().end(), b.nodes().begin());
}

bool same_numbering(const Mesh& a, const Mesh& b) {
  return a.dimension == b.dimension && a.node_count == b.node_count && a.cell_count == b.cell_count &&
         a.first_node == b.first_node && a.owned_nodes == b.owned_nodes && a.foreign == b.foreign &&
         a.original == b.original && a.positions.size() == b.positions.size() && a.cells.size() == b.cells.size();
}

bool same_followers(const Mesh& a, const Mesh& b, bool rotates) {
  return std::equal(a.dependent_nodes.begin(), a.dependent_nodes.end(), b.dependent_nodes.begin(),
                    b.dependent_nodes.end(),
                    [](const auto& f, const auto& g) {
                      return f.node == g.node && f.independent_node == g.independent_node;
                    }) &&
         std::equal(a.spins.begin(), a.spins.end(), b.spins.begin(), b.spins.end(), [&](const auto& s, const auto& t) {
           return !rotates && s.node == t.node && s.others == t.others && near(s.axis, t.axis);
         });
}

}  // namespace

bool congruent(const Structure& a, const Structure& b, const Placement& placement) {
  if (a.dofs_per_node != b.dofs_per_node || a.strain != b.strain || a.sections.size() != b.sections.size())
    return false;
  if (!same_numbering(a.mesh, b.mesh) || !same_followers(a.mesh, b.mesh, placement.rotates)) return false;
  const auto same_cell = [](const Mesh::Cell& c, const Mesh::Cell& d) { return same(c, d); };
  if (!std::equal(a.mesh.cells.begin(), a.mesh.cells.end(), b.mesh.cells.begin(), same_cell)) return false;
  const Eigen::Matrix3d back = placement.rotation.transpose();
  for (std::size_t i = 0; i < a.sections.size(); ++i)
    if (!same(placement.rotates ? rotated(a.sections[i], back) : a.sections[i], b.sections[i])) return false;
  double size = placement.translation.norm();
  for (const Eigen::Vector3d& x : b.mesh.positions) size = std::max(size, x.norm());
  for (std::size_t i = 0; i < a.mesh.positions.size(); ++i) {
    const Eigen::Vector3d x = placement.rotation * a.mesh.positions[i] + placement.translation;
    if (!((x - b.mesh.positions[i]).norm() <= round_off * size)) return false;
  }
  return true;
}

petsc::VecHandle placed(const Structure& b, const Placement& placement, Vec field) {
  petsc::VecHandle result = fem::field(b);
  petsc::check(VecCopy(field, result));
  if (!placement.rotates) return result;
  petsc::Values values(result);
  for (PetscInt i = 0; i + 3 <= b.owned_dofs(); i += 3) {
    Eigen::Map<Eigen::Vector3d> v(&values[values.first + i]);
    v = (placement.rotation * v).eval();
  }
  return result;
}

}  // namespace floe::fem
