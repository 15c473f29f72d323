# SPDX-License-Identifier: Apache-2.0
# Imports Debian's libraries as targets (deploy/install-deps.sh installs them). Downloads nothing.

# What the client library needs.
find_package(Threads REQUIRED)
find_package(FlatBuffers REQUIRED)
find_package(OpenSSL 3.0 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
find_program(FURROW_FLATC flatc REQUIRED)
add_library(furrow_asio INTERFACE)
find_path(FURROW_ASIO_INCLUDE asio.hpp REQUIRED)
target_include_directories(furrow_asio SYSTEM INTERFACE "${FURROW_ASIO_INCLUDE}")
target_compile_definitions(furrow_asio INTERFACE ASIO_STANDALONE ASIO_NO_DEPRECATED)
target_link_libraries(furrow_asio INTERFACE Threads::Threads)
if(NOT FURROW_BUILD_PROGRAMS)
  return()
endif()

# What the programs need.
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(meshoptimizer REQUIRED)

pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(SECCOMP REQUIRED IMPORTED_TARGET libseccomp)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
# Found with pkg-config, because the CMake package needs Imath's Python targets, which Debian packages
# separately.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(DRACO REQUIRED IMPORTED_TARGET draco)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib)
pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(OPENH264 REQUIRED IMPORTED_TARGET openh264)
pkg_check_modules(NATS REQUIRED IMPORTED_TARGET libnats)

# Header-only libraries without a usable CMake package.
add_library(furrow_glm INTERFACE)
find_path(FURROW_GLM_INCLUDE glm/glm.hpp REQUIRED)
target_include_directories(furrow_glm SYSTEM INTERFACE "${FURROW_GLM_INCLUDE}")

# Boost.Beast with Boost.Asio, headers only. Debian's default version, 1.74, is sufficient.
add_library(furrow_beast INTERFACE)
find_path(FURROW_BOOST_INCLUDE boost/beast.hpp REQUIRED)
target_include_directories(furrow_beast SYSTEM INTERFACE "${FURROW_BOOST_INCLUDE}")
target_link_libraries(furrow_beast INTERFACE Threads::Threads)
# Found with pkg-config, because the CMake package also needs the libraries of the push client.
pkg_check_modules(PROMETHEUS REQUIRED IMPORTED_TARGET prometheus-cpp-core)

add_library(furrow_cli11 INTERFACE)
find_path(FURROW_CLI11_INCLUDE CLI/CLI.hpp REQUIRED)
target_include_directories(furrow_cli11 SYSTEM INTERFACE "${FURROW_CLI11_INCLUDE}")

# bench_preview uses the web client of the tests, which needs GoogleTest.
if(FURROW_BUILD_TESTS OR FURROW_BUILD_BENCH)
  find_package(GTest REQUIRED)
endif()
if(FURROW_BUILD_TESTS)
  find_program(Python3_EXECUTABLE NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_package(Python3 COMPONENTS Interpreter REQUIRED)
endif()
if(FURROW_BUILD_BENCH)
  find_package(benchmark REQUIRED)
endif()
