# Which commit is being built, for reports: writes OUTPUT only where that changed, so that nothing is compiled for nothing.
cmake_minimum_required(VERSION 3.25)
set(commit "unknown")
execute_process(COMMAND git -C ${ROOT} rev-parse --short HEAD OUTPUT_VARIABLE id RESULT_VARIABLE failed
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT failed)
  set(commit "${id}")
  execute_process(COMMAND git -C ${ROOT} status --porcelain -uno -- src shaders OUTPUT_VARIABLE changes ERROR_QUIET)
  if(NOT changes STREQUAL "")
    string(APPEND commit " with changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Made by tools/cmake/commit.cmake at every build.
#pragma once
namespace plisse {
inline constexpr const char* commit = \"@commit@\";
}
" @ONLY)
