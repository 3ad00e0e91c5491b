#include "deck_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "floe/math/rounded.h"

namespace floe::plan {
namespace {

/// The deck with the part at work, for messages.
struct Reader {
  const mesh::DeckFile& file;
  std::vector<std::string> faults = {};
  std::vector<std::string> massless = {};  ///< materials of the part at work

  void fault(const std::string& part, const std::string& text) {
    faults.push_back(fmt::format("{}: the section of {}: {}", file.mesh.source, part, text));
  }
  void add_massless(const std::string& what) {
    if (std::find(massless.begin(), massless.end(), what) == massless.end()) massless.push_back(what);
  }
  const mesh::Material* material(const std::string& part, const std::string& name) {
    for (const mesh::Material& m : file.deck.materials) {
      if (m.name != name) continue;
      if (m.elasticity == mesh::Elasticity::none) {
        fault(part, fmt::format("material {} has no *ELASTIC", name));
        return nullptr;
      }
      if (!(m.density > 0)) add_massless("material " + name);
      return &m;
    }
    fault(part, fmt::format("there is no material {}", name));
    return nullptr;
  }
};

fem::ShellMaterial shell_material(const mesh::Material& m) {
  const std::vector<double>& c = m.constants;
  switch (m.elasticity) {
    case mesh::Elasticity::engineering_constants:
      return {c[0], c[1], c[3], c[6], m.density};
    case mesh::Elasticity::lamina:
      return {c[0], c[1], c[2], c[3], m.density};
    default:
      return fem::isotropic(c[0], c[1], m.density);
  }
}

/// Of a section without an orientation the global x-axis, projected on each element, as in Abaqus and CalculiX.
Eigen::Vector3d axis_named(const Reader& reader, const std::string& orientation) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (orientation.empty() && !reader.file.deck.nastran) axis = Eigen::Vector3d::UnitX();
  for (const mesh::Orientation& o : reader.file.deck.orientations)
    if (o.name == orientation) axis = mesh::axes_of(o).col(0);
  return axis;
}

/// Thickness of a homogeneous shell of the same ratio of bending and membrane stiffness.
double equivalent_thickness(const fem::ShellSection& section) { return std::sqrt(12.0) * section.mass_radius; }

/// A section by its stiffness; its stresses are not known.
void add_stiffness(Reader& reader, const mesh::ShellSection& section, DeckSections& deck) {
  const auto& S = section.stiffness->values;
  if (!section.stiffness->density) reader.add_massless("its section");
  try {
    fem::ShellSection shell =
        fem::stiffness_section(S.topLeftCorner<3, 3>(), S.topRightCorner<3, 3>(), S.bottomRightCorner<3, 3>(),
                               section.stiffness->density.value_or(0), axis_named(reader, section.orientation));
    if (section.shear > 0) shell.shear = section.shear;
    deck.parts[section.number] = shell;
    deck.points[section.number] = {};
    deck.described.push_back(
        {section.number, section.part, std::exchange(reader.massless, {}), equivalent_thickness(shell)});
  } catch (const InputError& error) {
    reader.fault(section.part, error.what());
  }
}

/// A ply whose bending is that of another material, or of other fibres.
void bend(Reader& reader, const mesh::ShellSection& section, const std::vector<fem::Ply>& plies, DeckSections& deck) {
  const mesh::Material* material = reader.material(section.part, section.bending->material);
  if (!material || plies.size() != 1) return;
  const double T = plies[0].thickness, offset = -section.offset * T;
  const auto& own = std::get<fem::ShellSection>(deck.parts.at(section.number));
  const Eigen::Matrix3d D =
      section.bending->factor * std::pow(T, 3) / 12 * fem::plane_stress(shell_material(*material));
  fem::ShellSection shell =
      fem::stiffness_section(own.A, Eigen::Matrix3d::Zero(), D, own.mass, axis_named(reader, section.orientation));
  shell.coupling = offset * Eigen::Matrix3d::Identity();
  shell.mass_centre = offset, shell.mass_radius = own.mass_radius;
  deck.parts[section.number] = shell;
  deck.points[section.number] = {};
}

void add_shell(Reader& reader, const mesh::ShellSection& section, DeckSections& deck) {
  if (section.stiffness) return add_stiffness(reader, section, deck);
  std::vector<fem::Ply> plies;
  double thickness = 0;
  std::string orientation = section.orientation;
  bool directed = false;
  for (const mesh::Ply& ply : section.plies) {
    if (orientation.empty()) orientation = ply.orientation;
    if (!ply.orientation.empty() && ply.orientation != orientation)
      return reader.fault(section.part, "its plies have orientations of different names; expected one, with angles");
    const mesh::Material* material = reader.material(section.part, ply.material);
    if (!material) return;
    directed = directed || material->elasticity != mesh::Elasticity::isotropic;
    plies.push_back({shell_material(*material), ply.thickness, ply.angle * M_PI / 180});
    thickness += ply.thickness;
  }
  for (fem::Ply& ply : plies) ply.material.density += section.added_mass / thickness;
  try {
    fem::ShellSection shell = fem::shell_section(
        plies, -section.offset * thickness,
        directed || !orientation.empty() ? axis_named(reader, orientation) : Eigen::Vector3d::Zero());
    if (section.shear > 0) shell.shear = section.shear;
    deck.parts[section.number] = shell;
    std::vector<fem::Ply> thickest = plies;  // where a curvature stresses it most
    for (fem::Ply& ply : thickest) ply.thickness *= section.thickest;
    deck.points[section.number] = {fem::shell_layers(thickest, -section.offset * thickness)};
    if (section.bending) bend(reader, section, plies, deck);
    auto& own = std::get<fem::ShellSection>(deck.parts[section.number]);
    own.bending *= section.taper, own.mass_radius *= std::sqrt(section.taper);
    deck.described.push_back({section.number, section.part, std::exchange(reader.massless, {}), thickness});
  } catch (const InputError& error) {
    reader.fault(section.part, error.what());
  }
}

/// Full, of the half axes a along y and b along z. Source: Timoshenko & Goodier, Theory of elasticity, 3rd ed., art.
/// 105.
fem::SectionShape ellipse(double a, double b) {
  fem::SectionShape shape;
  shape.A = M_PI * a * b;
  shape.Iy = shape.A * b * b / 4, shape.Iz = shape.A * a * a / 4;
  shape.J = M_PI * std::pow(a * b, 3) / (a * a + b * b);
  return shape;
}

fem::SectionShape shape_of(const mesh::BeamSection& section) {
  const std::vector<double>& d = section.dimensions;
  switch (section.profile) {
    case mesh::Profile::rectangle:
      return fem::rectangle(d[0], d[1]);
    case mesh::Profile::circle:
      return d.size() == 1 ? fem::circle(d[0]) : ellipse(d[0], d[1]);
    case mesh::Profile::pipe:
      return fem::tube(d[0], d[0] - d[1]);
    case mesh::Profile::box:
      if (d[2] != d[4] || d[3] != d[5]) throw InputError("a box of unequal walls; expected t1 = t3 and t2 = t4");
      return fem::box(d[0], d[1], d[2], d[3]);
    case mesh::Profile::i_section:
      if (d[2] != d[3] || d[4] != d[5] || std::abs(2 * d[0] - d[1]) > 1e-12 * d[1])
        throw InputError("an I that is not symmetric; expected b1 = b2, t1 = t2, l = h/2");
      return fem::i_section(d[2], d[1], d[4], d[6]);
    case mesh::Profile::general:
      break;
  }
  fem::SectionShape shape;
  shape.A = d[0], shape.Iy = d[1], shape.Iyz = d[2], shape.Iz = d[3], shape.J = d[4];
  return shape;
}

/// Of what a section does not carry, both ends are released, and the constant that is 0 becomes that of a square of
/// this area: it is without effect.
fem::BeamReleases without_stiffness(fem::SectionShape& shape) {
  fem::BeamReleases releases;
  const auto release = [&](double& constant, double square, std::size_t rotation) {
    if (constant != 0) return;
    constant = square;
    releases.set(rotation).set(6 + rotation);
  };
  release(shape.J, shape.A * shape.A / 7, 3);
  release(shape.Iy, shape.A * shape.A / 12, 4);
  release(shape.Iz, shape.A * shape.A / 12, 5);
  return releases;
}

/// Size of the profile along 1 and 2, for offsets.
Eigen::Vector2d extent_of(const mesh::BeamSection& section) {
  const std::vector<double>& d = section.dimensions;
  switch (section.profile) {
    case mesh::Profile::rectangle:
    case mesh::Profile::box:
      return {d[0], d[1]};
    case mesh::Profile::i_section:
      return {std::max(d[2], d[3]), d[1]};
    case mesh::Profile::general:
      throw InputError("an offset of a general profile, which has no thickness");
    case mesh::Profile::circle:
      return {2 * d[0], 2 * d.back()};
    default:
      return {2 * d[0], 2 * d[0]};
  }
}

/// Extreme fibres; of an ellipse, and of a general profile without stress points, none are known.
fem::StressPoints points_of(const mesh::BeamSection& section, double E) {
  const std::vector<double>& d = section.dimensions;
  fem::StressPoints points;
  points.E = E;
  const bool round = section.profile == mesh::Profile::pipe ||
                     (section.profile == mesh::Profile::circle && (d.size() == 1 || d[0] == d[1]));
  if (!section.fibres.empty()) {
    points.fibres = section.fibres;
  } else if (round) {
    points.radius = d[0];
  } else if (section.profile != mesh::Profile::general && section.profile != mesh::Profile::circle) {
    Eigen::Vector2d size = extent_of(section);
    if (section.quarter_turn) std::swap(size[0], size[1]);
    points.fibres = fem::rectangle_corners(size[0], size[1]);
  }
  return points;
}

/// Greatest dimension of a profile.
double size_of(const mesh::BeamSection& section) {
  if (section.profile == mesh::Profile::general) return std::sqrt(section.dimensions[0]);
  return extent_of(section).maxCoeff();
}

void add_beam(Reader& reader, const mesh::BeamSection& section, DeckSections& deck) {
  fem::BeamMaterial material{section.youngs, section.shear, section.density.value_or(0)};
  if (section.material.empty() && !section.density) reader.add_massless("its section");
  if (!section.material.empty()) {
    const mesh::Material* named = reader.material(section.part, section.material);
    if (!named) return;
    if (named->elasticity != mesh::Elasticity::isotropic)
      return reader.fault(section.part, fmt::format("material {} of a beam is not isotropic", named->name));
    material = {named->constants[0], fem::shear_modulus(named->constants[0], named->constants[1]), named->density};
  }
  try {
    Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
    if (section.offset_1 != 0 || section.offset_2 != 0)
      centroid = -Eigen::Vector2d(section.offset_1, section.offset_2).cwiseProduct(extent_of(section));
    fem::SectionShape shape = shape_of(section);
    if (section.quarter_turn) {
      std::swap(shape.Iy, shape.Iz);
      shape.Iyz = -shape.Iyz;
    }
    const fem::SectionShape given = shape;
    const fem::BeamReleases without = without_stiffness(shape);
    fem::SpatialBeam beam{fem::spatial_section(shape, material, centroid), section.direction_1, {}, {}};
    if (section.centroid) beam.section.centroid = *section.centroid;  // its shear centre is in the line
    beam.releases = fem::BeamReleases(section.releases) | without;
    beam.alone = section.alone;
    beam.section.rhoIy = material.rho * given.Iy, beam.section.rhoIz = material.rho * given.Iz;
    for (int i : {0, 1})
      if (section.shear_factors[i] > 0) beam.section.GA[i] = section.shear_factors[i] * material.G * shape.A;
    deck.parts[section.number] = beam;
    deck.points[section.number] = points_of(section, material.E);
    deck.points[section.number].W = section.torsion_modulus > 0 ? section.torsion_modulus : given.W;
    deck.described.push_back({section.number, section.part, std::exchange(reader.massless, {}), size_of(section)});
  } catch (const InputError& error) {
    reader.fault(section.part, error.what());
  }
}

}  // namespace

