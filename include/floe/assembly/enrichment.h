#pragma once
#include "floe/assembly/offline.h"

namespace floe::assembly {

/// A residual load in a deformation V eta.
struct ResidualLoad {
  petsc::VecHandle load;
  Eigen::VectorXd eta;
};

/// What the loads do to a body, x = K_T(V eta)^-1 P' f: K_T is that of the maximum deformation, of up to `tangents`
/// unlike ones where they differ much, and of rest; each load meets the one that its own deformation is nearest to.
/// Where K_T has no factor, that of rest, and a note reports it. Those below 1e-8 of the maximum deformation, which are
/// round-off, are left out. Collective. A factorisation for each tangent.
///
/// K at rest alone (no tangents) would lock: what bends a wide thin shell further stretches it, unless the same column
/// holds the way out, and that depends on how far it is bent. Where the products of the columns with the deformations
/// are relieved (relieve), K at rest is right: about V eta on a fine mesh the stresses of terms of higher order
/// dominate K_T.
reduction::Columns responses(const PlannedBody& body, const ReducedBody& reduced,
                             const std::vector<ResidualLoad>& loads, int tangents, std::vector<std::string>& notes);

/// Columns that carry most of the fields u: at most `most`, by proper orthogonal decomposition in the norm of M. Those
/// below 1e-4 of the maximum are left out. Collective.
reduction::Columns main_columns(const fem::Structure& structure, const reduction::Columns& u, int most);

/// Extends the relief of `more`, the body on [V W], by that of the products of V eta, up to eight deformations of the
/// loads, and W. Collective.
void relieve(const PlannedBody& body, const std::vector<ResidualLoad>& loads, const reduction::Columns& W,
             const ReducedBody& reduced, ReducedBody& more);

/// The body on [V W], its elasticity as projected (condense, finish_elasticity): its first coordinates are those that
/// it has. Rayleigh damping acts on all, modal damping on the first. Collective.
ReducedBody with_columns(const PlannedBody& body, const ReducedBody& reduced, const reduction::Columns& W);

}  // namespace floe::assembly
