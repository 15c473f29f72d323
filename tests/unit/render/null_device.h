// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "render/graph/frame_graph.h"

namespace furrow::render::test {

// A frame graph device without a GPU. It returns numbers and records which textures are alive.
class NullDevice final : public FrameGraphDevice {
 public:
  TextureId CreateTexture(const TextureDesc& desc) override {
    ++num_created_;
    alive_.emplace(next_, desc);
    return next_++;
  }
  void DestroyTexture(TextureId texture) override {
    if (alive_.erase(texture) == 0) ++num_bad_destroys_;
  }

  [[nodiscard]] int num_created() const { return num_created_; }
  [[nodiscard]] int num_alive() const { return static_cast<int>(alive_.size()); }
  [[nodiscard]] int num_bad_destroys() const { return num_bad_destroys_; }

 private:
  std::map<TextureId, TextureDesc> alive_;
  TextureId next_ = 1;
  int num_created_ = 0;
  int num_bad_destroys_ = 0;
};

}  // namespace furrow::render::test
