# What `cmake --install` puts where: bin/plisse, lib/libplisse.a, include/plisse/*.h, and the files behind
# find_package(plisse).
set(PLISSE_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/plisse)

install(TARGETS plisse EXPORT plisseTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET plisse_program)
  install(TARGETS plisse_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
# The public face and nothing of src/: what is not installed may change at any time.
foreach(folder ${PLISSE_PUBLIC_INCLUDES})
  install(DIRECTORY ${folder}/plisse DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
endforeach()
# What `plisse bench` measures.
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/plisse)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT plisseTargets NAMESPACE plisse:: DESTINATION ${PLISSE_CMAKE_DIR})
configure_package_config_file(tools/cmake/plisseConfig.cmake.in ${PROJECT_BINARY_DIR}/plisseConfig.cmake
  INSTALL_DESTINATION ${PLISSE_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/plisseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/plisseConfig.cmake ${PROJECT_BINARY_DIR}/plisseConfigVersion.cmake
  DESTINATION ${PLISSE_CMAKE_DIR})
