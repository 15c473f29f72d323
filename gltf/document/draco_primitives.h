// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "base/status.h"
#include "gltf/document/buffer_view.h"
#include "gltf/document/draco_mesh.h"

namespace furrow::gltf {

// Decodes the primitives of `json` that KHR_draco_mesh_compression has compressed. Adds buffers,
// buffer views and accessors for their attributes and indices, to which the primitives then refer,
// so that readers see plain primitives. Attributes that the extension does not list stay as they
// are.
//
// Errors: kSchema (a buffer view or attribute that does not exist, counts that differ from the
// accessors'), kLimit (more than kMaxDracoMeshes, or kMaxFileBytes decoded), those of `decode`.
// `where` is a field.
[[nodiscard]] Status DecodeDracoPrimitives(const DracoDecoder& decode, nlohmann::json* json,
                                           BufferViews* views);

}  // namespace furrow::gltf
