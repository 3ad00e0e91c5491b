#include "floe/mesh/write_gmsh.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "floe/mesh/members.h"
#include "gathered_file.h"
#include "text.h"

namespace floe::mesh {
namespace {

// Numbers of the format in text or in bytes.
class GmshNumbers {
 public:
  explicit GmshNumbers(bool binary) : binary_(binary) {}
  void integer(std::string& to, int value) const { put(to, value); }
  void count(std::string& to, long long value) const { put(to, value); }
  void real(std::string& to, double value) const { put(to, value); }
  void end_line(std::string& to) const {
    if (!binary_) to += '\n';
  }

 private:
  template <class Value>
  void put(std::string& to, Value value) const {
    if (binary_) {
      to.append(reinterpret_cast<const char*>(&value), sizeof value);
      return;
    }
    char text[32];
    to.append(text, std::to_chars(text, text + sizeof text, value).ptr);
    to += ' ';
  }
  bool binary_;
};

int dimension_of(CellKind kind) { return std::min(corner_count(kind) - 1, 2); }
int type_of(CellKind kind) {
  switch (kind) {
    case CellKind::point:
      return 15;
    case CellKind::line3:
      return 8;
    case CellKind::triangle6:
      return 9;
    case CellKind::quadrilateral8:
      return 16;
    default:
      return node_count(kind) - 1;
  }
}

// Consecutive cells of one part and kind.
struct Run {
  PetscInt first;
  int part;
  CellKind kind;
};

// Of all ranks, the same on all. Collective.
std::vector<Run> runs_of(const RawMesh& mesh) {
  std::vector<Run> mine;
  const auto continues = [](const std::vector<Run>& runs, const Run& run) {
    return !runs.empty() && runs.back().part == run.part && runs.back().kind == run.kind;
  };
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const Run run{mesh.first_cell + static_cast<PetscInt>(i), mesh.cells[i].part, mesh.cells[i].kind};
    if (!continues(mine, run)) mine.push_back(run);
  }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<Run> to_all, runs;
  for (int r = 0; r < ranks; ++r) to_all.insert(to_all.end(), mine.begin(), mine.end());
  const auto all = exchange(mesh.comm, to_all, std::vector<int>(ranks, static_cast<int>(mine.size()))).values;
  for (const Run& run : all)
    if (!continues(runs, run)) runs.push_back(run);
  return runs;
}

// A physical group, the one entity in it and their common number.
struct Group {
  int dimension, tag;
  std::string name;
};

class Writer {
 public:
  Writer(const std::string& path, const RawMesh& mesh, bool binary)
      : mesh_(mesh), binary_(binary), numbers_(binary), runs_(runs_of(mesh)) {
    find_places();
    find_groups();
    file_.emplace(mesh.comm, path);
  }

  void write() {
    write_head();
    write_entities();
    write_nodes();
    write_elements();
    file_->close();
  }

 private:
  void find_places() {
    for (const auto& nodes : mesh_.place_nodes) {
      members_.push_back(told_members(mesh_, nodes));
      const auto count = static_cast<long long>(members_.back().size());
      MPI_Allreduce(&count, &member_counts_.emplace_back(), 1, MPI_LONG_LONG, MPI_SUM, mesh_.comm);
    }
  }

  int place_tag(std::size_t place) const { return static_cast<int>(mesh_.parts.size() + place + 1); }

  void find_groups() {
    std::vector<int> dimension(mesh_.parts.size(), -1);
    for (const Run& run : runs_) {
      int& known = dimension[run.part];
      if (known >= 0 && known != dimension_of(run.kind))
        throw InputError("part " + in_quotes(mesh_.parts[run.part]) + " has elements of several dimensions");
      known = dimension_of(run.kind);
    }
    for (std::size_t p = 0; p < dimension.size(); ++p)
      if (dimension[p] >= 0) groups_.push_back({dimension[p], static_cast<int>(p) + 1, mesh_.parts[p]});
    for (std::size_t p = 0; p < members_.size(); ++p)
      if (member_counts_[p] > 0) groups_.push_back({0, place_tag(p), mesh_.places[p]});
    for (const Group& group : groups_)
      if (group.name.empty() || group.name.find_first_of("\"\r\n") != std::string::npos)
        throw InputError("the name " + in_quotes(group.name) + " cannot be that of a physical group");
    std::stable_sort(groups_.begin(), groups_.end(),
                     [](const Group& a, const Group& b) { return a.dimension < b.dimension; });
  }

