# Writes version.h with the commit that is being built; touches it only when that has changed.
execute_process(COMMAND git -C ${ROOT} describe --always --dirty --abbrev=10
  OUTPUT_VARIABLE FLOE_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT FLOE_COMMIT)
  set(FLOE_COMMIT unknown)
endif()
configure_file(${ROOT}/makefiles/version.h.in ${OUTPUT} @ONLY)
