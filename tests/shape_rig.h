// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "wrinkle/rig/rig.h"

namespace furrow::test {

// A rig without joints: each blend shape drives the map "squash" of a region of its name.
inline wrinkle::Rig ShapeRig(std::string name, std::initializer_list<const char*> shapes) {
  wrinkle::Rig rig;
  rig.name = std::move(name);
  rig.wrinkle_maps.push_back({.name = "squash"});
  for (const char* shape : shapes) {
    wrinkle::Driver driver;
    driver.name = shape;
    driver.kind = wrinkle::Driver::Kind::kBlendShape;
    driver.blend_shape.blend_shape = shape;
    rig.drivers.push_back(driver);
    wrinkle::Region region;
    region.name = shape;
    region.feeds.push_back({"squash", {{shape, "value", 1.0f}}});
    rig.regions.push_back(region);
  }
  return rig;
}

}  // namespace furrow::test
