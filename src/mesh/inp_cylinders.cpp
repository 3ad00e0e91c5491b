#include <algorithm>
#include <array>
#include <cmath>

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

void give_orientation(ShellSection& section, const std::string& name) {
  section.orientation = name;
  for (Ply& ply : section.plies) ply.orientation.clear();
}

}  // namespace

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
  std::vector<long long> labels;
  for (const FileCell& cell : mesh.cells)
    if (of_part[cell.part]) labels.insert(labels.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  const auto positions = positions_of(comm, labels, reading);
  std::vector<Variant> mine(mesh.cells.size(), {-1, {}}), own;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const FileCell& cell = mesh.cells[c];
    if (!of_part[cell.part]) continue;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = 0; i < node_count(cell.kind); ++i) {
      const auto at = std::lower_bound(positions.begin(), positions.end(), cell.nodes[i],
                                       [](const auto& one, long long label) { return one.first < label; });
      if (at != positions.end() && at->first == cell.nodes[i]) centre += at->second / node_count(cell.kind);
    }
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
                              " different directions at the centres of their shells");
}

}  // namespace floe::mesh
