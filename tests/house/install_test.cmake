# Installs BUILD into a fresh folder WORK and uses it from there: the program says its version, and a project of its
# own finds, links and runs the library.
#
#   cmake -DBUILD=… -DSOURCE=… -DWORK=… -DVERSION=… -DCOMPILER=… -DGENERATOR=… -P tests/house/install_test.cmake
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
foreach(file bin/plisse include/plisse/pipeline.h include/plisse/io/model.h include/plisse/base/version.h)
  if(NOT EXISTS ${WORK}/prefix/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
if(EXISTS ${WORK}/prefix/include/plisse/cli)
  message(FATAL_ERROR "headers of cli/ were installed; they are no part of the library")
endif()

run(${WORK}/prefix/bin/plisse --version)
if(NOT output MATCHES "${VERSION}")
  message(FATAL_ERROR "plisse --version does not say ${VERSION}: ${output}")
endif()

# A CMake package that names the build or source tree works only on the machine that made it.
file(GLOB_RECURSE package ${WORK}/prefix/*.cmake)
foreach(file ${package})
  file(READ ${file} text)
  if(text MATCHES "${BUILD}" OR text MATCHES "${SOURCE}/")
    message(FATAL_ERROR "${file} names the build or the source folder")
  endif()
endforeach()

run(${CMAKE_COMMAND} -G "${GENERATOR}" -S ${SOURCE}/tests/house/consumer -B ${WORK}/consumer
  -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)
message("${output}")
file(REMOVE_RECURSE ${WORK})
