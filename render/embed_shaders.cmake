# SPDX-License-Identifier: Apache-2.0
# Run with -P: writes OUTPUT, a C++ source that holds the FILES (a comma-separated list) as strings.
string(REPLACE "," ";" files "${FILES}")
set(entries "")
foreach(file IN LISTS files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Generated from shaders/ by render/embed_shaders.cmake.
#include \"render/gl/shader_loader.h\"

namespace furrow::render {
namespace {

constexpr ShaderFile kFiles[] = {
${entries}};

}  // namespace

std::span<const ShaderFile> EmbeddedShaders() { return kFiles; }

}  // namespace furrow::render
")
