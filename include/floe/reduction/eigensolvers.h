#pragma once

namespace floe::reduction {

/// Registers floe's own EPS types with SLEPc, so that options may name them: block-lanczos. May be called again.
void register_eigensolvers();

}  // namespace floe::reduction
