#pragma once
#include <vector>

#include "floe/scene/scene.h"

namespace floe::plan {
using namespace scene;

/// By which joint a body takes part in the frame of another one; -1: it has its own.
struct SharedFrame {
  int parent = -1;  ///< index of the body whose frame it is, which has its own
  int joint = -1;   ///< index of the joint by which the body is fixed to that one, or to another of its welded bodies
  bool shared() const { return parent >= 0; }
};

/// Bodies in space that joint `fixed` makes one with a rigid body: their frames move as one.
///
/// A flexible body is the welded body of a rigid one when its frame is clamped at the place of the joint (as it is when
/// nothing is said of one with shells); of two rigid bodies the later one is the welded body. Welded bodies of welded
/// bodies have the first one's frame. These keep their frames, and their joints' rows: a body that the ground holds in
/// a joint of its own; whose start does not fit the rigid one's velocity; whose joint holds the mean of an edge, or is
/// unlocked by an event or measured by a probe; that comes from a file, or is fixed to one that does. None shares with
/// share_frames: false.
std::vector<SharedFrame> shared_frames(const Scene& scene);

/// Whether the default frame of a body in space is clamped where a joint clamps it: of shells, of meshes from files and
/// of rigid bodies. Flexible lines of beams have mean axes: against closed forms and geometrically exact beams a
/// clamped frame errs 6 to 30 times more in bending (docs/choosing.md).
bool clamped_by_default(const Body& body);

}  // namespace floe::plan
