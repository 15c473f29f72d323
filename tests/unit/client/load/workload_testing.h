// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "client/load/schedule/plan.h"
#include "client/load/schedule/workload.h"

namespace furrow::load {

// All slots of a plan, in due order.
inline std::vector<Plan::Slot> SlotsOf(const Plan& plan) {
  std::vector<Plan::Slot> all;
  for (PlanSlots slots(plan); !slots.done(); slots.Pop()) all.push_back(slots.next());
  return all;
}

// A face with three blend shapes that move at different speeds, with a filter: 40 frames at 50 Hz.
inline Workload MakePerformance(const wrinkle::Filter& filter = {}) {
  wrinkle::Rig rig;
  rig.filter = filter;
  rig.wrinkle_maps.push_back({.name = "squash"});
  Workload workload;
  for (const char* name : {"a", "b", "c"}) {
    wrinkle::Driver& driver = rig.drivers.emplace_back();
    driver.name = name;
    driver.kind = wrinkle::Driver::Kind::kBlendShape;
    driver.blend_shape.blend_shape = name;
    wrinkle::Region& region = rig.regions.emplace_back();
    region.name = name;
    region.mask.kind = wrinkle::Mask::Kind::kSkinning;
    region.feeds.push_back({.map = "squash", .sources = {{name, "value", 1.0f}}});
    workload.offer.blend_shape_names.push_back(name);
  }
  auto binding =
      wrinkle::RigBinding::Create(rig, wrinkle::Skeleton(), workload.offer.blend_shape_names);
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  workload.binding = std::make_shared<const wrinkle::RigBinding>(*std::move(binding));
  for (int frame = 0; frame < 40; ++frame) workload.times.push_back(0.02 * frame);
  workload.pose = [](int frame, wrinkle::LocalPose* pose) {
    pose->blend_shapes.resize(3);
    for (int i = 0; i < 3; ++i) {
      const double turn = 2.0 * 3.14159265358979 * (i + 1) * frame / 40.0 + i;
      pose->blend_shapes[static_cast<std::size_t>(i)] =
          static_cast<float>(0.5 + 0.45 * std::sin(turn));
    }
  };
  return workload;
}

}  // namespace furrow::load
