# What `cmake --install` puts where: bin/plisse, lib/libplisse.a, include/plisse/<folder>/*.h and pipeline.h, and the
# files behind find_package(plisse).
set(PLISSE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/plisse)

# The headers name each other from src/; users may write <plisse/pipeline.h>.
target_include_directories(plisse INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS plisse EXPORT plisseTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET plisse_program)
  install(TARGETS plisse_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plisse FILES_MATCHING PATTERN "*.h"
  PATTERN cli EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/generated/base DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plisse
  FILES_MATCHING PATTERN "*.h")
# What `plisse bench` measures.
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/plisse)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT plisseTargets NAMESPACE plisse:: DESTINATION ${PLISSE_CMAKE_DIR})
configure_package_config_file(tools/cmake/plisseConfig.cmake.in ${PROJECT_BINARY_DIR}/plisseConfig.cmake
  INSTALL_DESTINATION ${PLISSE_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/plisseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/plisseConfig.cmake ${PROJECT_BINARY_DIR}/plisseConfigVersion.cmake
  DESTINATION ${PLISSE_CMAKE_DIR})
