#pragma once
#include "floe/plan/prepare.h"
#include "floe/reduction/reduce.h"

namespace floe::plan {

/// Whether the modes are those of the body in its frame alone, not as joints hold it.
bool of_frame(const PlannedBody& body);

/// Whether the modes satisfy all that joints to the ground hold of the body, so that these need no constraint equations
/// where its frame is fixed: modes of the frame satisfy its conditions only.
bool modes_satisfy_joints(const PlannedBody& body);

/// Whether they satisfy what joints to the ground hold of the nodes of this place.
bool modes_satisfy_place(const PlannedBody& body, const Anchor& place);

/// Whether the loads of its attachments are balanced by the joints that hold its modes, and by rigid accelerations only
/// in motions that these leave free: in space (in the plane, of mean-axis frames), where no event unlocks a joint.
bool balanced_by_joints(const Plan& plan, int index);

/// The static columns that a body's `attachment` asks for. Collective.
///
/// Unit loads where joints and loads act; a moment at a joint counts as the joint's, because no mode has a moment at a
/// hinge. Where the ground holds a body and its modes are those of the constrained body, the joint brings no unit load.
///
/// The body's interface (Craig-Bampton) comes first: each place as a rigid piece, its dofs displaced by one,
/// `attachment PLACE.x` and so on.
///
/// Joints to the ground that hold more than the three rigid motions hold deformations besides, at zero in all these
/// columns. Where the body has to deform to follow its joints, it gets the static constraint mode of the dof (Craig and
/// Bampton 1968), `attachment JOINT.rotation` or `.x`, `.y` in the frame:
///
///   - of a driven rotation, if the rest holds the body already;
///   - of a displacement that the other constrained dofs determine, if the pinned frame rotates as the body deforms: a
///   guided
///     end at the distance L keeps L = cos(theta) (L + u), u = 0 to first order only.
///
/// In space every joint to the ground is one rigid piece that gets a column for each motion constrained, where
///
///   - the frame moves, and joints together hold more than the rigid motions: what they keep apart or at an angle
///     changes at second order as the body bends;
///   - the body stands still, and the joint drives it.
std::vector<reduction::Attachment> attachments(const Plan& plan, int index);

/// In space: of every load at a place of the body, the directions in which it acts (its axes, and its own direction at
/// some times), by one unit, in the frame's axes at the start. Collective.
std::vector<reduction::Attachment> loads_on(const Plan& plan, int index);

}  // namespace floe::plan
