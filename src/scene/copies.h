#pragma once
#include "document.h"
#include "floe/scene/copies.h"

namespace floe::scene {

/// Bodies, joints, loads and probes with `like: NAME` get all keys of the entry of that name that they do not have
/// themselves; `like` is removed. Copies of copies are resolved; an entry that depends on itself is a fault.
void resolve_copies(Document& document, const YAML::Node& root);

}  // namespace floe::scene
