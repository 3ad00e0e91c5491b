#pragma once
#include "document.h"

namespace floe::scene {

/// Writes the entries of `copies` out: for each the bodies of its group, moved by x -> R x + p, and the joints, loads
/// and probes that act on them, into the mappings of the scene under the names COPY_NAME. Faults of a copied value are
/// those of the value's own line. Parameters, functions and the dimension must have been read; `like` must be resolved.
void write_out_groups(Document& document, YAML::Node root);

}  // namespace floe::scene
