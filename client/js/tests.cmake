# SPDX-License-Identifier: Apache-2.0
# Tests the packages with Node's test runner. The tests are bundled first, because Node 18 cannot run TypeScript.
file(GLOB tests CONFIGURE_DEPENDS furrow/tests/*.test.ts furrow-three/tests/*.test.ts)
set(bundles "${CMAKE_CURRENT_BINARY_DIR}/tests")
set(stamp "${CMAKE_CURRENT_BINARY_DIR}/tests.stamp")
file(GLOB_RECURSE test_sources CONFIGURE_DEPENDS furrow/tests/*.ts furrow-three/tests/*.ts)
add_custom_command(
  OUTPUT "${stamp}"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${bundles}"
  COMMAND ${esbuild} ${tests} --bundle --platform=node --format=esm --out-extension:.js=.mjs --sourcemap=inline
          --log-level=warning "--tsconfig=${CMAKE_CURRENT_BINARY_DIR}/tsconfig.json"
          "--outbase=${CMAKE_CURRENT_SOURCE_DIR}" "--outdir=${bundles}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
  DEPENDS ${sources} ${test_sources} "${wire_stamp}" "${CMAKE_CURRENT_BINARY_DIR}/tsconfig.json"
  WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" COMMENT "client/js: bundling the tests" VERBATIM)
add_custom_target(furrow_js_tests ALL DEPENDS "${stamp}")

foreach(test IN LISTS tests)
  file(RELATIVE_PATH path "${CMAKE_CURRENT_SOURCE_DIR}" "${test}")
  string(REGEX REPLACE "\\.ts$" ".mjs" path "${path}")
  string(REGEX REPLACE "^([^/]*)/tests/([^.]*).*" "js.\\1.\\2" name "${path}")
  string(REPLACE "-" "_" name "${name}")
  add_test(NAME ${name} COMMAND "${FURROW_NODE}" --test "${bundles}/${path}")
  # A real daemon takes more than a few seconds.
  set(labels web)
  if(path MATCHES "daemon")
    list(APPEND labels all)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT 300
    ENVIRONMENT "FURROW_SOURCE=${PROJECT_SOURCE_DIR};FURROW_BIN=${PROJECT_BINARY_DIR}/bin;FURROW_SHARE=${PROJECT_BINARY_DIR}/share/furrow;FURROW_JS=${CMAKE_CURRENT_BINARY_DIR}")
endforeach()
