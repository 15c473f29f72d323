// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "client/c/feed.h"
#include "client/c/include/furrow/furrow.h"

namespace furrow::capi {

// Passes events on to the program's callbacks. A callback may replace the callbacks.
class Listener {
 public:
  void Set(const furrow_callbacks& callbacks) { callbacks_ = callbacks; }

  void OnWeights(const Feed& feed, const furrow_frame& frame) const {
    if (callbacks_.on_weights == nullptr) return;
    callbacks_.on_weights(callbacks_.user, feed.subject().c_str(), &frame, feed.values().data());
  }
  void OnLayout(const Feed& feed) const {
    if (callbacks_.on_layout == nullptr) return;
    std::vector<const char*> names;
    for (const std::string& name : feed.names()) names.push_back(name.c_str());
    callbacks_.on_layout(callbacks_.user, feed.subject().c_str(), feed.layout(), names.data(),
                         static_cast<std::uint32_t>(names.size()));
  }
  void OnSubjectGone(const Feed& feed) const {
    if (callbacks_.on_subject_gone == nullptr) return;
    callbacks_.on_subject_gone(callbacks_.user, feed.subject().c_str());
  }
  void OnState(furrow_state state) const {
    if (callbacks_.on_state != nullptr) callbacks_.on_state(callbacks_.user, state);
  }

 private:
  furrow_callbacks callbacks_{};
};

}  // namespace furrow::capi
