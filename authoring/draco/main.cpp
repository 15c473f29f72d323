// SPDX-License-Identifier: Apache-2.0
// furrow-draco: decodes meshes of KHR_draco_mesh_compression. `furrow-author` starts it with limits
// on memory and time, because libdraco allocates what a file states and has no limits of its own;
// see base/process/helper_call.h.
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "authoring/draco/draco_decoder.h"
#include "authoring/draco/draco_wire.h"
#include "base/process/helper_call.h"

namespace furrow::authoring {
namespace {

Result<HelperReply> DecodeAll(std::string_view input) {
  const auto compressed = DecodeDracoCall(input);
  FURROW_RETURN_IF_ERROR(compressed);
  std::vector<gltf::DracoMesh> meshes;
  for (const std::string_view mesh : *compressed) {
    Result<gltf::DracoMesh> decoded = DecodeDraco(mesh);
    FURROW_RETURN_IF_ERROR(decoded);
    meshes.push_back(std::move(*decoded));
  }
  return HelperReply{{}, EncodeDracoMeshes(meshes)};
}

int Run(int argc) {
  if (argc == 1) return AnswerCall(DecodeAll);
  std::fprintf(stderr,
               "usage: furrow-draco <MESHES\n"
               "A part of furrow, which starts it to read glTF files with Draco.\n");
  return 2;
}

}  // namespace
}  // namespace furrow::authoring

int main(int argc, char**) { return furrow::authoring::Run(argc); }
