#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "floe/mesh/exchange.h"
#include "floe/mesh/labels.h"
#include "floe/petsc/all_ranks.h"
#include "inp_reading.h"
#include "text.h"

namespace floe::mesh {

std::vector<std::pair<long long, Eigen::Vector3d>> positions_of(MPI_Comm comm, const std::vector<long long>& labels,
                                                                const InpReading& reading) {
  const LabelDirectory directory(comm, reading.mesh.node_labels);
  const auto numbers = directory.find(labels);
  std::vector<PetscInt> nodes;
  std::vector<std::pair<long long, Eigen::Vector3d>> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (numbers[i] < 0) continue;
    nodes.push_back(numbers[i]);
    found.emplace_back(labels[i], Eigen::Vector3d::Zero());
  }
  const auto starts = starts_of(comm, static_cast<PetscInt>(reading.mesh.node_labels.size()));
  const auto points = ask<std::array<double, 3>>(
      comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
      [&](PetscInt node) {
        const Eigen::Vector3d& x = reading.mesh.positions[node - starts[reading.rank]];
        return std::array<double, 3>{x[0], x[1], x[2]};
      });
  for (std::size_t i = 0; i < found.size(); ++i) found[i].second = Eigen::Vector3d::Map(points[i].data());
  return found;
}

Eigen::Matrix3d axes_of(const Orientation& o) {
  Eigen::Matrix3d axes;
  axes.col(0) = o.a.normalized();
  axes.col(2) = o.a.cross(o.b).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  if (o.axis == 0) return axes;
  return Eigen::AngleAxisd(o.angle * M_PI / 180, axes.col(o.axis - 1)) * axes;
}

