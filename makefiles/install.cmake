# What `cmake --install` and `make package` put where: the program (component floe), the library (component floe-dev).
include(CMakePackageConfigHelpers)

# The manual page and the completion come from the program's own help.
set(pages ${PROJECT_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/floe.1 ${pages}/floe.bash
  COMMAND ${CMAKE_COMMAND} -E env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 HWLOC_HIDE_ERRORS=2
    python3 ${PROJECT_SOURCE_DIR}/makefiles/command_pages.py $<TARGET_FILE:floe> ${pages}
  DEPENDS floe ${PROJECT_SOURCE_DIR}/makefiles/command_pages.py VERBATIM)
add_custom_target(pages DEPENDS ${pages}/floe.1 ${pages}/floe.bash)

set(config ${CMAKE_INSTALL_LIBDIR}/cmake/floe)
install(TARGETS floe COMPONENT floe)
file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/plot/*.py ${PROJECT_SOURCE_DIR}/src/plot/*.js
  ${PROJECT_SOURCE_DIR}/src/plot/*.css ${PROJECT_SOURCE_DIR}/src/exchange/*.py)
install(FILES ${scripts} DESTINATION ${CMAKE_INSTALL_DATADIR}/floe COMPONENT floe)
install(FILES ${pages}/floe.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT floe OPTIONAL)
install(FILES ${pages}/floe.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME floe
  COMPONENT floe OPTIONAL)

install(TARGETS ${FLOE_ROOMS} floe_flags floe_outside EXPORT floe COMPONENT floe-dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/floe ${PROJECT_BINARY_DIR}/include/floe
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT floe-dev)
install(EXPORT floe NAMESPACE floe:: FILE targets.cmake DESTINATION ${config} COMPONENT floe-dev)
install(FILES ${PROJECT_SOURCE_DIR}/makefiles/find_dependencies.cmake DESTINATION ${config} COMPONENT floe-dev)
configure_package_config_file(${PROJECT_SOURCE_DIR}/makefiles/floe-config.cmake.in floe-config.cmake
  INSTALL_DESTINATION ${config})
write_basic_package_version_file(floe-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/floe-config.cmake ${PROJECT_BINARY_DIR}/floe-config-version.cmake
  DESTINATION ${config} COMPONENT floe-dev)
file(RELATIVE_PATH FLOE_PREFIX_FROM_PC /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)  # may be moved
configure_file(${PROJECT_SOURCE_DIR}/makefiles/floe.pc.in floe.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/floe.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT floe-dev)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR floe)
set(CPACK_PACKAGE_CONTACT "the floe developers <floe@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL floe floe-dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FLOE_PACKAGE_NAME floe)
set(CPACK_DEBIAN_FLOE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FLOE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FLOE_PACKAGE_DEPENDS "openmpi-bin, libopenblas0-serial, python3, python3-matplotlib, python3-h5py, \
libjs-three")
set(CPACK_DEBIAN_FLOE-DEV_PACKAGE_NAME floe-dev)
set(CPACK_DEBIAN_FLOE-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_FLOE-DEV_PACKAGE_DEPENDS "floe (= ${PROJECT_VERSION}), g++, pkg-config, libpetsc-real3.18-dev, \
libslepc-real3.18-dev, libmetis-dev, libhdf5-openmpi-dev, libopenmpi-dev, libeigen3-dev, libyaml-cpp-dev, \
libcli11-dev, libfmt-dev, nlohmann-json3-dev")
include(CPack)