DeckSections deck_sections(const mesh::DeckFile& file) {
  Reader reader{file};
  DeckSections deck;
  for (const mesh::ShellSection& section : file.deck.shell_sections) add_shell(reader, section, deck);
  for (const mesh::BeamSection& section : file.deck.beam_sections) add_beam(reader, section, deck);
  if (!reader.faults.empty()) throw InputError(reader.faults);
  return deck;
}

namespace {

/// How many cells each part of the mesh has. Collective.
std::vector<long long> cells_of_parts(const mesh::RawMesh& mesh) {
  std::vector<long long> counts(mesh.parts.size(), 0);
  for (const auto& cell : mesh.cells) ++counts[cell.part];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_LONG_LONG, MPI_SUM, mesh.comm);
  return counts;
}

/// Diagonal of the box about all nodes. Collective.
double extent_of(const mesh::RawMesh& mesh) {
  constexpr double far = 1e300;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(far), high = -low;
  for (const Eigen::Vector3d& x : mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh.comm);
  MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return (high - low).norm();
}

}  // namespace

std::vector<std::string> deck_notices(const mesh::DeckFile& file, const DeckSections& deck,
                                      const std::vector<std::string>& replaced, double scale) {
  const mesh::RawMesh& mesh = file.mesh;
  const std::vector<long long> cells = cells_of_parts(mesh);
  const double extent = extent_of(mesh);
  std::vector<std::string> notices;
  const DeckPart* thickest = nullptr;
  struct Massless {
    std::string what, part;
    long long cells;
  };
  std::vector<Massless> all;  // parts of one name count together
  for (const DeckPart& part : deck.described) {
    if (cells[part.number] == 0 || std::count(replaced.begin(), replaced.end(), part.name) > 0) continue;
    if (!thickest || part.size > thickest->size) thickest = &part;
    for (const std::string& what : part.massless) {
      const auto same = std::find_if(all.begin(), all.end(),
                                     [&](const Massless& m) { return m.what == what && m.part == part.name; });
      if (same == all.end())
        all.push_back({what, part.name, cells[part.number]});
      else
        same->cells += cells[part.number];
    }
  }
  for (const Massless& m : all)
    notices.push_back(fmt::format(
        "{}: {} has no density: it adds stiffness without mass to part {} ({} of {} elements); expected {}",
        mesh.source, m.what, m.part, m.cells, mesh.cell_count, file.deck.nastran ? "RHO of the MAT card" : "*DENSITY"));
  if (scale != 1 && thickest)
    notices.push_back(fmt::format(
        "{}: scale {} applies to coordinates only; sections, materials and masses of the deck remain as written: "
        "part {} is {:.4g} thick, {} of the scaled extent {:.4g} ({} in the deck's own units); convert the deck, or "
        "give its parts sections in the scene (parts)",
        mesh.source, scale, thickest->name, thickest->size, math::percent(thickest->size / (scale * extent)),
        scale * extent, math::percent(thickest->size / extent)));
  return notices;
}

