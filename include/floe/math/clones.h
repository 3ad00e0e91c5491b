#pragma once

/// Compiles a function several times, for processors with wider vectors than the rest of the program assumes; the one
/// that fits is chosen when the program starts. Sanitizers are not ready at that time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define FLOE_CLONES __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default"), optimize("O3")))
#else
#define FLOE_CLONES
#endif
