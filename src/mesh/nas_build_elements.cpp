#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "nas_build.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// Rounded, so that parallel directions are the same.
double rounded(double x) { return std::round(x * 1e10) / 1e10 + 0.0; }

}  // namespace

template <class Make>
int NasBuild::part_of(long long property, const Variant& variant, const std::string& name, Make&& make) {
  const auto [at, fresh] = parts_.try_emplace({property, variant}, static_cast<int>(mesh.parts.size()));
  if (!fresh) return at->second;
  constexpr std::size_t most = 20000;
  if (mesh.parts.size() == most)
    faults_.add(
        {0, 1},
        "the elements have more than " + std::to_string(most) +
            " different sections (of tapered beams, each piece for each orientation): give material axes by MCID, "
            "orientations by equal vectors");
  mesh.parts.push_back(name);
  make(at->second);
  return at->second;
}

const NasMaterial* NasBuild::material(long long id, Where where, const std::string& user) {
  const auto found = model_.materials.find(id);
  if (found != model_.materials.end()) {
    used_materials_.push_back(id);
    return &found->second;
  }
  if (const auto other = model_.other_materials.find(id); other != model_.other_materials.end()) {
    const bool bare = other->second.starts_with("MAT1 ");
    faults_.add(where, user + " names material " + std::to_string(id) + ", a " + other->second +
                           (bare ? "" : ", which is not read; use MAT1, MAT8 or MAT2"));
    return nullptr;
  }
  std::vector<std::string> known;
  for (const auto& [number, unused] : model_.materials) known.push_back(std::to_string(number));
  faults_.add(where, user + " names material " + std::to_string(id) + ", which is not defined" +
                         suggestion(std::to_string(id), known));
  return nullptr;
}

template <class Map>
const typename Map::mapped_type* NasBuild::property(const Map& all, long long id, Where where,
                                                    const std::string& element) {
  const auto found = all.find(id);
  if (found != all.end()) {
    used_properties_.push_back(id);
    return &found->second;
  }
  const bool of_shells = model_.shell_properties.contains(id), of_beams = model_.beam_properties.contains(id);
  if (of_shells || of_beams) {
    faults_.add(where, fmt::format("{} names property {}, a property of {}; expected one of {}", element, id,
                                   of_shells ? "shells" : "beams", of_shells ? "beams" : "shells"));
    return nullptr;
  }
  if (scene_has_sections()) return nullptr;
  std::vector<std::string> known;
  for (const auto& [number, unused] : all) known.push_back(std::to_string(number));
  if (known.size() > 10) known.resize(10);
  faults_.add(where, element + " names property " + std::to_string(id) + ", which is not defined" +
                         (known.empty() ? "" : " (" + listed(known) + " are)"));
  return nullptr;
}

bool NasBuild::replaced(const std::string& part) const {
  return std::find(request_.parts.begin(), request_.parts.end(), part) != request_.parts.end();
}

int NasBuild::part_of_scene(CellKind kind, long long property, long long element, bool plain, Where where) {
  if (model_.shell_properties.contains(property) || model_.beam_properties.contains(property)) return -1;  // refused
  const bool beam = is_line(kind);
  const std::string name = (beam ? "PBAR" : "PSHELL") + std::to_string(property);
  if (plain) {
    ++without_property_[name];
    return part_of(beam ? -property : property, {}, name, [](int) {});
  }
  faults_.add(where, fmt::format("element {} is a rod, or has thicknesses, an offset or free ends of its own, which a "
                                 "section of the scene does not have, and property {} is not defined; expected it in "
                                 "the deck",
                                 element, property));
  return -1;
}

/// Whether a direction of the material matters, or of the one that it bends by.
bool NasBuild::has_axes(const NasShellProperty& property) const {
  const auto directed = [&](long long material) {
    const auto found = model_.materials.find(material);
    return found != model_.materials.end() && found->second.material.elasticity != Elasticity::isotropic;
  };
  return (property.bending && directed(*property.bending)) ||
         std::any_of(property.plies.begin(), property.plies.end(),
                     [&](const NasPly& ply) { return directed(ply.material); });
}

/// Direction of angle 0 of a shell's material.
Eigen::Vector3d NasBuild::axis_of(const NasShell& shell) {
  std::vector<Eigen::Vector3d> x;
  for (int i = 0; i < shell.count; ++i) {
    const auto at = frames_.position(shell.nodes[i], shell.where);
    if (!at) return Eigen::Vector3d::UnitX();
    x.push_back(*at);
  }
  if (shell.axes >= 0) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto& at : x) middle += at / shell.count;
    return frames_.directions(shell.axes, middle, shell.where).col(0);
  }
  const Eigen::Vector3d side = x[1] - x[0],
                        normal = shell.count == 3 ? side.cross(x[2] - x[0]) : (x[2] - x[0]).cross(x[3] - x[1]);
  if (!(side.norm() > 0 && normal.norm() > 0)) return Eigen::Vector3d::UnitX();
  return Eigen::AngleAxisd(shell.angle * M_PI / 180, normal.normalized()) * side.normalized();
}

