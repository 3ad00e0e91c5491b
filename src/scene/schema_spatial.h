#pragma once
#include "floe/scene/schema.h"

namespace floe::scene {

/// The part of the grammar that only scenes in space have.
const std::vector<SchemaSection>& spatial_sections();

}  // namespace floe::scene
