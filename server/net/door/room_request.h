// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace furrow::server {

// A newcomer's request that a connection without use gives way. It may be refused at once or later.
// Belongs to the thread of its Door.
class RoomRequest {
 public:
  // All connections are in use, so the newcomer is turned away.
  void Refuse() { is_refused_ = true; }
  // For an answer that comes later: setting it to true, on the same thread, is like Refuse(). It
  // may outlive the request, and other threads may hold it.
  [[nodiscard]] std::shared_ptr<bool> RefuseLater() {
    if (refused_later_ == nullptr) refused_later_ = std::make_shared<bool>(false);
    return refused_later_;
  }
  [[nodiscard]] bool is_refused() const {
    return is_refused_ || (refused_later_ != nullptr && *refused_later_);
  }

 private:
  bool is_refused_ = false;
  std::shared_ptr<bool> refused_later_;
};

}  // namespace furrow::server
