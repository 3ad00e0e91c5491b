# Two precompiled headers, of the libraries' headers that most files include: `floe_headers` for src, `floe_test_headers`
# (with Catch2) for tests. They only save time (a third to a half a file): every file still includes what it uses, which
# a build with -DFLOE_PRECOMPILE=OFF checks (make lint configures one).
set(FLOE_PRECOMPILED <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numeric> <optional> <set>
  <span> <sstream> <string> <tuple> <utility> <variant> <vector> <floe/math/compiled_eigen.h> <fmt/format.h> <petscts.h>
  <slepceps.h>)

function(floe_precompiled_header name)
  file(WRITE ${PROJECT_BINARY_DIR}/${name}.cpp.new "")
  file(COPY_FILE ${PROJECT_BINARY_DIR}/${name}.cpp.new ${PROJECT_BINARY_DIR}/${name}.cpp ONLY_IF_DIFFERENT)
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE floe_flags floe_outside)
  target_compile_options(${name} PUBLIC $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  target_precompile_headers(${name} PRIVATE ${FLOE_PRECOMPILED} ${ARGN})
endfunction()

# Lets a target use one of the two.
function(floe_precompiled target header)
  if(FLOE_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${header})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endfunction()

if(FLOE_PRECOMPILE)
  floe_precompiled_header(floe_headers)
  target_compile_options(floe_headers PRIVATE ${FLOE_COVERAGE_OPTIONS})
endif()
