# SPDX-License-Identifier: Apache-2.0
# Run with -P. Writes OUTPUT, a C++ source that holds the FILES (a comma-separated list) as strings,
# each under its path relative to ROOT.
string(REPLACE "," ";" files "${FILES}")
set(entries "")
foreach(file IN LISTS files)
  file(RELATIVE_PATH name "${ROOT}" "${file}")
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
