#pragma once
#include <string>
#include <vector>

#include "floe/assembly/mode_warnings.h"
#include "floe/assess/estimate.h"

namespace floe::assess {

/// A model that has left the range in which it is good: one line with the number, the limit and what to do.
struct OutOfRange {
  std::string what;  ///< `slope`, `mesh`, `spin`, `shortening`, `membrane`, `load`, `step`, `in-plane`, ...
  std::string of;    ///< of a body or a load; `gravity`, `ground.acceleration`
  double value = 0, limit = 0;
  std::string text;
};

/// What the states of a motion say about the model that made them.
///
///   slope       of a body's line or surface in its frame, against von Karman's moderate rotations: the error of its
///   tip
///               over its length, limit 1 %; of beams from slopes and moments along the line, all frames of a split
///               body together (rotation_error in src/scene/moderate_rotations.h); of shells, at the maximum slope s,
///               about 0.1 s^3 in a tangent frame and 0.03 s^4 in another one: the middle of what moments (0.04, 0.008)
///               and forces (0.27, 0.14) of beams have
///   mesh        how far shells bend within single elements, of how far they are bent (fem::intra_deflections
///   element) where the slope is maximum;
///               limit 5 %, a wave of ten elements
///   shortening  s^2/2, which a linear elastic force neglects (lffr); limit 1 %
///   spin        of a body's frame against its first frequency, where no column can stretch with the bending (lffr, or
///               no derivatives): its stiffness falls by (Omega/omega)^2; limit 0.2
///   membrane    energy over that of bending, without derivatives to relieve it; limit 2 %
///   in-plane, coupling
///               what strains leave out at second order (fem::MissingStiffness): quadratic strains of shells in their
///               plane, coupling of bending with torsion; its work against the stiffness, along the deformation or in
///               the shape that it changes most; limit 5 %.
///               `unchecked`: K could not be solved with
///   rotary      (Omega/omega)^2 of a reduced body from a file without Inertia::W: the most that rotary inertia of
///               second order can change of its stiffness; limit 5 %
///   load        rms rate over rms value of a load, gravity or the ground's acceleration against the highest kept
///               frequency; limit 0.5
///   step        times the fastest rate of what moves (rms rate of the deformations over their rms, loads); limit 0.25,
///               25 steps a period: generalised-alpha then lengthens periods by half a per cent
///
/// Collective on the communicator of the scene.
/// @param unchecked  what could not be checked, and why, as of bodies that have no modes
std::vector<OutOfRange> out_of_range(const Scene& scene, const Model& model, const KeptMotion& motion, MPI_Comm comm,
                                     std::string& unchecked);

/// What the shapes alone say: slope, shortening, mesh, membrane, in-plane, coupling, rotary; for equilibria. Collective
/// likewise.
std::vector<OutOfRange> shapes_out_of_range(const Model& model, const std::vector<solve::State>& states, MPI_Comm comm);

/// Whether the full-order model of the same mesh errs in it, too: slope, mesh, in-plane, coupling, tension.
bool also_of_full_order(const OutOfRange& one);

}  // namespace floe::assess
