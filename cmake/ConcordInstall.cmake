# Install rules and the exported CMake package: find_package(Concord) gives concord::scene, concord::particle
# and concord::sph. Headers go to include/concord and are included as in the sources ("scene/problem.hpp");
# scenes, studies and the report's scripts go to share/concord.
include(CMakePackageConfigHelpers)
set(concord_package ${CMAKE_INSTALL_LIBDIR}/cmake/Concord)

set_target_properties(concord_scene PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0 INSTALL_RPATH "$ORIGIN")
install(TARGETS concord_scene concord_particle concord_sph EXPORT ConcordTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS concord_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT ConcordTargets NAMESPACE concord:: DESTINATION ${concord_package})

foreach(room scene particle sph_reference)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/concord
          FILES_MATCHING PATTERN "*.hpp" PATTERN library EXCLUDE)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scene/library DESTINATION ${CMAKE_INSTALL_DATADIR}/concord/scene)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/studies DESTINATION ${CMAKE_INSTALL_DATADIR}/concord
        PATTERN driver EXCLUDE PATTERN probes EXCLUDE PATTERN CMakeLists.txt EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/reports DESTINATION ${CMAKE_INSTALL_DATADIR}/concord
        PATTERN __pycache__ EXCLUDE PATTERN node_modules EXCLUDE)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/ConcordConfig.cmake.in
  ${PROJECT_BINARY_DIR}/ConcordConfig.cmake INSTALL_DESTINATION ${concord_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ConcordConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ConcordConfig.cmake ${PROJECT_BINARY_DIR}/ConcordConfigVersion.cmake
        DESTINATION ${concord_package})
