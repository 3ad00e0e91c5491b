#pragma once
#include <filesystem>

#include "floe/assembly/model.h"
#include "floe/reduction/condensation.h"

namespace floe::assembly {

/// A body on its reduced coordinates (none for a rigid one).
struct ReducedBody {
  body::FlexibleBody body;
  std::shared_ptr<reduction::Basis> basis;
  Eigen::MatrixXd damping;    ///< modal; of a body from a file all but Kelvin-Voigt; k x k, or empty
  Eigen::MatrixXd of_fields;  ///< coordinates of the generating fields from those of V; ranking's linear run only
  BodyReport report;
  std::shared_ptr<const reduction::Statics> statics = {};  ///< if they were to be kept
  reduction::Relief relief = {};                           ///< likewise
  double strain_rate_damping = 0;                          ///< beta of a body from a file [s]
};

/// How a place of a reduced body moves with the body's coordinates. Collective; replicated.
body::PlaceMap place_map(const Plan& plan, const ReducedBody& reduced, const Anchor& place);

/// What a model is assembled for: of residuals the start is as the initial states of the bodies give it, without the
/// equilibrium or steady rotation that a motion begins in, nor consistent velocities. With elements apart those of
/// full-order bodies in space are not among the system's terms, but Model::elements.
enum class Purpose { motion, residuals, residuals_of_elements_apart };

/// The planned scene on its bodies in a formulation. @param reduced  as PlanarAssembly, SpatialAssembly
/// Collective.
Model assemble(const Plan& plan, Formulation formulation, const std::vector<ReducedBody>& reduced,
               Purpose purpose = Purpose::motion);

/// Runs linear and reads off int |eta_i eta_j| dt of each body's generators, eta = of_fields q: needed for derivatives
/// chosen by count.
using InteractionRun = std::function<std::vector<Eigen::MatrixXd>(const std::vector<ReducedBody>&)>;

/// Offline stage of every body. Collective.
/// @param warnings      receives what the user should know of the choice of basis vectors
/// @param keep_statics  with the factor of each body; `plan` must stay where it is
std::vector<ReducedBody> reduce_bodies(const Plan& plan, Formulation formulation, const InteractionRun& linear_run,
                                       std::vector<std::string>& warnings, bool keep_statics = false);

/// Modes, attachment modes and derivatives of a body, before they become a basis; in the frame, modes M-normalised.
struct BodyFields {
  reduction::Columns columns;
  std::vector<reduction::ColumnOrigin> origins;
  BodyReport report;
};
/// Of a body with a mesh that is not rigid; derivatives that are chosen by count: all. Collective.
BodyFields fields_of_body(const Plan& plan, int index);

/// The first stage alone: modes and their residuals. Collective.
std::vector<BodyReport> modes_of_bodies(const Plan& plan);

/// A body from its file in a formulation: as it is (vm+md); on its modes and attachment columns alone (vm), which span
/// the first coordinates because the basis was orthonormalised in this order; with the linear part of its elastic force
/// (lffr).
/// @throws InputError  vm: a derivative stands before a mode. Rank-local; the same everywhere.
ReducedBody from_file(const PlannedBody& body, Formulation formulation);

/// Writes a body on its basis vectors into a file, with its basis at every node. @param body  of `plan`. Collective.
void write_body(const Plan& plan, const PlannedBody& body, const ReducedBody& reduced,
                const std::filesystem::path& path, bool overwrite);

/// The mass of a body that does not deform. Collective.
ReducedBody rigid(const PlannedBody& body);

}  // namespace floe::assembly
