# SPDX-License-Identifier: Apache-2.0
# Composes the schema of a wrinkle rig. rig/rig.fbs has everything except the driver kinds: the schema of a kind
# is in the kind's folder, and driver_kinds.h is the only list of kinds.

# furrow_driver_kinds(HEADER OUT): reads FURROW_DRIVER_KINDS. Sets OUT to its rows in order: "KIND(Spread, spread)".
function(furrow_driver_kinds header out)
  file(READ "${header}" text)
  string(REGEX MATCH "#define FURROW_DRIVER_KINDS\\(KIND\\)[^#]*" table "${text}")
  string(REGEX MATCHALL "KIND\\( *[A-Za-z0-9]+ *, *[a-z0-9_]+ *\\)" rows "${table}")
  if(NOT rows)
    message(FATAL_ERROR "${header}: the table FURROW_DRIVER_KINDS is missing or empty")
  endif()
  set(${out} "${rows}" PARENT_SCOPE)
endfunction()

# furrow_replace_line(TEXT MARK NEW): replaces the line of the variable TEXT that contains MARK.
function(furrow_replace_line text mark new)
  string(REGEX MATCH "[^\n]*${mark}[^\n]*\n" line "${${text}}")
  if(NOT line)
    message(FATAL_ERROR "rig/rig.fbs: the line with ${mark} is missing")
  endif()
  string(REPLACE "${line}" "${new}" replaced "${${text}}")
  set(${text} "${replaced}" PARENT_SCOPE)
endfunction()

# furrow_compose_rig_schema(SOURCE_DIR OUT): sets OUT to the whole schema, and OUT_FILES to the files that it was
# composed from.
function(furrow_compose_rig_schema source_dir out)
  set(drivers "${source_dir}/wrinkle/drivers")
  set(files "${source_dir}/rig/rig.fbs" "${drivers}/driver_kinds.h")
  furrow_driver_kinds("${drivers}/driver_kinds.h" rows)
  set(tables)
  set(fields)
  set(separator)
  foreach(row IN LISTS rows)
    string(REGEX MATCH "([A-Za-z0-9]+) *, *([a-z0-9_]+)" match "${row}")
    set(name "${CMAKE_MATCH_1}")
    set(kind "${CMAKE_MATCH_2}")
    set(file "${drivers}/${kind}/${kind}.fbs")
    if(NOT EXISTS "${file}")
      message(FATAL_ERROR "driver_kinds.h lists the kind '${kind}', but ${file} is missing: "
                          "write the schema of its fields, with a table ${name}Driver")
    endif()
    list(APPEND files "${file}")
    file(READ "${file}" table)
    string(REGEX MATCH "\n\n.*$" table "${table}")  # without the file's first lines: licence and purpose
    string(STRIP "${table}" table)
    string(APPEND tables "${separator}${table}\n")
    set(separator "\n")
    string(APPEND fields "  ${kind}: ${name}Driver;\n")
  endforeach()
  file(READ "${source_dir}/rig/rig.fbs" schema)
  furrow_replace_line(schema "@DRIVER_TABLES@" "${tables}")
  furrow_replace_line(schema "@DRIVER_FIELDS@" "${fields}")
  set(${out} "${schema}" PARENT_SCOPE)
  set(${out}_FILES "${files}" PARENT_SCOPE)
endfunction()
