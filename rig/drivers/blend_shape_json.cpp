// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {

Status ReadFields(const schema::BlendShapeDriver& from, const std::string&,
                  wrinkle::BlendShapeDriver* to) {
  to->blend_shape = from.blend_shape()->str();
  to->neutral = from.neutral();
  to->full = from.full();
  return {};
}

std::string FieldsToJson(const wrinkle::BlendShapeDriver& shape) {
  return Object()
      .Text("blend_shape", shape.blend_shape)
      .Float("neutral", shape.neutral, 0.0f)
      .Float("full", shape.full, 1.0f)
      .str();
}

}  // namespace furrow::rig
