# SPDX-License-Identifier: Apache-2.0
# cmake --install build/release --prefix P [--component runtime|development]
#   runtime      programs, their data, man pages, shell completions, libfurrow.so.1
#   development  headers, libfurrow.so, find_package(Furrow), furrow.pc
# Nothing that is installed holds the prefix, so the folder may be moved.
if(NOT FURROW_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The library.
set(cmake_files "${CMAKE_INSTALL_LIBDIR}/cmake/Furrow")
install(TARGETS furrow_c EXPORT FurrowTargets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime NAMELINK_COMPONENT development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/client/c/include/" DESTINATION include COMPONENT development)
install(EXPORT FurrowTargets NAMESPACE Furrow:: DESTINATION "${cmake_files}" COMPONENT development)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/FurrowConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/FurrowConfig.cmake" INSTALL_DESTINATION "${cmake_files}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/FurrowConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/FurrowConfig.cmake" "${PROJECT_BINARY_DIR}/FurrowConfigVersion.cmake"
  DESTINATION "${cmake_files}" COMPONENT development)
# From lib/pkgconfig or lib/<machine>/pkgconfig to the prefix.
file(RELATIVE_PATH FURROW_PC_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" FURROW_PC_PREFIX "${FURROW_PC_PREFIX}")
configure_file("${PROJECT_SOURCE_DIR}/cmake/furrow.pc.in" "${PROJECT_BINARY_DIR}/furrow.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/furrow.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
  COMPONENT development)
# The plug-ins as they are in the source tree; docs/engines/ says where each of them goes. Templates are for `furrow`.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/client/engines/" DESTINATION share/furrow/engines COMPONENT development
        PATTERN "__pycache__" EXCLUDE PATTERN "*.in" EXCLUDE PATTERN "*.in.meta" EXCLUDE PATTERN ".clang-format" EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION share/doc/furrow COMPONENT runtime)
if(NOT FURROW_BUILD_PROGRAMS)
  return()
endif()

# The programs. base/data_dir.h states how they find the rest: bin/, lib/furrow/, libexec/furrow/ and
# share/furrow/ are folders of one prefix, on every system.
install(TARGETS furrow furrowd RUNTIME DESTINATION bin COMPONENT runtime)
install(TARGETS furrow-load furrow-author furrow-assimp furrow-draco
  RUNTIME DESTINATION libexec/furrow COMPONENT runtime)
install(TARGETS furrow_pictures furrow_video furrow_nats LIBRARY DESTINATION lib/furrow COMPONENT runtime)
install(DIRECTORY "${PROJECT_BINARY_DIR}/share/furrow" DESTINATION share COMPONENT runtime)
install(FILES "${PROJECT_SOURCE_DIR}/server/furrow.example.toml" DESTINATION share/doc/furrow COMPONENT runtime)
foreach(folder systemd grafana prometheus nats)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/deploy/${folder}" DESTINATION share/doc/furrow COMPONENT runtime)
endforeach()
# docs/CMakeLists.txt generates these from --help, if Python is there.
foreach(folder man bash-completion zsh fish)
  install(DIRECTORY "${PROJECT_BINARY_DIR}/share/${folder}" DESTINATION share COMPONENT runtime OPTIONAL)
endforeach()
