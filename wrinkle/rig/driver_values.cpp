// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const Driver& driver) {
  switch (driver.kind) {
    case Driver::Kind::kHinge: return {"flexed", "extended"};
    case Driver::Kind::kBall: return {"front", "back", "left", "right"};
    case Driver::Kind::kTwist: return {"twist_left", "twist_right"};
    case Driver::Kind::kBlendShape: return {"value"};
    case Driver::Kind::kStrain: return {"along", "across", "diagonal_left", "diagonal_right"};
    case Driver::Kind::kPose: break;
  }
  std::vector<std::string> names;
  for (const PoseDriver::Value& value : driver.pose.values) names.push_back(value.name);
  return names;
}

}  // namespace furrow::wrinkle