  void write_head() {
    std::string text = binary_ ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n4.1 0 8\n";
    if (binary_) numbers_.integer(text, 1), text += '\n';
    text += "$EndMeshFormat\n$PhysicalNames\n" + std::to_string(groups_.size()) + "\n";
    for (const Group& group : groups_)
      text += std::to_string(group.dimension) + " " + std::to_string(group.tag) + " \"" + group.name + "\"\n";
    file_->add(text + "$EndPhysicalNames\n");
  }

  void write_entities() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Eigen::Array3d low = Eigen::Array3d::Constant(infinity), high = -low;
    for (const auto& x : mesh_.positions) {
      low = low.min(x.array());
      high = high.max(x.array());
    }
    MPI_Allreduce(MPI_IN_PLACE, low.data(), 3, MPI_DOUBLE, MPI_MIN, mesh_.comm);
    MPI_Allreduce(MPI_IN_PLACE, high.data(), 3, MPI_DOUBLE, MPI_MAX, mesh_.comm);
    std::string text = "$Entities\n";
    for (int dimension = 0; dimension < 4; ++dimension)
      numbers_.count(text, std::count_if(groups_.begin(), groups_.end(),
                                         [&](const Group& group) { return group.dimension == dimension; }));
    numbers_.end_line(text);
    for (const Group& group : groups_) {
      numbers_.integer(text, group.tag);
      for (const double x : low) numbers_.real(text, x);
      for (int axis = 0; axis < 3 && group.dimension > 0; ++axis) numbers_.real(text, high[axis]);
      numbers_.count(text, 1);
      numbers_.integer(text, group.tag);
      if (group.dimension > 0) numbers_.count(text, 0);
      numbers_.end_line(text);
    }
    file_->add(text + "\n$EndEntities\n");
  }

  // Least and greatest label of all ranks. Collective.
  std::array<long long, 2> range_of(const std::vector<long long>& labels) const {
    std::array<long long, 2> range{std::numeric_limits<long long>::max(), 0};
    for (const long long label : labels) range = {std::min(range[0], label), std::max(range[1], label)};
    MPI_Allreduce(MPI_IN_PLACE, &range[0], 1, MPI_LONG_LONG, MPI_MIN, mesh_.comm);
    MPI_Allreduce(MPI_IN_PLACE, &range[1], 1, MPI_LONG_LONG, MPI_MAX, mesh_.comm);
    return range;
  }

  void write_nodes() {
    const auto [least, greatest] = range_of(mesh_.node_labels);
    std::string text = "$Nodes\n";
    for (const long long value : {1LL, static_cast<long long>(mesh_.node_count), least, greatest})
      numbers_.count(text, value);
    numbers_.end_line(text);
    const Group& home = groups_.back();  // of the highest dimension
    for (const int value : {home.dimension, home.tag, 0}) numbers_.integer(text, value);
    numbers_.count(text, mesh_.node_count);
    numbers_.end_line(text);
    file_->add(text);
    file_->add_all(mesh_.node_labels.size(), [&](std::size_t i, std::string& to) {
      numbers_.count(to, mesh_.node_labels[i]);
      numbers_.end_line(to);
    });
    file_->add_all(mesh_.positions.size(), [&](std::size_t i, std::string& to) {
      for (const double x : mesh_.positions[i]) numbers_.real(to, x);
      numbers_.end_line(to);
    });
    file_->add("\n$EndNodes\n");
  }

