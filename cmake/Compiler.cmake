# SPDX-License-Identifier: Apache-2.0
# Language level, warnings, sanitizers, ccache and the linker.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

set(FURROW_SANITIZE "" CACHE STRING "Sanitizers, comma-separated: address,undefined | thread | fuzzer")
set(FURROW_COVERAGE OFF CACHE BOOL "Instrument for gcov")

find_program(FURROW_CCACHE ccache)
if(FURROW_CCACHE)
  # ccache supports precompiled headers only with these two settings (see "Precompiled headers" in its
  # manual). With -fpch-preprocess it sees which header a unit used.
  set(launcher "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${FURROW_CCACHE}")
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()

add_compile_options(-Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wimplicit-fallthrough
                    -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno)

if(FURROW_SANITIZE)
  set(_sanitize "${FURROW_SANITIZE}")
  if(_sanitize MATCHES "fuzzer")
    # Libraries get only coverage instrumentation. The fuzz targets link the fuzzer's main function.
    string(REPLACE "fuzzer" "fuzzer-no-link" _sanitize "${_sanitize}")
  endif()
  add_compile_options(-fsanitize=${_sanitize} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${_sanitize})
  if(FURROW_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
if(FURROW_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

find_program(FURROW_LLD NAMES ld.lld ld.lld-14)
if(FURROW_LLD AND NOT FURROW_SANITIZE)
  add_link_options(-fuse-ld=lld)
endif()