std::string NasBuild::named_material(const NasMaterial& of, double extra_density, const std::string& property) {
  Material material = of.material;
  material.density = material.density * model_.mass_factor + extra_density;
  if (extra_density != 0) material.name += " with the NSM of " + property;
  for (const auto& known : deck.materials)
    if (known.name == material.name) return material.name;
  deck.materials.push_back(material);
  return material.name;
}

const NasMaterial* NasBuild::shell_material(long long id, const NasShellProperty& property) {
  const NasMaterial* found = material(id, property.where, property.name);
  if (!found || found->material.elasticity != Elasticity::isotropic) return found;
  const double nu = found->material.constants[1];
  if (nu > -1 && nu <= 0.5) return found;
  faults_.add(property.where,
              fmt::format("{} names MAT1 {}, whose nu is {:.6g}; expected one between -1 and 1/2 (beams "
                          "alone need no more than E and G)",
                          property.name, id, nu));
  return nullptr;
}

/// Its own, where it has any and the property is not one of plies.
CornerThickness NasBuild::thickness_of(const NasShell& shell, const NasShellProperty& property) {
  const double given = property.plies.front().thickness;
  if (!shell.has_thickness() || property.plies.size() != 1) return {given};
  std::array<double, 4> corners{};
  for (int i = 0; i < shell.count; ++i)
    corners[i] = !shell.thicknesses[i] ? given : shell.ratio ? given * *shell.thicknesses[i] : *shell.thicknesses[i];
  return corner_thickness(std::span<const double>(corners.data(), shell.count));
}

void NasBuild::add_shell_section(const NasShell& shell, const NasShellProperty& property, const CornerThickness& own,
                                 const Eigen::Vector3d& axis, int part) {
  const double thickness = own.mean;
  ShellSection section;
  section.taper = own.taper, section.thickest = own.thickest;
  section.part = property.name;
  section.number = part;
  double total = 0;
  for (const NasPly& ply : property.plies) total += ply.thickness;
  for (const NasPly& ply : property.plies) {
    const NasMaterial* found = shell_material(ply.material, property);
    if (!found) return;
    const bool one = property.plies.size() == 1, differs = one && thickness != total;  // the element's T1 to T4
    const std::string with = differs ? fmt::format("{}, thickness {:.9g}", property.name, thickness) : property.name;
    section.plies.push_back(
        {one ? thickness : ply.thickness,
         named_material(*found, property.extra * model_.mass_factor / (one ? thickness : total), with), "", ply.angle});
  }
  if (property.plies.size() == 1) total = thickness;
  const double middle = shell.offset + (property.bottom ? *property.bottom + total / 2 : 0);
  section.offset = -middle / total;
  if (!axis.isZero(0)) {
    Orientation orientation{"axis " + std::to_string(deck.orientations.size() + 1), axis, axis.unitOrthogonal(), 0, 0};
    section.orientation = orientation.name;
    deck.orientations.push_back(orientation);
  }
  if (property.bends_apart()) {
    const long long id = property.bending.value_or(property.plies.front().material);
    const NasMaterial* bending = shell_material(id, property);
    if (!bending) return;
    section.bending = ShellBending{named_material(*bending, 0, property.name), property.factor};
  }
  deck.shell_sections.push_back(section);
}

int NasBuild::part_without_thickness(const NasShell& shell, const NasShellProperty& property) {
  if (scene_has_sections()) {
    without_thickness_ += !replaced(property.name);
    return part_of(shell.property, {}, property.name, [](int) {});
  }
  faults_.add(shell.where,
              fmt::format("shell {}: neither the element nor {} has a thickness; expected T, T1 to T4, or a "
                          "section of the scene",
                          shell.id, property.name));
  return -1;
}

