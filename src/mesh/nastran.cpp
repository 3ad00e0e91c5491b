#include "floe/mesh/nastran.h"

#include <fmt/format.h>


#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "deck_file.h"
#include "floe/petsc/error.h"
#include "nas_reading.h"
#include "text.h"

namespace floe::mesh {
namespace {

/// What makes elements of one property different parts.
using NasVariant = std::array<double, 5>;

/// Turns the model into the mesh and the deck: parts and sections are the same on all ranks, of the rest a rank keeps
/// its share.
class NasBuild {
 public:
  NasBuild(const NasModel& model, Faults& faults, int rank, int ranks)
      : model_(model), faults_(faults), rank_(rank), ranks_(ranks), frames_(model, faults) {}

  FileMesh mesh;
  Deck deck;
  std::vector<std::string> notices;

  void build() {
    deck.nastran = true;
    share_ = share_of(static_cast<PetscInt>(model_.shells.size() + model_.beams.size()), rank_, ranks_);
    add_grids();
    add_links();
    add_shells();
    add_beams();
    add_extra_grids();
    add_masses();
    add_places();
    tell_unused();
  }

 private:
  bool mine(std::size_t element) const {
    const auto i = static_cast<PetscInt>(element);
    return i >= share_.first && i < share_.first + share_.count;
  }

  void add_grids() {
    const Share share = share_of(static_cast<PetscInt>(model_.grids.size()), rank_, ranks_);
    for (std::size_t i = 0; i < model_.grids.size(); ++i) {
      const NasGrid& grid = model_.grids[i];
      const Eigen::Vector3d x = frames_.position_of(grid);
      next_label_ = std::max(next_label_, grid.id + 1);
      if (static_cast<PetscInt>(i) < share.first || static_cast<PetscInt>(i) >= share.first + share.count) continue;
      mesh.node_labels.push_back(grid.id);
      mesh.positions.push_back(x);
      mesh.node_where.push_back(grid.where);
    }
  }

  /// Rigid links by independent grid: all ranks mention it, the first rank its dependent ones.
  void link(long long reference, const std::vector<long long>& nodes, Where where) {
    auto& rigid = deck.links.emplace_back(RigidLink{static_cast<PetscInt>(mesh.mentions.size()), {}});
    mesh.mentions.push_back({reference, where});
    if (rank_ != 0) return;
    for (const long long node : nodes) {
      if (node == reference) continue;
      rigid.nodes.push_back(static_cast<PetscInt>(mesh.mentions.size()));
      mesh.mentions.push_back({node, where});
    }
  }

  void add_links() {
    for (const NasLink& rigid : model_.links) {
      link(rigid.reference, rigid.nodes, rigid.where);
      for (const long long node : rigid.nodes) independent_[node] = rigid.reference;
    }
  }

  /// The part of elements of a property that agree in `variant`; `make` adds its section.
  template <class Make>
  int part_of(long long property, const NasVariant& variant, const std::string& name, Make&& make) {
    const auto [at, fresh] = parts_.try_emplace({property, variant}, static_cast<int>(mesh.parts.size()));
    if (!fresh) return at->second;
    constexpr std::size_t most = 20000;
    if (mesh.parts.size() == most)
      faults_.add({0, 1}, "the elements have more than " + std::to_string(most) +
                              " different sections: give material axes by MCID, orientations by vectors");
    mesh.parts.push_back(name);
    make(at->second);
    return at->second;
  }

  const NasMaterial* material(long long id, Where where, const std::string& user) {
    const auto found = model_.materials.find(id);
    if (found != model_.materials.end()) {
      used_materials_.push_back(id);
      return &found->second;
    }
    std::vector<std::string> known;
    for (const auto& [number, unused] : model_.materials) known.push_back(std::to_string(number));
    faults_.add(where, user + " names material " + std::to_string(id) + ", which is not defined" +
                           suggestion(std::to_string(id), known));
    return nullptr;
  }

  template <class Map>
  const typename Map::mapped_type* property(const Map& all, long long id, Where where, const std::string& element) {
    const auto found = all.find(id);
    if (found != all.end()) {
      used_properties_.push_back(id);
      return &found->second;
    }
    std::vector<std::string> known;
    for (const auto& [number, unused] : all) known.push_back(std::to_string(number));
    if (known.size() > 10) known.resize(10);
    faults_.add(where, element + " names property " + std::to_string(id) + ", which is not defined" +
                           (known.empty() ? "" : " (" + listed(known) + " are)"));
    return nullptr;
  }

  /// Whether a direction of the material matters.
  bool has_axes(const NasShellProperty& property) {
    return std::any_of(property.plies.begin(), property.plies.end(), [&](const NasPly& ply) {
      const auto found = model_.materials.find(ply.material);
      return found != model_.materials.end() && found->second.material.elasticity != Elasticity::isotropic;
    });
  }

