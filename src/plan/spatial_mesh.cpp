#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "cut_mesh.h"
#include "deck_sections.h"
#include "floe/fem/default_strains.h"
#include "floe/generate/generate.h"
#include "floe/generate/halved.h"
#include "floe/math/nearest.h"
#include "floe/mesh/gmsh.h"
#include "floe/mesh/inp.h"
#include "floe/mesh/inspect.h"
#include "floe/mesh/nastran.h"
#include "floe/mesh/partition.h"
#include "floe/mesh/pieces.h"
#include "floe/petsc/all_ranks.h"
#include "floe/plan/prepare_spatial.h"
#include "floe/scene/places.h"
#include "hinge_lines.h"
#include "point_masses.h"
#include "rigid_regions.h"
#include "straight_edges.h"

namespace floe::plan {
namespace {

Eigen::Vector3d vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// A mesh with what its file says besides.
struct Source {
  mesh::RawMesh mesh;
  std::map<int, fem::Section> parts;  ///< a deck's own, by the number of RawMesh::parts
  std::vector<std::string> notices;
  std::vector<mesh::DependentNode> dependent_nodes = {};
  std::map<int, fem::StressPoints> points = {};  ///< of the deck's own sections
  bool deck = false;                             ///< whether it is one
};

/// Parts that the scene gives a section by name.
std::vector<std::string> named_parts(const Body& body) {
  std::vector<std::string> names;
  for (const PartSpec& part : body.parts)
    if (!part.part.empty()) names.push_back(part.part);
  return names;
}

/// What the readers say of a file names its lines; that there is none concerns the scene. Collective.
void refuse_missing(const Body& body, MPI_Comm comm) {
  int rank = 0, found = 1;
  MPI_Comm_rank(comm, &rank);
  std::error_code ignored;
  if (rank == 0) found = std::filesystem::is_regular_file(body.mesh.file->path, ignored) ? 1 : 0;
  MPI_Bcast(&found, 1, MPI_INT, 0, comm);
  if (found == 0)
    throw InputError(fmt::format("{}.file.path: there is no file \"{}\"; expected one relative to the scene's folder",
                                 body.mesh.where.text(), body.mesh.file->path));
}

/// What the scene gives the elements of a deck.
mesh::DeckRequest request_of(const Body& body) {
  const std::vector<std::string> named = named_parts(body);
  return {named, named.size() < body.parts.size(), body.mesh.file->ignore, body.mesh.file->instance};
}

/// Beams with released ends remain whole, as halves would be released, too; rods are divided where a shell holds the
/// node between their halves.
generate::Halved division_of(const fem::Section& section) {
  const auto* beam = std::get_if<fem::SpatialBeam>(&section);
  if (!beam || beam->releases.none()) return generate::Halved::all;
  const bool rod = beam->releases[4] && beam->releases[5] && beam->releases[10] && beam->releases[11] &&
                   !beam->releases[0] && !beam->releases[6];
  return rod ? generate::Halved::along_shells : generate::Halved::none;
}

mesh::Inspection inspected(const Source& source, const std::vector<std::array<PetscInt, 2>>& connections = {}) {
  return mesh::inspect(source.mesh, connections, source.deck);
}

/// Faults of elements and nodes, by their numbers in the file.
std::vector<std::string> faults_of(const Body& body, const mesh::Inspection& inspection) {
  std::vector<std::string> faults;
  for (const std::string& fault : inspection.faults) faults.push_back(body.mesh.where.text() + ": " + fault);
  return faults;
}

/// All elements halved `file.refine` times. @throws InputError  too many; faults of the file. Collective.
void refine(const Body& body, Source& source) {
  constexpr double most = 1e7;  // every rank holds them all
  const int times = body.mesh.file->refine;
  if (times == 0) return;
  if (const double elements = std::ldexp(static_cast<double>(source.mesh.cell_count), 2 * times); elements > most)
    throw InputError(
        fmt::format("{}.file.refine: is {}, which makes up to {:.3g} elements of {}; expected at most {:g}",
                    body.mesh.where.text(), times, elements, source.mesh.cell_count, most));
  if (const auto faults = faults_of(body, inspected(source)); !faults.empty()) throw InputError(faults);
  std::vector<generate::Halved> parts(source.mesh.parts.size(), generate::Halved::all);
  for (const auto& [part, section] : source.parts) parts[part] = division_of(section);
  mesh::RawMesh whole = on_every_rank(source.mesh);
  for (int i = 0; i < times; ++i) whole = generate::halved(whole, source.dependent_nodes, parts);
  const auto undivided = std::count_if(whole.cells.begin(), whole.cells.end(), [&](const mesh::Cell& cell) {
    return cell.kind == mesh::CellKind::line && parts[cell.part] != generate::Halved::all &&
           std::max(cell.nodes[0], cell.nodes[1]) < source.mesh.node_count;
  });
  if (undivided > 0)
    source.notices.push_back(fmt::format("refine: {} beams with released ends remain whole", undivided));
  source.mesh = mesh::share_of_whole(whole);
}

Source read_file(const Body& body, MPI_Comm comm) {
  const MeshFileSpec& file = *body.mesh.file;
  Source source;
  const bool gmsh = file.path.ends_with(".msh"), inp = file.path.ends_with(".inp"),
             nastran = mesh::is_nastran(file.path);
  if (!inp && !file.instance.empty())
    throw InputError(fmt::format("{}.file.instance: is \"{}\"; only decks of Abaqus (.inp) have instances",
                                 body.mesh.where.text(), file.instance));
  if (gmsh || inp || nastran) refuse_missing(body, comm);
  if (gmsh) {
    mesh::GmshFile read = mesh::read_gmsh(comm, file.path, request_of(body).parts, request_of(body).section);
    source = {std::move(read.mesh), {}, std::move(read.notices)};
  } else if (inp || nastran) {
    mesh::DeckFile read =
        inp ? mesh::read_inp(comm, file.path, request_of(body)) : mesh::read_nastran(comm, file.path, request_of(body));
    DeckSections deck = deck_sections(read);
    std::vector<std::string> notices = deck_notices(read, deck, named_parts(body), file.scale);
    notices.insert(notices.begin(), read.notices.begin(), read.notices.end());
    for (mesh::PointMass& mass : read.deck.masses) mass.offset *= file.scale;
    add_masses(read, deck.parts);
    if (const PetscInt omitted = omit_springs_without_stiffness(read.mesh.comm, read.deck.springs); omitted > 0)
      notices.push_back(fmt::format("{} spring{} without stiffness {} omitted", omitted, omitted > 1 ? "s" : "",
                                    omitted > 1 ? "are" : "is"));
    add_springs(read.mesh, read.deck.springs, deck.parts);
    std::vector<mesh::DependentNode> dependent_nodes = mesh::dependent_nodes(read.mesh, read.deck);
    source = {std::move(read.mesh),       std::move(deck.parts),  std::move(notices),
              std::move(dependent_nodes), std::move(deck.points), true};
  } else {
    throw InputError(fmt::format("{}.file.path: is \"{}\"; expected a file that ends in .msh, .inp, .bdf, .nas or .dat",
                                 body.mesh.where.text(), file.path));
  }
  for (Eigen::Vector3d& x : source.mesh.positions) x *= file.scale;
  refine(body, source);
  return source;
}

Source generated(const Body& body, MPI_Comm comm) {
  if (body.mesh.plate) {
    const PlateSpec& spec = *body.mesh.plate;
    generate::Plate plate;
    plate.origin = vector(spec.origin);
    plate.a = vector(spec.along), plate.b = vector(spec.across);
    plate.na = spec.elements[0], plate.nb = spec.elements[1];
    plate.cells = spec.cells == PlateSpec::Cells::triangles ? generate::ShellCells::triangles
                                                            : generate::ShellCells::quadrilaterals;
    return {generate::plate(comm, plate), {}, {}};
  }
  generate::Polyline line;
  for (const Point& p : body.mesh.points) line.points.push_back(vector(p));
  line.segments = body.mesh.segments;
  line.elements.assign(body.mesh.elements.begin(), body.mesh.elements.end());
  return {generate::polyline(comm, line), {}, {}};
}

Source whole_source(const Body& body, MPI_Comm comm) {
  if (body.mesh.file) return read_file(body, comm);
  try {
    return generated(body, comm);
  } catch (const InputError& error) {
    throw InputError(body.mesh.where.text() + ": " + error.what());
  }
}

Source raw_mesh(const Body& body, MPI_Comm comm) {
  Source source = whole_source(body, comm);
  if (!body.mesh.piece) return source;
  source.mesh = piece_of(on_every_rank(source.mesh), *body.mesh.piece, source.dependent_nodes);
  if (body.mesh.piece->number > 0) source.notices.clear();  // those of the whole file
  return source;
}

void refuse_faults(const Body& body, const mesh::Inspection& inspection) {
  std::vector<std::string> faults = faults_of(body, inspection);
  if (inspection.component_count > 1) {
    std::vector<std::string> pieces;
    for (const mesh::Component& piece : inspection.components)
      pieces.push_back(fmt::format("{} nodes about node {}", piece.nodes, piece.label));
    faults.push_back(
        fmt::format("{}: the mesh has {} unconnected parts ({}{}), so that {} rigid motions are free; expected "
                    "one connected mesh (join them by common nodes)",
                    body.mesh.where.text(), inspection.component_count, fmt::join(pieces, ", "),
                    inspection.component_count > static_cast<PetscInt>(pieces.size()) ? ", ..." : "",
                    6 * (inspection.component_count - 1)));
  }
  if (!faults.empty()) throw InputError(faults);
}

/// A section for each part of the mesh, and where its stresses are taken.
struct Sections {
  std::vector<fem::Section> of_parts;
  std::vector<fem::StressPoints> points;
};

/// The scene's by name, the deck's, the scene's for all.
Sections sections_of(const Body& body, const Source& source) {
  Sections sections;
  const auto add = [&](const fem::Section& section, const fem::StressPoints& points) {
    sections.of_parts.push_back(section), sections.points.push_back(points);
  };
  std::vector<std::string> faults;
  const auto find = [&](const std::vector<PartSpec>& specs, const std::string& name) {
    return std::find_if(specs.begin(), specs.end(), [&](const PartSpec& spec) { return spec.part == name; });
  };
  for (std::size_t number = 0; number < source.mesh.parts.size(); ++number) {
    const std::string& part = source.mesh.parts[number];
    auto spec = find(body.parts, part);
    if (spec == body.parts.end()) {
      if (const auto own = source.parts.find(static_cast<int>(number)); own != source.parts.end()) {
        const auto points = source.points.find(static_cast<int>(number));
        add(own->second, points == source.points.end() ? fem::StressPoints{} : points->second);
        continue;
      }
      spec = find(body.parts, "");
    }
    if (spec == body.parts.end())
      faults.push_back(
          fmt::format("{}: no section for part \"{}\" of the mesh; expected section, or parts: {{{}: ...}}",
                      body.where.text(), part, part));
    else
      add(spec->section, spec->points);
  }
  for (const PartSpec& spec : body.parts) {
    std::vector<std::string> known;
    for (const std::string& part : source.mesh.parts)
      if (std::find(known.begin(), known.end(), part) == known.end()) known.push_back(part);
    if (spec.part.empty() || std::count(known.begin(), known.end(), spec.part) > 0) continue;
    const std::string near = math::nearest(spec.part, known);
    faults.push_back(fmt::format("{}: the mesh has no part \"{}\"; expected one of {}{}", spec.where.text(), spec.part,
                                 fmt::join(known, ", "), near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }
  if (!faults.empty()) throw InputError(faults);
  return sections;
}

/// The maximum membrane stiffness of the shells [N/m].
double membrane_stiffness(const Sections& sections) {
  double A = 0;
  for (const fem::Section& section : sections.of_parts)
    if (const auto* shell = std::get_if<fem::ShellSection>(&section)) A = std::max(A, shell->A.diagonal().maxCoeff());
  return A;
}

/// Gives all elements the strains that the scene asks for, or by default those that their geometry calls for.
/// @return which, and of a default the number that decides. Collective.
std::string take_strains(const Body& body, const fem::Mesh& mesh, std::vector<fem::Section>& sections) {
  const bool averaged = body.strain == Strain::averaged;
  fem::Strains strains = body.strains.value_or(fem::Strains::von_karman);
  std::string text = strains == fem::Strains::second_order ? "second_order" : "von_karman";
  if (!body.strains && averaged && !body.rigid) {
    const fem::StrainsChoice choice = fem::default_strains(mesh, sections);
    strains = choice.strains();
    text = choice.text();
  }
  for (fem::Section& section : sections) {
    if (auto* beam = std::get_if<fem::SpatialBeam>(&section)) {
      beam->strain.membrane = averaged ? fem::MembraneStrain::averaged : fem::MembraneStrain::pointwise;
      beam->strain.strains = strains;
    }
    if (auto* shell = std::get_if<fem::ShellSection>(&section)) shell->strains = strains;
  }
  return text;
}

/// Union over the ranks, ascending. Collective.
std::vector<PetscInt> gathered(MPI_Comm comm, const std::vector<PetscInt>& mine) {
  std::vector<PetscInt> all = petsc::of_all_ranks(comm, mine);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Places on every rank, nodes ascending. Collective.
mesh::NodeSets places_of(const mesh::RawMesh& mesh) {
  mesh::NodeSets places;
  for (std::size_t p = 0; p < mesh.places.size(); ++p)
    places[mesh.places[p]].nodes = gathered(mesh.comm, mesh.place_nodes[p]);
  for (const auto& [name, mine] : mesh.place_weights) {
    std::vector<mesh::NodeWeight> all = petsc::of_all_ranks(mesh.comm, mine);
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
    for (const mesh::NodeWeight& at : all) places[name].weights.push_back(at.weight);
  }
  return places;
}

/// The place `middle` of what is one line from start to end. Collective.
void add_middle(const Body& body, SpatialMesh& found) {
  if (body.mesh.piece || !has_middle(body.mesh)) return;
  Place middle;
  middle.name = "middle";
  found.places["middle"].nodes = {fem::nearest_node(found.structure.mesh, vector(place_point(body.mesh, middle))).node};
}

}  // namespace

WholeMesh whole_mesh(const Body& body, MPI_Comm comm) {
  Source source = whole_source(body, comm);
  return {on_every_rank(source.mesh), std::move(source.dependent_nodes)};
}

SpatialMesh spatial_mesh(const Scene& scene, const Body& body, MPI_Comm comm) {
  Source source = raw_mesh(body, comm);
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  mesh::NodeSets places = places_of(source.mesh);
  add_masses(body, places, source.mesh, source.parts);
  if (has_straight_edges(scene, body))
    add_straight_edges(scene, body, places, membrane_stiffness(sections_of(body, source)), source.mesh, source.parts);
  refuse_loose_edges(scene, body, source.dependent_nodes, places, source.mesh);
  source.dependent_nodes = with_independent_nodes(scene, body, source.mesh, source.dependent_nodes, places);
  std::vector<std::string> left_out;
  source.dependent_nodes =
      mesh::with_lines(mesh::with_pieces(source.dependent_nodes, rigid_pieces(scene, body, places)),
                       hinge_lines(scene, body, source.mesh, places, source.notices),
                       constrained_elsewhere(scene, body, places), &left_out);
  report_left_out(scene, left_out, source.notices);
  std::vector<std::array<PetscInt, 2>> linked;
  for (const mesh::DependentNode& f : source.dependent_nodes)
    if (rank == 0) linked.push_back({f.node, f.independent_node});
  const mesh::Inspection inspection = inspected(source, linked);
  refuse_faults(body, inspection);
  auto [sections, points] = sections_of(body, source);
  int size = 1;
  MPI_Comm_size(comm, &size);
  const std::vector<int> ranks =
      size > 1 ? mesh::partition(source.mesh) : std::vector<int>(source.mesh.positions.size(), 0);
  fem::Mesh mesh = fem::mesh_of(source.mesh, ranks, source.dependent_nodes);
  for (auto& [name, place] : places) place.nodes = fem::global_nodes(mesh, place.nodes);
  const std::string strains = take_strains(body, mesh, sections);
  const auto strain = body.strain == Strain::averaged ? fem::MembraneStrain::averaged : fem::MembraneStrain::pointwise;
  try {
    SpatialMesh found{fem::Structure(std::move(mesh), std::move(sections), strain),
                      std::move(places),
                      source.mesh.parts,
                      {},
                      strains,
                      std::move(points)};
    found.notices = std::move(source.notices);
    add_middle(body, found);
    found.notices.insert(found.notices.end(), inspection.notices.begin(), inspection.notices.end());
    return found;
  } catch (const InputError& error) {
    throw InputError(body.where.text() + ": " + error.what());
  }
}

}  // namespace floe::plan
