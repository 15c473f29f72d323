// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/draco_call.h"

#include <string>

#include "authoring/draco/draco_wire.h"
#include "base/process/helper_call.h"

namespace furrow::authoring {
namespace {

constexpr ProcessLimits kDracoLimits = {.max_memory_bytes = std::size_t{4} << 30,
                                        .max_cpu_seconds = 60,
                                        .max_seconds = 180,
                                        .max_output_bytes = std::size_t{1} << 30};

}  // namespace

gltf::DracoDecoder DracoInHelper() {
  return [](std::span<const std::span<const std::uint8_t>> meshes)
             -> Result<std::vector<gltf::DracoMesh>> {
    const auto reply = CallHelper("furrow-draco", std::span<const std::string>(),
                                  EncodeDracoCall(meshes), kDracoLimits);
    FURROW_RETURN_IF_ERROR(reply);
    return DecodeDracoMeshes(reply->payload);
  };
}

}  // namespace furrow::authoring
