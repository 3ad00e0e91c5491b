#include "stress_extremes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "floe/petsc/rank.h"

namespace floe::app {

using assess::BodyStress;
using assess::Singular;

namespace {

/// A peak as ranks exchange it.
struct Sent {
  double value, x[3];
  long long row, cell, singular, nodes[4];
};

/// Of equal stresses, as symmetric bodies have, the element that comes first in the mesh.
bool goes_before(const Sent& a, const Sent& b) {
  if (std::abs(a.value - b.value) > 1e-9 * std::max(a.value, b.value)) return a.value > b.value;
  return std::lexicographical_compare(a.nodes, a.nodes + 4, b.nodes, b.nodes + 4);
}

Peak greatest_of_all(const Extremes& own, const BodyStress& stress, bool regular, MPI_Comm comm) {
  Sent best{-1, {0, 0, 0}, 0, 0, 0, {0, 0, 0, 0}};
  for (std::size_t c = 0; c < own.von_mises.size(); ++c) {
    if (!(own.von_mises[c] >= 0) || (regular && stress.singular()[c] != Singular::none)) continue;
    const Eigen::Vector3d& x = stress.centres()[c];
    const auto& nodes = stress.cells()[c].nodes;
    const Sent one{own.von_mises[c],
                   {x[0], x[1], x[2]},
                   static_cast<long long>(own.row[c]),
                   static_cast<long long>(c),
                   static_cast<long long>(stress.singular()[c]),
                   {nodes[0], nodes[1], nodes[2], nodes[3]}};
    if (best.value < 0 || goes_before(one, best)) best = one;
  }
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<Sent> all(static_cast<std::size_t>(ranks));
  MPI_Allgather(&best, sizeof(Sent), MPI_BYTE, all.data(), sizeof(Sent), MPI_BYTE, comm);
  int rank = 0;
  for (int r = 1; r < ranks; ++r) {
    const Sent &one = all[static_cast<std::size_t>(r)], &so_far = all[static_cast<std::size_t>(rank)];
    if (one.value >= 0 && (so_far.value < 0 || goes_before(one, so_far))) rank = r;
  }
  const Sent& found = all[static_cast<std::size_t>(rank)];
  return {found.value, static_cast<std::size_t>(found.row),  static_cast<std::size_t>(found.cell),
          rank,        {found.x[0], found.x[1], found.x[2]}, static_cast<Singular>(found.singular)};
}

}  // namespace

Extremes find_extremes(const BodyStress& stress, const std::vector<std::size_t>& rows, MPI_Comm comm) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Extremes found;
  const std::size_t cells = stress.cells().size();
  found.von_mises.assign(cells, nan), found.greatest_principal.assign(cells, nan);
  found.least_principal.assign(cells, nan), found.row.assign(cells, 0);
  stress.evaluate(rows, [&](std::size_t cell, std::size_t first, const fem::SmallRows& values) {
    for (Eigen::Index t = 0; t < values.cols(); ++t) {
      const double mises = values(BodyStress::von_mises, t);
      if (mises >= 0 && !(mises <= found.von_mises[cell]))
        found.von_mises[cell] = mises, found.row[cell] = rows[first + static_cast<std::size_t>(t)];
      found.greatest_principal[cell] = std::fmax(found.greatest_principal[cell], values(BodyStress::stress_max, t));
      found.least_principal[cell] = std::fmin(found.least_principal[cell], values(BodyStress::stress_min, t));
    }
  });
  found.greatest = greatest_of_all(found, stress, false, comm);
  found.regular = greatest_of_all(found, stress, true, comm);
  return found;
}

std::vector<output::CellField> constant_fields() {
  return {{"von_mises_of_motion", 1, "Pa", "maximum of von_mises over all instants"},
          {"time_of_maximum", 1, "s", "when"},
          {"stress_max_of_motion", 1, "Pa", "maximum of stress_max"},
          {"stress_min_of_motion", 1, "Pa", "minimum of stress_min"},
          {"singular", 1, "",
           "0: none; 1: a joint or load at one node; 2: an end of an edge that a joint holds; 3: a re-entrant corner"}};
}

std::vector<double> constant_values(const Extremes& extremes, const BodyStress& stress,
                                    const std::vector<double>& times) {
  std::vector<double> values;
  for (std::size_t c = 0; c < extremes.von_mises.size(); ++c)
    values.insert(values.end(),
                  {extremes.von_mises[c],
                   extremes.von_mises[c] >= 0 ? times[extremes.row[c]] : std::numeric_limits<double>::quiet_NaN(),
                   extremes.greatest_principal[c], extremes.least_principal[c],
                   static_cast<double>(static_cast<int>(stress.singular()[c]))});
  return values;
}

std::string words_of(Singular singular) {
  switch (singular) {
    case Singular::point:
      return "singular: joint or load at one node; grows with refinement";
    case Singular::end_of_edge:
      return "singular: end of an edge that a joint fixes; grows with refinement";
    case Singular::corner:
      return "singular: re-entrant corner; grows with refinement";
    case Singular::none:
      break;
  }
  return "";
}

}  // namespace floe::app