void NasBuild::add_shells() {
  for (std::size_t i = 0; i < model_.shells.size(); ++i) {
    const NasShell& shell = model_.shells[i];
    const NasShellProperty* own =
        property(model_.shell_properties, shell.property, shell.where, "shell " + std::to_string(shell.id));
    const CellKind kind = shell.count == 3 ? (shell.quadratic ? CellKind::triangle6 : CellKind::triangle)
                                           : (shell.quadratic ? CellKind::quadrilateral8 : CellKind::quadrilateral);
    int part = -1;
    if (own && own->plies.size() == 1 && own->plies[0].thickness == 0 && !shell.has_thickness()) {
      part = part_without_thickness(shell, *own);
    } else if (own) {
      const CornerThickness thickness = thickness_of(shell, *own);
      varying_shells_ += thickness.taper != 1 && !replaced(own->name);
      Eigen::Vector3d axis = Eigen::Vector3d::Zero();
      if (has_axes(*own)) axis = axis_of(shell).unaryExpr([](double x) { return rounded(x); });
      part = part_of(shell.property,
                     {thickness.mean, thickness.taper, thickness.thickest, shell.offset, axis[0], axis[1], axis[2]},
                     own->name, [&](int number) {
                       if (!replaced(own->name)) add_shell_section(shell, *own, thickness, axis, number);
                     });
    } else if (scene_has_sections()) {
      const bool plain = shell.offset == 0 && !shell.has_thickness();
      part = part_of_scene(kind, shell.property, shell.id, plain, shell.where);
    }
    if (part < 0) continue;
    if (!mine(i)) continue;
    auto nodes = no_nodes<long long>();
    std::copy_n(shell.nodes.begin(), shell.count, nodes.begin());
    if (shell.quadratic) std::copy_n(shell.middles.begin(), shell.count, nodes.begin() + shell.count);
    mesh.cells.push_back({shell.id, kind, part, nodes, shell.where});
  }
}

/// The node at the end of a beam, which an offset moves away from the grid.
long long NasBuild::end_of(const NasBeam& beam, const NasGrid& grid, const Eigen::Vector3d& offset,
                           const Eigen::Vector3d& x) {
  if (offset.isZero(0)) return grid.id;
  const auto [at, fresh] =
      extra_of_.try_emplace({static_cast<double>(grid.id), offset[0], offset[1], offset[2]}, next_label_);
  if (fresh) {
    extra_.push_back({next_label_++, x + offset, beam.where});
    const auto found = independent_.find(grid.id);
    extra_links_[found == independent_.end() ? grid.id : found->second].push_back(extra_.size() - 1);
  }
  return at->second;
}

/// A unit vector that is far from parallel to the axis: rods have no other orientation.
static Eigen::Vector3d any_orientation(const Eigen::Vector3d& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return Eigen::Vector3d::Unit(least);
}

/// The orientation vector in basic axes; of G0 its part normal to the axis, which neighbours share.
Eigen::Vector3d NasBuild::orientation_of(const NasBeam& beam, const Ends& ends, const Eigen::Vector3d& axis) {
  if (beam.rod) return any_orientation(axis);
  Eigen::Vector3d v = beam.orientation;
  if (beam.orientation_node > 0) {
    const auto x = frames_.position(beam.orientation_node, beam.where);
    if (!x) return Eigen::Vector3d::Zero();
    v = *x - ends.x[0];
    v -= axis * axis.dot(v);
  } else if (!beam.in_basic) {
    v = frames_.directions(frames_.displacement_axes(*ends.grids[0]), ends.x[0], beam.where) * v;
  }
  constexpr double least = 1e-6;
  if (!(v.norm() > 0) || !(v.normalized().cross(axis).norm() > least)) {
    faults_.add(beam.where, "beam " + std::to_string(beam.id) + ": the orientation vector is parallel to the beam");
    return Eigen::Vector3d::Zero();
  }
  return v.normalized().unaryExpr([](double c) { return rounded(c); });
}

/// In basic axes.
Eigen::Vector3d NasBuild::offset_of(const NasBeam& beam, int end, const Ends& ends) {
  const Eigen::Vector3d& offset = beam.offsets[end];
  if (offset.isZero(0)) return offset;
  if (!beam.own_axes[end])
    return frames_.directions(frames_.displacement_axes(*ends.grids[end]), ends.x[end], beam.where) * offset;
  Eigen::Matrix3d axes;
  axes.col(0) = (ends.x[1] - ends.x[0]).normalized();
  axes.col(2) = axes.col(0).cross(orientation_of(beam, ends, axes.col(0))).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes * offset;
}

std::optional<NasBuild::Ends> NasBuild::ends_of(const NasBeam& beam) {
  Ends ends{{frames_.grid(beam.nodes[0]), frames_.grid(beam.nodes[1])}, {}};
  for (int end : {0, 1}) {
    if (ends.grids[end])
      ends.x[end] = frames_.position_of(*ends.grids[end]);
    else
      faults_.add(beam.where, "beam " + std::to_string(beam.id) + " names grid " + std::to_string(beam.nodes[end]) +
                                  ", which is not defined");
  }
  if (ends.grids[0] && ends.grids[1]) return ends;
  return std::nullopt;
}

