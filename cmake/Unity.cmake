# SPDX-License-Identifier: Apache-2.0
# Makes clean builds faster. They spend most of their time on parsing the same headers again and again, so each
# folder of a library or a test program is compiled as one translation unit, and precompiled headers hold the standard library.
option(FURROW_UNITY "Compile each folder of a target as one unit, and precompile common headers" ON)

# Folders whose rooms share one unit, because all of them parse the same heavy headers (CLI11, Beast).
set(FURROW_UNITY_SHARED client/cli server/http)

# Headers that most sources include. <regex>, <iostream> and the like are not among them.
set(FURROW_STANDARD_HEADERS
  <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map>
  <memory> <mutex> <numeric> <optional> <span> <sstream> <string> <string_view> <thread> <unordered_map>
  <unordered_set> <utility> <variant> <vector>)

# furrow_group_by_folder(TARGET): compiles the sources of each folder as one translation unit. Sources with the property
# SKIP_UNITY_BUILD_INCLUSION are compiled separately.
function(furrow_group_by_folder target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${source}" generated)
    if(NOT generated)
      cmake_path(GET source PARENT_PATH folder)
      file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${folder}")
      foreach(shared IN LISTS FURROW_UNITY_SHARED)
        cmake_path(IS_PREFIX shared "${folder}" is_shared)
        if(is_shared)
          set(folder "${shared}")
        endif()
      endforeach()
      string(REPLACE "/" "_" group "${folder}")
      set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # g++ takes the sources that a unit includes for headers, and warns about their anonymous namespaces.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endfunction()

# furrow_unity(TARGET): compiles a library by folder, and precompiles the standard library and GLM once for all
# libraries.
function(furrow_unity target)
  # The client library alone is small, and the precompiled header needs GLM.
  if(NOT FURROW_UNITY OR NOT FURROW_BUILD_PROGRAMS)
    return()
  endif()
  furrow_group_by_folder(${target})
  if(NOT TARGET furrow_library_headers)
    file(WRITE "${PROJECT_BINARY_DIR}/library_headers.cpp" "// Carries the libraries' precompiled header.\n")
    add_library(furrow_library_headers STATIC "${PROJECT_BINARY_DIR}/library_headers.cpp")
    target_precompile_headers(furrow_library_headers PRIVATE
      ${FURROW_STANDARD_HEADERS} <glm/glm.hpp> <glm/gtc/quaternion.hpp>)
  endif()
  target_precompile_headers(${target} REUSE_FROM furrow_library_headers)
endfunction()

# furrow_optimise(TARGET): compiles a library with -O2 in every build type, for code that the build itself runs.
# It does without the precompiled header, because g++ 12 crashes on one of another optimisation level.
function(furrow_optimise target)
  target_compile_options(${target} PRIVATE -O2)
  set_target_properties(${target} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
endfunction()

# furrow_build_quickly(TARGET): compiles a library of cold code with -O1 in builds that use -O2. Beast and CLI11
# instantiate much code that runs once per request or command; -O1 takes two thirds of the time. As above, it
# then does without the precompiled header.
function(furrow_build_quickly target)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE -O1)
    set_target_properties(${target} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# furrow_compile_alone(SOURCES...): compiles sources separately. Highway includes the source of a kernel once
# per instruction set, so a kernel cannot share a unit. Call this before furrow_library().
function(furrow_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# furrow_unity_tests(TARGET): compiles a test program by folder, and precompiles GoogleTest and the standard library once
# for all test programs.
function(furrow_unity_tests target)
  if(NOT FURROW_UNITY)
    return()
  endif()
  furrow_group_by_folder(${target})
  if(NOT TARGET furrow_test_headers)
    # An executable, since the header must be compiled with the tests' -fPIE.
    file(WRITE "${PROJECT_BINARY_DIR}/test_headers.cpp" "// Carries the tests' precompiled header.\nint main() {}\n")
    add_executable(furrow_test_headers "${PROJECT_BINARY_DIR}/test_headers.cpp")
    target_link_libraries(furrow_test_headers PRIVATE GTest::gtest GTest::gmock)
    target_precompile_headers(furrow_test_headers PRIVATE
      <gmock/gmock.h> <gtest/gtest.h> ${FURROW_STANDARD_HEADERS})
  endif()
  target_precompile_headers(${target} REUSE_FROM furrow_test_headers)
endfunction()
