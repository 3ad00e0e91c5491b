#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "floe/assembly/reduce_bodies.h"
#include "floe/dynamics/coordinates.h"
#include "floe/dynamics/term.h"
#include "floe/reference/mass_damping.h"

namespace floe::assembly {

/// Dofs of a body by which its rigid motion is distinguished from its vibration (fem::joint_frame): those that joints
/// hold to the ground, to rigid bodies where nothing is joined to the ground, or to bodies that are fewer joints away
/// from these. Collective.
fem::Conditions constrained_for_damping(const Plan& plan, int body);
/// Likewise of a body of several, `whole`, as one: joints among these do not count.
fem::Conditions constrained_for_damping(const Plan& plan, const std::vector<int>& whole, int body);
/// What holds a body in the modes that damping.modal refers to, where these are not those of the reduction: the joints
/// of constrained_for_damping(). Collective.
std::optional<fem::Conditions> conditions_for_damping(const Plan& plan, int body);
/// These modes. Collective.
std::optional<reduction::Modes> modes_for_damping(const Plan& plan, int body);
/// All modes that damping.modal refers to, whether they are those of the reduction or not. Collective.
reduction::Modes all_modes_for_damping(const Plan& plan, int body);
/// Of each body whose modes for damping.modal do not satisfy its joints towards the ground, a warning. Collective.
std::vector<std::string> damping_with_free_joints(const Plan& plan);
/// A warning where the damping of a body from a file, modal or mass-proportional, is that of a body on no other body,
/// and this one is joined to some.
std::string damping_without_joints(const Plan& plan, int body, const ReducedBody& reduced);
/// `constrained`, in order, without dofs of nodes that follow others, which have no motion of their own.
fem::Conditions without_dependent(const fem::Structure& structure, const fem::Conditions& constrained);

/// What damping.mass acts on: the displacement in the frame less its rigid part as the body's joints see it.
/// Collective.
fem::ReferenceFrame damping_frame(const Plan& plan, int body);

/// alpha V'P'MPV + beta V'KV + modal: of small motions, for files and exports. Empty: none. Collective.
Eigen::MatrixXd linear_damping(const Plan& plan, int body, const ReducedBody& reduced);

/// Terms of a reduced body's damping on its elastic coordinates: mass-proportional (of a body in one frame), modal (one
/// constant matrix), and Kelvin-Voigt. Collective.
std::vector<std::unique_ptr<dynamics::Term>> damping_terms(const Plan& plan, int body, const ReducedBody& reduced,
                                                           const std::vector<int>& elastic);

/// Mass-proportional damping of a full-order body in one frame, with its unknowns added where it needs some; none: it
/// has none.
/// @param constrained  dofs that are zero with the full-order model. Collective.
std::optional<reference::MassDamping> full_order_damping(const Plan& plan, int body, const fem::Conditions& constrained,
                                                         dynamics::Coordinates& coordinates);

/// The unknowns of `damping` at the start. @param owner  whether this rank has the shared unknowns. Collective.
void set_rigid_part(const reference::MassDamping& damping, const PlannedBody& body,
                    const dynamics::Coordinates& coordinates, bool owner, Vec U, Vec V);

}  // namespace floe::assembly