  /// Direction of angle 0 of a shell's material.
  Eigen::Vector3d axis_of(const NasShell& shell) {
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

  /// Rounded, so that parallel directions are the same.
  static double rounded(double x) { return std::round(x * 1e10) / 1e10 + 0.0; }

  std::string named_material(const NasMaterial& of, double extra_density, const std::string& property) {
    Material material = of.material;
    material.density = material.density * model_.mass_factor + extra_density;
    if (extra_density != 0) material.name += " with the NSM of " + property;
    for (const auto& known : deck.materials)
      if (known.name == material.name) return material.name;
    deck.materials.push_back(material);
    return material.name;
  }

  void add_shell_section(const NasShell& shell, const NasShellProperty& property, double thickness,
                         const Eigen::Vector3d& axis, int part) {
    ShellSection section;
    section.part = property.name;
    section.number = part;
    double total = 0;
    for (const NasPly& ply : property.plies) total += ply.thickness;
    for (const NasPly& ply : property.plies) {
      const NasMaterial* found = material(ply.material, property.where, property.name);
      if (!found) return;
      const bool one = property.plies.size() == 1, own = one && thickness != total;  // the element's T1 to T4
      const std::string with = own ? fmt::format("{}, thickness {:.9g}", property.name, thickness) : property.name;
      section.plies.push_back(
          {one ? thickness : ply.thickness,
           named_material(*found, property.extra * model_.mass_factor / (one ? thickness : total), with), "",
           ply.angle});
    }
    if (property.plies.size() == 1) total = thickness;
    const double middle = shell.offset + (property.bottom ? *property.bottom + total / 2 : 0);
    section.offset = -middle / total;
    if (!axis.isZero(0)) {
      Orientation orientation{"axis " + std::to_string(deck.orientations.size() + 1), axis, axis.unitOrthogonal(), 0,
                              0};
      section.orientation = orientation.name;
      deck.orientations.push_back(orientation);
    }
    deck.shell_sections.push_back(section);
  }

  void add_shells() {
    for (std::size_t i = 0; i < model_.shells.size(); ++i) {
      const NasShell& shell = model_.shells[i];
      const NasShellProperty* own =
          property(model_.shell_properties, shell.property, shell.where, "shell " + std::to_string(shell.id));
      if (!own) continue;
      double thickness = own->plies.front().thickness;
      if (shell.thickness > 0 && own->plies.size() == 1)
        thickness = shell.ratio ? thickness * shell.thickness : shell.thickness;
      Eigen::Vector3d axis = Eigen::Vector3d::Zero();
      if (has_axes(*own)) axis = axis_of(shell).unaryExpr([](double x) { return rounded(x); });
      const int part = part_of(shell.property, {thickness, shell.offset, axis[0], axis[1], axis[2]}, own->name,
                               [&](int number) { add_shell_section(shell, *own, thickness, axis, number); });
      if (mine(i))
        mesh.cells.push_back({shell.id, shell.count == 3 ? CellKind::triangle : CellKind::quadrilateral, part,
                              shell.nodes, shell.where});
    }
  }

  /// The node at the end of a beam, which an offset moves away from the grid.
  long long end_of(const NasBeam& beam, int end, const NasGrid& grid, const Eigen::Vector3d& x) {
    const Eigen::Vector3d& offset = beam.offsets[end];
    if (offset.isZero(0)) return grid.id;
    const Eigen::Vector3d moved = frames_.directions(frames_.displacement_axes(grid), x, beam.where) * offset;
    const auto [at, fresh] =
        extra_of_.try_emplace({static_cast<double>(grid.id), moved[0], moved[1], moved[2]}, next_label_);
    if (fresh) {
      extra_.push_back({next_label_++, x + moved, beam.where});
      const auto found = independent_.find(grid.id);
      extra_links_[found == independent_.end() ? grid.id : found->second].push_back(extra_.size() - 1);
    }
    return at->second;
  }

  /// The orientation vector in basic axes; of G0 its part normal to the beam, which neighbours share.
  Eigen::Vector3d orientation_of(const NasBeam& beam, const NasGrid& a, const Eigen::Vector3d& x_a,
                                 const Eigen::Vector3d& axis) {
    Eigen::Vector3d v;
    if (beam.orientation_node > 0) {
      const auto x = frames_.position(beam.orientation_node, beam.where);
      if (!x) return Eigen::Vector3d::Zero();
      v = *x - x_a;
      v -= axis * axis.dot(v);
    } else {
      v = frames_.directions(frames_.displacement_axes(a), x_a, beam.where) * beam.orientation;
    }
    constexpr double least = 1e-6;
    if (!(v.norm() > 0) || !(v.normalized().cross(axis).norm() > least)) {
      faults_.add(beam.where, "beam " + std::to_string(beam.id) + ": the orientation vector is parallel to the beam");
      return Eigen::Vector3d::Zero();
    }
    return v.normalized().unaryExpr([](double c) { return rounded(c); });
  }

  void add_beam_section(const NasBeamProperty& own, const Eigen::Vector3d& orientation, int part) {
    const NasMaterial* found = material(own.material, own.where, own.name);
    if (!found) return;
    if (found->material.elasticity != Elasticity::isotropic)
      return faults_.add(own.where, own.name + " names material " + std::to_string(own.material) +
                                        ", which is not isotropic; expected MAT1");
    BeamSection section = own.section;
    section.part = own.name;
    section.number = part;
    section.direction_1 = orientation;
    section.youngs = found->material.constants[0];
    section.shear = found->shear;
    const double density = (found->material.density + own.extra / own.area) * model_.mass_factor;
    if (density > 0) section.density = density;
    deck.beam_sections.push_back(section);
  }

  void add_beams() {
    for (std::size_t i = 0; i < model_.beams.size(); ++i) {
      const NasBeam& beam = model_.beams[i];
      const NasBeamProperty* own =
          property(model_.beam_properties, beam.property, beam.where, "beam " + std::to_string(beam.id));
      const NasGrid *a = frames_.grid(beam.nodes[0]), *b = frames_.grid(beam.nodes[1]);
      for (int end : {0, 1})
        if (!(end ? b : a))
          faults_.add(beam.where, "beam " + std::to_string(beam.id) + " names grid " + std::to_string(beam.nodes[end]) +
                                      ", which is not defined");
      if (!own || !a || !b) continue;
      const Eigen::Vector3d x_a = frames_.position_of(*a), x_b = frames_.position_of(*b);
      const std::array<long long, 4> nodes{end_of(beam, 0, *a, x_a), end_of(beam, 1, *b, x_b), -1, -1};
      const auto place = [&](int end, const Eigen::Vector3d& x) {
        return nodes[end] == beam.nodes[end] ? x
                                             : extra_[static_cast<std::size_t>(nodes[end] - extra_.front().label)].x;
      };
      const Eigen::Vector3d line = place(1, x_b) - place(0, x_a);
      if (!(line.norm() > 0)) {
        faults_.add(beam.where, "beam " + std::to_string(beam.id) + " has no length");
        continue;
      }
      const Eigen::Vector3d v = orientation_of(beam, *a, x_a, line.normalized());
      const int part = part_of(-beam.property, {v[0], v[1], v[2], 0, 0}, own->name,
                               [&](int number) { add_beam_section(*own, v, number); });
      if (mine(model_.shells.size() + i)) mesh.cells.push_back({beam.id, CellKind::line, part, nodes, beam.where});
    }
  }

  void add_extra_grids() {
    if (extra_.empty()) return;
    if (rank_ == ranks_ - 1)
      for (const Extra& extra : extra_) {
        mesh.node_labels.push_back(extra.label);
        mesh.positions.push_back(extra.x);
        mesh.node_where.push_back(extra.where);
      }
    for (const auto& [reference, which] : extra_links_) {
      std::vector<long long> nodes;
      for (const std::size_t i : which) nodes.push_back(extra_[i].label);
      link(reference, nodes, extra_[which.front()].where);
    }
    notices.push_back(faults_.text_of(extra_.front().where) + ": " +
                      counted(static_cast<long long>(extra_.size()), "node") + " of beams with offsets, from " +
                      std::to_string(extra_.front().label) + " on, rigidly linked to their grids");
  }

  void add_masses() {
    for (const NasMass& given : model_.masses) {
      const auto x = frames_.position(given.grid, given.where);
      if (!x) continue;
      PointMass mass = given.mass;
      if (given.axes < 0) {
        mass.offset -= *x;
      } else {
        const Eigen::Matrix3d axes = frames_.directions(given.axes, *x, given.where);
        mass.offset = axes * mass.offset;
        mass.inertia = axes * mass.inertia * axes.transpose();
      }
      mass.mass *= model_.mass_factor;
      mass.inertia *= model_.mass_factor;
      const Eigen::Vector3d roots = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mass.inertia).eigenvalues();
      constexpr double rounding = 1e-9;
      if (roots[0] < -rounding * roots[2] || roots[0] + roots[1] < roots[2] * (1 - 1e-6))
        notices.push_back(faults_.text_of(given.where) + ": CONM2: its moments of inertia are those of no body (" +
                          "one is negative or greater than the sum of the others)");
      if (rank_ != 0) continue;
      mass.node = static_cast<PetscInt>(mesh.mentions.size());
      mesh.mentions.push_back({given.grid, given.where});
      deck.masses.push_back(mass);
    }
  }