  void begin_block(std::string& text, int dimension, int tag, int type, long long count) const {
    for (const int value : {dimension, tag, type}) numbers_.integer(text, value);
    numbers_.count(text, count);
    numbers_.end_line(text);
  }

  // Labels of the nodes of this rank's cells, one cell after the other. Collective.
  std::vector<long long> corner_labels() const {
    std::vector<PetscInt> nodes;
    for (const auto& cell : mesh_.cells)
      nodes.insert(nodes.end(), cell.nodes.begin(), cell.nodes.begin() + node_count(cell.kind));
    const auto starts = starts_of(mesh_.comm, static_cast<PetscInt>(mesh_.positions.size()));
    return ask<long long>(
        mesh_.comm, nodes, [&](PetscInt node) { return owner_of(starts, node); },
        [&](PetscInt node) { return mesh_.node_labels[node - mesh_.first_node]; });
  }

  void write_elements() {
    const auto [least, greatest] = range_of(mesh_.cell_labels);
    long long members = 0;
    for (const long long count : member_counts_) members += count;
    const auto places = std::count_if(member_counts_.begin(), member_counts_.end(), [](long long n) { return n > 0; });
    std::string text = "$Elements\n";
    for (const long long value :
         {static_cast<long long>(runs_.size()) + places, mesh_.cell_count + members, least, greatest + members})
      numbers_.count(text, value);
    numbers_.end_line(text);
    file_->add(text);
    write_cells();
    write_members(greatest + 1);
    file_->add("\n$EndElements\n");
  }

  void write_cells() {
    const auto corners = corner_labels();
    std::size_t next = 0;
    auto run = std::lower_bound(runs_.begin(), runs_.end(), mesh_.first_cell,
                                [](const Run& r, PetscInt first) { return r.first < first; });
    file_->add_all(mesh_.cells.size(), [&](std::size_t i, std::string& to) {
      const auto& cell = mesh_.cells[i];
      if (run != runs_.end() && run->first == mesh_.first_cell + static_cast<PetscInt>(i)) {
        const PetscInt end = std::next(run) == runs_.end() ? mesh_.cell_count : std::next(run)->first;
        begin_block(to, dimension_of(cell.kind), cell.part + 1, type_of(cell.kind), end - run->first);
        ++run;
      }
      numbers_.count(to, mesh_.cell_labels[i]);
      for (int k = 0; k < node_count(cell.kind); ++k) numbers_.count(to, corners[next++]);
      numbers_.end_line(to);
    });
  }

  // An element of one node for each member of each place.
  void write_members(long long label) {
    for (std::size_t p = 0; p < members_.size(); ++p) {
      if (member_counts_[p] == 0) continue;
      const auto& nodes = members_[p];
      const auto count = static_cast<long long>(nodes.size());
      long long end = 0;
      MPI_Scan(&count, &end, 1, MPI_LONG_LONG, MPI_SUM, mesh_.comm);
      const long long first = label + end - count;
      std::string text;
      begin_block(text, 0, place_tag(p), type_of(CellKind::point), member_counts_[p]);
      file_->add(text);
      file_->add_all(nodes.size(), [&](std::size_t i, std::string& to) {
        numbers_.count(to, first + static_cast<long long>(i));
        numbers_.count(to, mesh_.node_labels[nodes[i] - mesh_.first_node]);
        numbers_.end_line(to);
      });
      label += member_counts_[p];
    }
  }

  const RawMesh& mesh_;
  bool binary_;
  GmshNumbers numbers_;
  std::vector<Run> runs_;
  std::vector<std::vector<PetscInt>> members_;  // of each place, in this rank's share
  std::vector<long long> member_counts_;        // of all ranks
  std::vector<Group> groups_;                   // by dimension
  std::optional<GatheredFile> file_;
};

}  // namespace

void write_gmsh(const std::string& path, const RawMesh& mesh, GmshEncoding encoding) {
  if (mesh.cell_count == 0) throw InputError(path + ": a mesh without elements is not written");
  Writer(path, mesh, encoding == GmshEncoding::binary).write();
}

}  // namespace floe::mesh
