// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace furrow::server {

// Calls `ended` when it is destroyed, unless its owner has gone. For coroutines, which are
// destroyed without an end if an operation lacks memory, and may outlive their server.
template <class Function>
class EndNotice {
 public:
  // Does not allocate.
  EndNotice(const std::shared_ptr<void>& owner, Function ended)
      : owner_(owner), ended_(std::move(ended)) {}
  ~EndNotice() {
    if (!owner_.expired()) ended_();
  }
  EndNotice(const EndNotice&) = delete;
  EndNotice& operator=(const EndNotice&) = delete;

  // It calls nothing any more.
  void Cancel() { owner_.reset(); }

 private:
  std::weak_ptr<void> owner_;
  const Function ended_;
};

}  // namespace furrow::server