  void add_places() {
    std::map<std::string, std::size_t> numbers;
    const auto place = [&](const std::string& name, Where where) {
      const auto [at, fresh] = numbers.try_emplace(name, mesh.places.size());
      if (fresh) mesh.places.push_back({name, where, {}});
      return at->second;
    };
    std::vector<std::size_t> of_part;
    for (const std::string& part : mesh.parts) of_part.push_back(place(part, {0, 1}));
    for (const FileCell& cell : mesh.cells) {
      auto& labels = mesh.places[of_part[cell.part]].labels;
      labels.insert(labels.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
    }
    auto supports = model_.supports;
    for (const auto& [set, first, last, where] : model_.support_ranges)
      for (const auto& grid : model_.grids)
        if (grid.id >= first && grid.id <= last) supports[set].emplace_back(grid.id, where);
    for (const auto& [set, grids] : supports) {
      auto& support = mesh.places[place(set ? "SPC" + std::to_string(set) : "PS",
                                        grids.empty() ? Where{0, 1} : grids.front().second)];
      for (const auto& [grid, where] : grids) {
        if (!frames_.grid(grid))
          faults_.add(where, "SPC of set " + std::to_string(set) + " names grid " + std::to_string(grid) +
                                 ", which is not defined");
        else if (rank_ == 0)
          support.labels.push_back(grid);
      }
    }
    for (auto& one : mesh.places) {
      std::sort(one.labels.begin(), one.labels.end());
      one.labels.erase(std::unique(one.labels.begin(), one.labels.end()), one.labels.end());
    }
  }

  void tell_unused() {
    std::vector<std::string> unused;
    const auto is_used = [](std::vector<long long>& used, long long id) {
      return std::find(used.begin(), used.end(), id) != used.end();
    };
    for (auto* used : {&used_materials_, &used_properties_}) {
      std::sort(used->begin(), used->end());
      used->erase(std::unique(used->begin(), used->end()), used->end());
    }
    for (const auto& [id, own] : model_.shell_properties)
      if (!is_used(used_properties_, id)) unused.push_back(own.name);
    for (const auto& [id, own] : model_.beam_properties)
      if (!is_used(used_properties_, id)) unused.push_back(own.name);
    for (const auto& [id, own] : model_.materials)
      if (!is_used(used_materials_, id)) unused.push_back(own.material.name);
    if (!unused.empty()) notices.push_back(faults_.text_of({0, 1}) + ": not used by any element: " + listed(unused));
  }

  struct Extra {
    long long label;
    Eigen::Vector3d x;
    Where where;
  };

  const NasModel& model_;
  Faults& faults_;
  int rank_, ranks_;
  NasFrames frames_;
  Share share_{0, 0};
  long long next_label_ = 1;
  std::map<std::pair<long long, NasVariant>, int> parts_;  // of beams by the negative number of the property
  std::unordered_map<long long, long long> independent_;   // of dependent grids
  std::vector<Extra> extra_;                               // nodes at the ends of beams with offsets
  std::map<std::array<double, 4>, long long> extra_of_;
  std::map<long long, std::vector<std::size_t>> extra_links_;
  std::vector<long long> used_materials_, used_properties_;
};

void refuse_cards(const NasModel& model, const DeckRequest& request, std::vector<std::string>& notices,
                  Faults& faults) {
  const auto ignores = [&](const std::string& name) {
    return std::any_of(request.ignore.begin(), request.ignore.end(),
                       [&](const auto& one) { return upper(one) == name; });
  };
  for (const auto& [name, count] : model.refused) {
    const std::string many = counted(count.times, "card");
    if (ignores(name))
      notices.push_back(faults.text_of(count.where) + ": " + many + " " + name + " left out, as the scene asks");
    else
      faults.add(count.where, name + " (" + nas_refusal(name) + ", " + many +
                                  ") is not read; to leave them out: file: {ignore: [" + name + "]}");
  }
  for (const auto& [name, count] : model.unknown) {
    if (ignores(name))
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
    const NasControl control =
        each_card(path, faults, [&](const NasCard& card) { read_nas_card(card, model, faults); });
    if (control.lines > 0)
      notices.push_back(faults.text_of(control.where) + ": " + counted(control.lines, "line") +
                        " before BEGIN BULK ignored: the scene says what is computed");
    refuse_cards(model, request, notices, faults);
    refuse_empty(model, faults);
    if (faults.any()) return;
    NasBuild build(model, faults, rank, ranks);
    build.build();
    mesh = std::move(build.mesh);
    deck = std::move(build.deck);
    notices.insert(notices.end(), build.notices.begin(), build.notices.end());
  });
  faults.throw_together(comm);
  return deck_file(comm, path, std::move(mesh), std::move(deck), faults, std::move(notices));
}

}  // namespace floe::mesh
