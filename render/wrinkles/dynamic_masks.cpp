// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/dynamic_masks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/trigonometric.hpp>

#include "wrinkle/rig/driver_values.h"

namespace furrow::render {
namespace {

// Weights below this are treated as 0. A resting joint is rarely at exactly 0, and a thousandth of
// a fold is invisible.
constexpr float kMinInfluence = 1e-3f;

template <class Item>
int IndexByName(const std::vector<Item>& items, const std::string& name) {
  const auto found = std::ranges::find(items, name, &Item::name);
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

}  // namespace

// A header of 16 bytes, as std430 aligns the array behind it, and at least one mask, because a
// bound block must not be smaller than its declaration.
std::vector<std::uint8_t> DynamicMasksBlock(std::span<const DynamicMaskBlock> masks,
                                            int num_columns) {
  const std::int32_t head[4] = {num_columns, 0, 0, 0};
  std::vector<std::uint8_t> block(sizeof(head) + std::max(masks.size_bytes(),  //
                                                          sizeof(DynamicMaskBlock)));
  std::memcpy(block.data(), head, sizeof(head));
  if (!masks.empty()) std::memcpy(&block[sizeof(head)], masks.data(), masks.size_bytes());
  return block;
}

DynamicMasks::DynamicMasks(const wrinkle::RigBinding* painted, const wrinkle::RigBinding* skinning)
    : painted_(painted), skinning_(skinning) {
  FindSlides(*painted);
}

void DynamicMasks::FindSlides(const wrinkle::RigBinding& binding) {
  const wrinkle::Rig& rig = binding.rig();
  const auto values = binding.driver_value_names();
  std::size_t weight = 0;
  for (const wrinkle::Region& region : rig.regions) {
    for (const wrinkle::Feed& feed : region.feeds) {
      // Counts every feed, also those that are skipped: the position is the one in weight_names().
      const std::size_t index = weight++;
      if (region.mask.kind != wrinkle::Mask::Kind::kSliding) continue;
      const wrinkle::Driver& driver =
          rig.drivers[static_cast<std::size_t>(IndexByName(rig.drivers, region.mask.driver))];
      const auto frame = wrinkle::RestSlidingFrame(driver, feed, binding.skeleton());
      const std::vector<std::string> names = wrinkle::DriverValueNames(driver);
      const auto first = std::ranges::find(values, driver.name + "." + names.front());
      if (!frame || first == values.end()) continue;  // a joint is missing; draw nothing
      slides_.push_back({.map = IndexByName(rig.wrinkle_maps, feed.map),
                         .weight = index,
                         .first_value = static_cast<std::size_t>(first - values.begin()),
                         .num_values = names.size(),
                         .frame = *frame,
                         .mask = region.mask});
    }
  }
}

const wrinkle::RigBinding& DynamicMasks::BindingOf(MaskMode mode) const {
  return mode == MaskMode::kDynamic ? *skinning_ : *painted_;
}

std::vector<SkinnedShare> DynamicMasks::Shares(MaskMode mode) const {
  const wrinkle::RigBinding& binding = BindingOf(mode);
  const auto masks = binding.dynamic_masks();
  std::vector<SkinnedShare> shares;
  for (const std::size_t place : binding.InfluencedPlaces()) {
    const std::size_t column = place % masks.size();
    shares.push_back(
        {static_cast<int>(place / masks.size()), static_cast<int>(column), masks[column]});
  }
  return shares;
}

void DynamicMasks::Update(MaskMode mode, std::span<const float> values,
                          std::span<const float> weights) {
  const wrinkle::RigBinding& binding = BindingOf(mode);
  columns_ = binding.dynamic_masks();
  values_.assign(values.begin(), values.end());
  weights_.assign(weights.begin(), weights.end());
  slides_work_ = mode != MaskMode::kTexture;
  influences_.assign(static_cast<std::size_t>(binding.skeleton().num_joints()) * columns_.size(),
                     0.0f);
  column_works_.assign(columns_.size(), false);
  if (mode == MaskMode::kTexture || columns_.empty()) return;
  const wrinkle::JointInfluenceJob job{&binding, values_, influences_};
  if (job.Run() != wrinkle::JobStatus::kOk) {
    std::ranges::fill(influences_, 0.0f);  // non-finite values draw no wrinkles
    return;
  }
  for (std::size_t i = 0; i < influences_.size(); ++i) {
    if (influences_[i] > kMinInfluence) column_works_[i % columns_.size()] = true;
  }
}

DynamicMaskBlock DynamicMasks::BlockOf(const Slide& slide) const {
  const glm::vec3 towards = wrinkle::BendDirection(
      slide.frame, std::span(values_).subspan(slide.first_value, slide.num_values));
  DynamicMaskBlock block;
  block.origin = glm::vec4(slide.frame.origin, weights_[slide.weight]);
  block.towards = glm::vec4(towards, std::cos(glm::radians(slide.mask.spread_degrees)));
  block.bone = glm::vec4(slide.frame.bone, 1.0f / slide.frame.length);
  block.extent = {slide.mask.above, slide.mask.below, slide.mask.radius, 0.0f};
  return block;
}

void DynamicMasks::Append(int map, std::vector<DynamicMaskBlock>* masks) const {
  const std::size_t before = masks->size();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].map != map || !column_works_[i]) continue;
    DynamicMaskBlock block;
    block.column = static_cast<std::int32_t>(i);
    block.lambda = static_cast<std::int32_t>(columns_[i].lambda);
    block.smooth_width = columns_[i].smooth_width;
    masks->push_back(block);
  }
  for (const Slide& slide : slides_) {
    if (!slides_work_ || slide.map != map || !(weights_[slide.weight] > 0.0f)) continue;
    const DynamicMaskBlock block = BlockOf(slide);
    if (glm::vec3(block.towards) != glm::vec3(0.0f)) masks->push_back(block);
  }
  for (std::size_t i = before; i < masks->size(); ++i) (*masks)[i].slot = map;
}

}  // namespace furrow::render
