#pragma once
#include <functional>
#include <map>
#include <string>

#include "floe/fem/congruence.h"
#include "floe/plan/prepare.h"
#include "floe/reduction/reduce.h"

namespace floe::plan {

/// The body before a body whose reduction it has.
struct SharedReduction {
  int of = -1;  ///< index of the first body of the same reduction; -1: none
  fem::Placement placement;
};

using Attachments = std::vector<reduction::Attachment>;
using AttachmentsOf = std::function<Attachments(int body)>;

/// Of each body whether one before it has the same reduction, by comparison of all that a reduction is made from:
/// elements and sections (fem::congruent), conditions of frame, joints and interface, attachment modes and the settings
/// of the scene. Bodies may be rotated against each other in their frames where conditions hold whole displacements and
/// whole rotations of nodes, and attachment modes come in threes. Derivatives chosen by count depend on the motion, and
/// named basis vectors on the joints' names: these are not shared. Collective.
std::vector<SharedReduction> same_reductions(const Plan& plan, const AttachmentsOf& attachments);

/// Attachment modes that may differ from zero: a frame clamped to a node balances all loads there. Collective.
Attachments that_act(const PlannedBody& body, Attachments all);

/// The text with other labels of attachment modes in it, `derivative 1,root.fx`.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& labels);

}  // namespace floe::plan
