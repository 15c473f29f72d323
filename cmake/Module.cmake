# SPDX-License-Identifier: Apache-2.0
# Functions that add libraries, generated FlatBuffers code and test programs.
include(GoogleTest)
include(Unity)

# furrow_library(NAME SOURCES... LINK libs... PRIVATE_LINK libs...): adds a static library. Headers are
# included by their path from the root.
function(furrow_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
  furrow_unity(${name})
endfunction()

# furrow_flatbuffers(TARGET SCHEMAS...): generates headers, included as "<folder>/<name>_generated.h". A schema is
# in the source folder, or was itself generated as <build>/generated/<folder>/<name>.fbs (absolute path).
function(furrow_flatbuffers target)
  set(generated "${PROJECT_BINARY_DIR}/generated")
  set(outputs)
  foreach(schema IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH schema BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    cmake_path(GET schema STEM stem)
    cmake_path(GET schema PARENT_PATH output_dir)
    cmake_path(IS_PREFIX generated "${schema}" is_generated)
    if(NOT is_generated)
      file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${output_dir}")
      set(output_dir "${generated}/${folder}")
    endif()
    set(output "${output_dir}/${stem}_generated.h")
    add_custom_command(
      OUTPUT "${output}"
      COMMAND "${FURROW_FLATC}" --cpp --scoped-enums --no-prefix --gen-compare
              -I "${CMAKE_CURRENT_SOURCE_DIR}" -o "${output_dir}" "${schema}"
      DEPENDS "${schema}" VERBATIM)
    list(APPEND outputs "${output}")
  endforeach()
  add_custom_target(${target}_schemas DEPENDS ${outputs})
  add_dependencies(${target} ${target}_schemas)
  target_sources(${target} PRIVATE ${outputs})
  target_include_directories(${target} SYSTEM PRIVATE "${generated}")
endfunction()

# furrow_test(NAME SOURCES... LINK libs... [ONE_PROCESS] [LABEL l]): adds a GoogleTest program. Each test is
# a CTest test. ONE_PROCESS runs the program as one CTest test; use it for programs with an expensive set-up
# (GL contexts, whole characters). Programs with the label `all` run only with test.sh --all.
function(furrow_test name)
  cmake_parse_arguments(ARG "ONE_PROCESS" "LABEL" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    FURROW_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FURROW_BINARY_DIR="${PROJECT_BINARY_DIR}"
    FURROW_SHARED_DATA="${FURROW_SHARED_DATA}")
  furrow_unity_tests(${name})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(ARG_ONE_PROCESS)
    add_test(NAME ${name} COMMAND ${name})
    # Long ones start first, beside the many short ones. The last test to start would run alone.
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 1800 COST 300)
  else()
    gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES
                         PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 300)
  endif()
endfunction()

# furrow_embed_texts(OUTPUT ROOT HEADER NAMESPACE TYPE FUNCTION FILES...): sets OUTPUT to a generated source that holds
# the files; see EmbedTexts.cmake. Programs then need no such files at run time.
function(furrow_embed_texts output root header namespace type function)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/embedded_texts.cpp")
  string(REPLACE ";" "," files "${ARGN}")
  add_custom_command(
    OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DROOT=${root}" "-DFILES=${files}" "-DOUTPUT=${source}" "-DHEADER=${header}"
            "-DNAMESPACE=${namespace}" "-DTYPE=${type}" "-DFUNCTION=${function}"
            -P "${PROJECT_SOURCE_DIR}/cmake/EmbedTexts.cmake"
    DEPENDS ${ARGN} "${PROJECT_SOURCE_DIR}/cmake/EmbedTexts.cmake" VERBATIM)
  set(${output} "${source}" PARENT_SCOPE)
endfunction()
