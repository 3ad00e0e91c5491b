#pragma once
#include "floe/scene/schema.h"

namespace floe::scene {

// The grammar in parts, each in the order in which it is printed.

/// A section of beams with the keys of its shape and their measures, before A. @param text  of the shape
SchemaSection with_shape(SchemaSection section, const std::string& text);

/// A body: its mesh, sections, frame, reduction, damping and start.
const std::vector<SchemaSection>& body_sections();
/// What joins, loads, moves and watches bodies.
const std::vector<SchemaSection>& mechanism_sections();
/// What only scenes in space have.
const std::vector<SchemaSection>& spatial_sections();

}  // namespace floe::scene