void NasBuild::add_beam_section(const NasBeamProperty& own, const NasBeam& beam, const Eigen::Vector3d& orientation,
                                int part) {
  const NasMaterial* found = material(own.material, own.where, own.name);
  if (!found) return;
  if (found->material.elasticity != Elasticity::isotropic)
    return faults_.add(own.where, own.name + " names material " + std::to_string(own.material) +
                                      ", which is not isotropic; expected MAT1");
  BeamSection section = own.section;
  section.part = own.name;
  section.number = part;
  section.direction_1 = orientation;
  section.releases = beam.releases, section.alone = beam.alone;
  section.youngs = found->material.constants[0];
  section.shear = found->shear;
  const double density = (found->material.density + own.extra / own.area) * model_.mass_factor;
  if (density > 0) section.density = density;
  deck.beam_sections.push_back(section);
}

void NasBuild::add_beams() {
  for (const NasShell& shell : model_.shells) next_element_ = std::max(next_element_, shell.id + 1);
  for (const NasBeam& beam : model_.beams) next_element_ = std::max(next_element_, beam.id + 1);
  for (std::size_t i = 0; i < model_.beams.size(); ++i) {
    NasBeam beam = model_.beams[i];
    if (const auto found = alone_.find(i); found != alone_.end()) beam.alone = found->second;
    if (const auto found = released_.find(i); found != released_.end()) beam.releases |= found->second;
    const NasBeamProperty* own =
        property(model_.beam_properties, beam.property, beam.where, "beam " + std::to_string(beam.id));
    const std::optional<Ends> ends = ends_of(beam);
    if (!ends || (!own && !scene_has_sections())) continue;
    std::array<long long, 4> nodes{-1, -1, -1, -1};
    std::array<Eigen::Vector3d, 2> x;
    for (int end : {0, 1}) {
      const Eigen::Vector3d offset = offset_of(beam, end, *ends);
      nodes[end] = end_of(beam, *ends->grids[end], offset, ends->x[end]);
      x[end] = ends->x[end] + offset;
    }
    const Eigen::Vector3d line = x[1] - x[0];
    if (!(line.norm() > 0)) {
      faults_.add(beam.where, "beam " + std::to_string(beam.id) + " has no length");
      continue;
    }
    if (!own) {
      const int part =
          part_of_scene(CellKind::line, beam.property, beam.id, !beam.rod && beam.releases == 0, beam.where);
      if (part >= 0 && mine(model_.shells.size() + i))
        mesh.cells.push_back({beam.id, CellKind::line, part, nodes, beam.where});
      continue;
    }
    const Eigen::Vector3d v = orientation_of(beam, *ends, line.normalized());
    if (!own->pieces.empty()) {
      add_pieces(*own, beam, nodes, x, v, mine(model_.shells.size() + i));
      continue;
    }
    const int part =
        part_of(-beam.property, {v[0], v[1], v[2], static_cast<double>(beam.releases | beam.alone << 12), 1}, own->name,
                [&](int number) {
                  if (!replaced(own->name)) add_beam_section(*own, beam, v, number);
                });
    if (mine(model_.shells.size() + i)) mesh.cells.push_back({beam.id, CellKind::line, part, nodes, beam.where});
  }
}

/// A beam with taper as pieces between nodes of their own, the first with its number.
void NasBuild::add_pieces(const NasBeamProperty& own, NasBeam beam, const std::array<long long, 4>& ends,
                          const std::array<Eigen::Vector3d, 2>& x, const Eigen::Vector3d& v, bool mine) {
  const std::size_t count = own.pieces.size();
  const unsigned releases = beam.releases | own.releases, of_a = 0x3f;
  std::array<long long, 4> nodes{ends[0], -1, -1, -1};
  for (std::size_t k = 0; k < count; ++k) {
    const bool last = k + 1 == count;
    if (!last)
      between_.push_back({next_label_, x[0] + (x[1] - x[0]) * (static_cast<double>(k + 1) / count), beam.where});
    nodes[1] = last ? ends[1] : next_label_++;
    beam.releases = (k == 0 ? releases & of_a : 0) | (last ? releases & ~of_a : 0);
    const int part =
        part_of(-beam.property, {v[0], v[1], v[2], static_cast<double>(beam.releases), static_cast<double>(1 + k)},
                own.name, [&](int number) {
                  if (!replaced(own.name)) add_beam_section(own.pieces[k], beam, v, number);
                });
    const long long label = k == 0 ? beam.id : next_element_++;
    if (mine) mesh.cells.push_back({label, CellKind::line, part, nodes, beam.where});
    nodes[0] = nodes[1];
  }
}

}  // namespace floe::mesh
