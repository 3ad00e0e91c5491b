#include "join.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "floe/error.h"
#include "floe/mesh/exchange.h"
#include "floe/mesh/members.h"
#include "floe/petsc/error.h"

namespace floe::generate {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A node in a box of the hashed grid.
struct Entry {
  std::array<double, 3> box, x;
  PetscInt node;
};

struct Match {
  double distance = infinity;
  PetscInt node = -1;
  auto operator<=>(const Match&) const = default;
};

double box_of(double x, double size) { return std::floor(x / size) + 0.0; }  // + 0: -0 is 0

int rank_of(const Entry& entry, int ranks) {
  constexpr std::uint64_t prime = 1099511628211ULL, golden = 0x9E3779B97F4A7C15ULL;
  std::uint64_t hash = 14695981039346656037ULL;
  for (const double coordinate : entry.box) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * prime;
    hash = (hash ^ (hash >> 32)) * golden;
  }
  return static_cast<int>((hash >> 16) % static_cast<std::uint64_t>(ranks));
}

Entry entry_of(const RawMesh& mesh, PetscInt node) {
  const auto& x = mesh.positions[node - mesh.first_node];
  return {{}, {x[0], x[1], x[2]}, node};
}

// Every box, of edge 2 tolerance, that a node of the other mesh could be in: 1 to 8.
void add_near(Entry entry, double tolerance, std::vector<Entry>& questions) {
  for (int k = 0; k < 8; ++k) {
    bool fresh = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box_of(entry.x[axis] - tolerance, 2 * tolerance);
      const double high = box_of(entry.x[axis] + tolerance, 2 * tolerance);
      const bool up = (k >> axis) & 1;
      fresh = fresh && (!up || high != low);
      entry.box[axis] = up ? high : low;
    }
    if (fresh) questions.push_back(entry);
  }
}

Match nearest(const std::vector<Entry>& sorted, const Entry& question, double tolerance) {
  const auto before = [](const Entry& a, const Entry& b) { return a.box < b.box; };
  Match best;
  const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), question, before);
  for (auto entry = begin; entry != end; ++entry) {
    const double distance =
        std::hypot(entry->x[0] - question.x[0], entry->x[1] - question.x[1], entry->x[2] - question.x[2]);
    if (distance <= tolerance) best = std::min(best, Match{distance, entry->node});
  }
  return best;
}

// Joins along one seam; returns how many this rank joined. Collective.
PetscInt join(const RawMesh& first, const RawMesh& second, const Seam& seam, double tolerance,
              std::vector<Match>& matches) {
  int ranks = 1;
  MPI_Comm_size(first.comm, &ranks);
  const auto to_rank = [ranks](const Entry& entry) { return rank_of(entry, ranks); };
  std::vector<Entry> entries, questions;
  for (const PetscInt node : members_of(first, seam.of_first)) {
    Entry entry = entry_of(first, node);
    for (int axis = 0; axis < 3; ++axis) entry.box[axis] = box_of(entry.x[axis], 2 * tolerance);
    entries.push_back(entry);
  }
  auto kept = scatter(first.comm, entries, to_rank).values;
  std::sort(kept.begin(), kept.end(), [](const Entry& a, const Entry& b) { return a.box < b.box; });
  for (const PetscInt node : members_of(second, seam.of_second)) add_near(entry_of(second, node), tolerance, questions);
  const auto answers = ask<Match>(first.comm, questions, to_rank,
                                  [&](const Entry& question) { return nearest(kept, question, tolerance); });
  PetscInt count = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    Match& match = matches[questions[i].node - second.first_node];
    count += answers[i].node >= 0;
    match = std::min(match, answers[i]);
  }
  return count;
}

// No two nodes of the second mesh may become the same of the first. Collective.
void refuse_collapsed(const RawMesh& first, const std::vector<Match>& matches) {
  std::vector<PetscInt> used;
  for (const Match& match : matches)
    if (match.node >= 0) used.push_back(match.node);
  const auto starts = starts_of(first.comm, static_cast<PetscInt>(first.positions.size()));
  auto here = scatter(first.comm, used, [&](PetscInt node) { return owner_of(starts, node); }).values;
  std::sort(here.begin(), here.end());
  petsc::agree(first.comm, [&] {
    const auto twice = std::adjacent_find(here.begin(), here.end());
    if (twice != here.end())
      throw InputError("merged: two nodes are within the tolerance of node " +
                       std::to_string(first.node_labels[*twice - first.first_node]) + " of " + first.source +
                       ": choose a smaller one");
  });
}

}  // namespace

std::vector<PetscInt> joined_to(const RawMesh& first, const RawMesh& second, const std::vector<Seam>& seams,
                                double tolerance) {
  std::vector<Match> matches(second.positions.size());
  for (const Seam& seam : seams) {
    PetscInt count = join(first, second, seam, tolerance, matches), all = 0;
    MPI_Allreduce(&count, &all, 1, MPIU_INT, MPI_SUM, first.comm);
    if (all == 0)
      throw InputError("merged: no node of '" + seam.of_second + "' is within the tolerance of a node of '" +
                       seam.of_first + "'");
  }
  refuse_collapsed(first, matches);
  std::vector<PetscInt> nodes;
  for (const Match& match : matches) nodes.push_back(match.node);
  return nodes;
}

}  // namespace floe::generate
