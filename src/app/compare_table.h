#pragma once
#include <optional>
#include <string>
#include <vector>

#include "floe/assess/probe_errors.h"
#include "floe/output/table.h"
#include "run.h"

namespace floe::app {

/// One run of a comparison.
struct Compared {
  std::string name;  ///< `vm+md`
  RunResult result;
  std::string refined = "mesh and step halved";  ///< of the run that shows the reference's own error
};

/// sqrt(sum (p - r)^2 / sum r^2) for each column; the reference is taken at the times of `series` by linear
/// interpolation. None where the reference's root mean square is below 1e-9 of its probe's, or the probe's below what
/// assess::reference_sizes asks for: there it is round-off.
std::vector<std::optional<double>> relative_errors(const Series& series, const Series& reference);

/// Root mean square of each probe as a vector, relative (assess::ProbeErrors), in the order of `probes`.
std::vector<double> vector_errors(const Series& series, const Series& reference);
/// Greatest |p - r| over the greatest |r| of each probe as a vector (assess::reference_sizes), likewise.
std::vector<double> peak_errors(const Series& series, const Series& reference);
/// The greatest of them; 0: no probes.
double worst_error(const Series& series, const Series& reference);

/// sqrt(sum (e - r)^2 / sum r^2) of the energy that moves and deforms, kinetic and elastic.
std::optional<double> relative_energy_error(const Series& series, const Series& reference);

/// `tip` of the columns `tip.x`, `tip.y`: each probe once, in order.
std::vector<std::string> probes(const std::vector<assembly::ProbeColumn>& columns);

/// A row each for `rows`, for those that failed (by name) and, when there is one, for the run that shows the
/// reference's own error; errors in per cent against each reference, of the components or of the probes as vectors.
output::Table comparison(const std::vector<Compared>& rows, const std::vector<const Compared*>& references,
                         const std::vector<std::string>& failed, const Compared* own, bool components);

/// For a terminal of so many characters: errors of the components where that fits, else of the probes as vectors, else
/// of these against the first reference alone.
std::string comparison_text(const std::vector<Compared>& rows, const std::vector<const Compared*>& references,
                            const std::vector<std::string>& failed, const Compared* own, int columns);

}  // namespace floe::app
