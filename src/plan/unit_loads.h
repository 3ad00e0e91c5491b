#pragma once
#include "floe/plan/prepare.h"
#include "floe/reduction/reduce.h"

namespace floe::plan {

/// A unit force or moment on the mean of the place's nodes. Collective.
reduction::Attachment unit_load(const PlannedBody& body, const Anchor& place, int component, const std::string& where);

/// One dof displaced by one. Collective.
reduction::Attachment unit_displacement(const PlannedBody& body, PetscInt dof, const std::string& where);

/// The nodes of a place as one rigid piece, moved along or rotated about an axis of the frame through their mean.
/// Collective.
reduction::Attachment rigid_displacement(const PlannedBody& body, const Anchor& place, int component,
                                         const std::string& where);

}  // namespace floe::plan