namespace {

/// Mass, centre, inertia (11, 12, 13, 22, 23, 33): points that have the same are one part.
using MassKey = std::array<double, 10>;

MassKey key_of(const mesh::PointMass& point) {
  const Eigen::Vector3d& c = point.offset;
  const Eigen::Matrix3d& J = point.inertia;
  return {point.mass, c[0], c[1], c[2], J(0, 0), J(0, 1), J(0, 2), J(1, 1), J(1, 2), J(2, 2)};
}

}  // namespace

void add_masses(mesh::DeckFile& file, std::map<int, fem::Section>& parts) {
  mesh::RawMesh& raw = file.mesh;
  std::vector<MassKey> mine, all;
  for (const mesh::PointMass& point : file.deck.masses) mine.push_back(key_of(point));
  int size = 1, rank = 0, count = static_cast<int>(mine.size() * sizeof(MassKey) / sizeof(double));
  MPI_Comm_size(raw.comm, &size);
  MPI_Comm_rank(raw.comm, &rank);
  std::vector<int> counts(size), starts(size + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, raw.comm);
  for (int r = 0; r < size; ++r) starts[r + 1] = starts[r] + counts[r];
  all.resize(starts[size] * sizeof(double) / sizeof(MassKey));
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, raw.comm);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const int first = static_cast<int>(raw.parts.size());
  for (const MassKey& key : all) {
    fem::PointMass point{key[0]};
    point.offset = {key[1], key[2], key[3]};
    point.inertia << key[4], key[5], key[6], key[5], key[7], key[8], key[6], key[8], key[9];
    parts[static_cast<int>(raw.parts.size())] = point;
    raw.parts.push_back(fmt::format("mass {}", key[0]));
  }
  for (const mesh::PointMass& point : file.deck.masses) {
    const int part = first + static_cast<int>(std::lower_bound(all.begin(), all.end(), key_of(point)) - all.begin());
    raw.cells.push_back({mesh::CellKind::point, {point.node, -1, -1, -1}, part});
    raw.cell_labels.push_back(0);
  }
  const std::vector<PetscInt> cells = mesh::starts_of(raw.comm, static_cast<PetscInt>(raw.cells.size()));
  raw.first_cell = cells[rank];
  raw.cell_count = cells.back();
}

}  // namespace floe::plan
