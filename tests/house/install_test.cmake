# Installs BUILD into a fresh folder WORK and uses it from there: the program says its version, and a project of its
# own (tests/examples/) finds, links and runs the library.
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
# The public headers are installed, and no other.
set(HEADERS drape error measure mesh render size version wrinkle)
file(GLOB_RECURSE installed RELATIVE ${WORK}/prefix/include ${WORK}/prefix/include/*)
list(SORT installed)
list(TRANSFORM HEADERS PREPEND plisse/ OUTPUT_VARIABLE wanted)
list(TRANSFORM wanted APPEND .h)
if(NOT installed STREQUAL wanted)
  message(FATAL_ERROR "the headers that were installed are\n${installed}\nand not\n${wanted}")
endif()
file(GLOB examples RELATIVE ${SOURCE}/tests/examples ${SOURCE}/tests/examples/*.cpp)
list(SORT examples)
list(TRANSFORM HEADERS APPEND .cpp OUTPUT_VARIABLE wanted)
if(NOT examples STREQUAL wanted)
  message(FATAL_ERROR "tests/examples/ has\n${examples}\nand not one example a public header\n${wanted}")
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

# Users have headers of their own, of any name: for each of ours in src/ there is one here, in front of all others,
# which no public header may take for ours.
file(GLOB_RECURSE internal RELATIVE ${SOURCE}/src ${SOURCE}/src/*.h)
foreach(header ${internal})
  file(WRITE ${WORK}/own/${header} "#error \"a public header of plisse took the user's own ${header} for plisse's\"\n")
endforeach()

# The example of the README is one more.
file(COPY ${SOURCE}/tests/examples/ DESTINATION ${WORK}/source)
file(READ ${SOURCE}/README.md readme)
if(NOT readme MATCHES "```cpp\n([^`]*)```")
  message(FATAL_ERROR "README.md has no example in C++")
endif()
file(WRITE ${WORK}/source/readme.cpp "${CMAKE_MATCH_1}")

run(${CMAKE_COMMAND} -G "${GENERATOR}" -S ${WORK}/source -B ${WORK}/examples
  -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER=${COMPILER}
  "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror" -DEXAMPLES_OWN_INCLUDES=${WORK}/own)
run(${CMAKE_COMMAND} --build ${WORK}/examples)
file(READ ${WORK}/examples/examples.txt examples)
file(COPY ${SOURCE}/assets DESTINATION ${WORK}/run)
foreach(example ${examples})
  run(${CMAKE_COMMAND} -E chdir ${WORK}/run ${WORK}/examples/${example})
  message("${example}: ${output}")
endforeach()
file(REMOVE_RECURSE ${WORK})