namespace {

/// A part and the direction of angle 0 of an element of it, rounded so that equal ones are the same.
struct Variant {
  int part;
  std::array<double, 3> direction;
  auto operator<=>(const Variant&) const = default;
};

/// Where a shell's normal is about the local axis n, its direction 1 is the next one (2 for 1, 3 for 2, 1 for 3),
/// rotated about n. Source: Abaqus Analysis User's Guide, Orientations.
std::array<double, 3> direction_at(const InpCylinder& of, const Eigen::Vector3d& x) {
  std::array<Eigen::Vector3d, 3> axes;
  axes[2] = (of.b - of.a).normalized();
  axes[0] = x - of.a;
  axes[0] -= axes[2] * axes[2].dot(axes[0]);
  axes[0].normalize();  // zero where x is on the axis
  axes[1] = axes[2].cross(axes[0]);
  const int n = of.normal - 1;
  const Eigen::Vector3d d = Eigen::AngleAxisd(of.angle * M_PI / 180, axes[n]) * axes[(n + 1) % 3];
  const auto rounded = [](double c) { return std::round(c * 1e10) / 1e10 + 0.0; };
  return {rounded(d[0]), rounded(d[1]), rounded(d[2])};
}

/// The cylinder that a section names, itself or in its plies; null: none.
const InpCylinder* cylinder_of(const ShellSection& section, const InpReading& reading) {
  std::string name = section.orientation;
  for (const Ply& ply : section.plies)
    if (name.empty()) name = ply.orientation;
  for (const InpCylinder& cylinder : reading.cylinders)
    if (!name.empty() && upper(cylinder.name) == upper(name)) return &cylinder;
  return nullptr;
}

bool is_isotropic(const ShellSection& section, const InpReading& reading) {
  return std::all_of(section.plies.begin(), section.plies.end(), [&](const Ply& ply) {
    return std::none_of(reading.deck.materials.begin(), reading.deck.materials.end(), [&](const Material& material) {
      return upper(material.name) == upper(ply.material) && material.elasticity != Elasticity::isotropic;
    });
  });
}

/// Positions of the nodes of cells of some parts. Collective.
class Corners {
 public:
  template <class Asked>
  Corners(MPI_Comm comm, const InpReading& reading, const Asked& asked) {
    std::vector<long long> labels;
    for (const FileCell& cell : reading.mesh.cells)
      if (asked(cell.part)) labels.insert(labels.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    positions_ = positions_of(comm, labels, reading);
  }
  /// Of a node that is not defined, which is a fault elsewhere: zero.
  Eigen::Vector3d at(const FileCell& cell, int node) const {
    const auto found = std::lower_bound(positions_.begin(), positions_.end(), cell.nodes[node],
                                        [](const auto& one, long long label) { return one.first < label; });
    const bool known = found != positions_.end() && found->first == cell.nodes[node];
    return known ? found->second : Eigen::Vector3d::Zero().eval();
  }
  Eigen::Vector3d normal(const FileCell& cell) const {
    const bool triangle = cell.kind == CellKind::triangle || cell.kind == CellKind::triangle6;
    const Eigen::Vector3d a = triangle ? at(cell, 1) - at(cell, 0) : at(cell, 2) - at(cell, 0),
                          b = triangle ? at(cell, 2) - at(cell, 0) : at(cell, 3) - at(cell, 1);
    return a.cross(b).normalized();
  }

 private:
  std::vector<std::pair<long long, Eigen::Vector3d>> positions_;
};

void give_orientation(ShellSection& section, const std::string& name) {
  section.orientation = name;
  for (Ply& ply : section.plies) ply.orientation.clear();
}

/// The orientation from which the angles of a section's plies count; "": none is named.
std::string base_of(const ShellSection& section) {
  if (!section.orientation.empty()) return section.orientation;
  const auto named =
      std::find_if(section.plies.begin(), section.plies.end(), [](const Ply& ply) { return !ply.orientation.empty(); });
  return named == section.plies.end() ? "" : named->orientation;
}

/// Whether plies have orientations of different names, or some have none where the section has none.
bool names_others(const ShellSection& section) {
  return std::any_of(section.plies.begin(), section.plies.end(), [&](const Ply& ply) {
    return ply.orientation.empty() ? section.orientation.empty() && !base_of(section).empty()
                                   : upper(ply.orientation) != upper(base_of(section));
  });
}

/// null: none that is rectangular.
const Orientation* rectangular(const std::string& name, const InpReading& reading) {
  for (const Orientation& one : reading.deck.orientations)
    if (upper(one.name) == upper(name)) return &one;
  return nullptr;
}

/// Angles of the plies from the first axis of `base` about a normal along its third one, or against it (side -1).
/// @return why they have none; empty: they are set
std::string set_angles(ShellSection& section, int side, const InpReading& reading) {
  const Orientation* base = rectangular(base_of(section), reading);
  for (Ply& ply : section.plies) {
    if (ply.orientation.empty() && section.orientation.empty()) return "and one has none, where the section has none";
    if (ply.orientation.empty()) continue;
    const Orientation* own = rectangular(ply.orientation, reading);
    if (!base || !own) return "one of which is cylindrical";
    const Eigen::Matrix3d from = axes_of(*base), to = axes_of(*own);
    if (std::abs(from.col(2).dot(to.col(2))) < 1 - 1e-9) return "whose third axes are not parallel";
    const double sine = side * from.col(2).dot(from.col(0).cross(to.col(0)));
    ply.angle = std::atan2(sine, from.col(0).dot(to.col(0))) * 180 / M_PI;
  }
  give_orientation(section, base->name);
  return "";
}

}  // namespace

void assign_ply_angles(MPI_Comm comm, InpReading& reading) {
  std::map<int, ShellSection*> of_part;
  for (ShellSection& section : reading.deck.shell_sections)
    if (names_others(section) && is_isotropic(section, reading))
      give_orientation(section, "");
    else if (names_others(section))
      of_part[section.number] = &section;
  if (of_part.empty()) return;
  const Corners corners(comm, reading, [&](int part) { return of_part.contains(part); });
  for (const auto& [part, section] : of_part) {
    std::array<int, 3> seen{};  // elements along the third axis, against it, otherwise
    const Orientation* base = rectangular(base_of(*section), reading);
    for (const FileCell& cell : reading.mesh.cells) {
      if (cell.part != part || !base) continue;
      const double along = corners.normal(cell).dot(axes_of(*base).col(2));
      seen[along > 1 - 1e-6 ? 0 : along < 1e-6 - 1 ? 1 : 2] = 1;
    }
    MPI_Allreduce(MPI_IN_PLACE, seen.data(), static_cast<int>(seen.size()), MPI_INT, MPI_MAX, comm);
    const std::string why = seen[2] > 0 || (seen[0] > 0 && seen[1] > 0)
                                ? "and the normals of its elements are not all along their third axis"
                                : set_angles(*section, seen[1] > 0 ? -1 : 1, reading);
    const auto use = std::find_if(reading.uses.begin(), reading.uses.end(), [&](const InpUse& one) {
      return one.kind == InpUse::shell && upper(one.set) == upper(section->part);
    });
    if (!why.empty())
      reading.faults.add(use == reading.uses.end() ? Where{0, 1} : use->where,
                         "the plies of set " + section->part + " have orientations of different names, " + why +
                             "; expected one orientation, with angles");
  }
}

void assign_cylinders(MPI_Comm comm, InpReading& reading) {
  if (reading.cylinders.empty()) return;
  auto& mesh = reading.mesh;
  auto& sections = reading.deck.shell_sections;
  std::vector<const InpCylinder*> of_part(mesh.parts.size(), nullptr);
  for (ShellSection& section : sections) {
    const InpCylinder* cylinder = cylinder_of(section, reading);
    if (cylinder && is_isotropic(section, reading))
      give_orientation(section, "");
    else
      of_part[section.number] = cylinder;
  }
  const Corners corners(comm, reading, [&](int part) { return of_part[part] != nullptr; });
  std::vector<Variant> mine(mesh.cells.size(), {-1, {}}), own;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const FileCell& cell = mesh.cells[c];
    if (!of_part[cell.part]) continue;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = 0; i < node_count(cell.kind); ++i) centre += corners.at(cell, i) / node_count(cell.kind);
    mine[c] = {cell.part, direction_at(*of_part[cell.part], centre)};
    own.push_back(mine[c]);
  }
  const auto unique = [](std::vector<Variant>& all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  unique(own);
  std::vector<Variant> variants = petsc::of_all_ranks(comm, own);
  unique(variants);
  const int first = static_cast<int>(mesh.parts.size());
  for (const InpCylinder& one : reading.cylinders)  // of parts that keep no element
    reading.deck.orientations.push_back({one.name, one.b - one.a, (one.b - one.a).unitOrthogonal()});
  for (const Variant& variant : variants) {
    ShellSection section = *std::find_if(sections.begin(), sections.end(),
                                         [&](const ShellSection& one) { return one.number == variant.part; });
    const Eigen::Vector3d direction = Eigen::Vector3d::Map(variant.direction.data());
    if (direction.isZero(0))
      reading.faults.add(of_part[variant.part]->where, "the centre of a shell of set " + section.part +
                                                           " lies on the axis of its cylindrical orientation");
    section.number = static_cast<int>(mesh.parts.size());
    give_orientation(section, of_part[variant.part]->name + " of part " + std::to_string(section.number));
    reading.deck.orientations.push_back({section.orientation, direction, direction.unitOrthogonal()});
    mesh.parts.push_back(std::string(mesh.parts[variant.part]));
    sections.push_back(std::move(section));
  }
  for (std::size_t c = 0; c < mine.size(); ++c)
    if (mine[c].part >= 0)
      mesh.cells[c].part =
          first + static_cast<int>(std::lower_bound(variants.begin(), variants.end(), mine[c]) - variants.begin());
  if (!variants.empty())
    reading.notices.push_back(reading.faults.text_of(reading.cylinders.front().where) +
                              ": cylindrical orientations have " + std::to_string(variants.size()) +
                              " different directions at the centres of their shells; direction 1 is the axis after "
                              "the one about the normal, the tangential one of three where this is radial (Abaqus), "
                              "where CalculiX takes the radial one");
}

}  // namespace floe::mesh
