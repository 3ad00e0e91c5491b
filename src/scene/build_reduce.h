#pragma once
#include "build_prepare.h"

namespace floe::scene {

/// A body on its reduced coordinates (none for a rigid one).
struct ReducedBody {
  body::FlexibleBody body;
  std::shared_ptr<reduction::Basis> basis;
  Eigen::MatrixXd damping;
  Eigen::MatrixXd of_fields;  ///< coordinates of the generating fields from those of V; ranking's linear run only
  BodyReport report;
};

/// Runs linear and reads off int |eta_i eta_j| dt of each body's generators, eta = of_fields q: needed for derivatives
/// chosen by count.
using InteractionRun = std::function<std::vector<Eigen::MatrixXd>(const std::vector<ReducedBody>&)>;

/// Offline stage of every body. Collective.
/// @param warnings  receives what the user should know of the choice of columns
std::vector<ReducedBody> reduce_bodies(const Prepared& prepared, Formulation formulation,
                                       const InteractionRun& linear_run, std::vector<std::string>& warnings);

/// The first stage alone: modes and their residuals. Collective.
std::vector<BodyReport> modes_of_bodies(const Prepared& prepared);

/// The mass of a body that does not deform. Collective.
ReducedBody rigid(const PreparedBody& body);

}  // namespace floe::scene
