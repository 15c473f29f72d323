// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace furrow {

// A stream of bytes with or without an upper layer, such as TLS, that is added once it is open.
// Asynchronous reads and writes go to the upper layer if there is one. For the streams of every
// Asio: standalone, Boost and Beast. Not movable, because the upper layer points to the lower one.
template <class Lower, class Upper>
class LayeredStream {
 public:
  using executor_type = typename Lower::executor_type;

  template <class... Arguments>
  explicit LayeredStream(Arguments&&... arguments)
      : lower_(std::forward<Arguments>(arguments)...) {}
  LayeredStream(const LayeredStream&) = delete;
  LayeredStream& operator=(const LayeredStream&) = delete;

  [[nodiscard]] executor_type get_executor() { return lower_.get_executor(); }
  [[nodiscard]] Lower& lower() { return lower_; }
  [[nodiscard]] const Lower& lower() const { return lower_; }
  // The upper layer; null if there is none.
  [[nodiscard]] Upper* upper() const { return upper_.get(); }

  // Adds the upper layer, made from the lower one and `arguments`. No read or write may be pending.
  template <class... Arguments>
  void AddUpper(Arguments&&... arguments) {
    upper_ = std::make_unique<Upper>(lower_, std::forward<Arguments>(arguments)...);
  }

  template <class Buffers, class Handler>
  auto async_read_some(const Buffers& buffers, Handler&& handler) {
    if (upper_) return upper_->async_read_some(buffers, std::forward<Handler>(handler));
    return lower_.async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  auto async_write_some(const Buffers& buffers, Handler&& handler) {
    if (upper_) return upper_->async_write_some(buffers, std::forward<Handler>(handler));
    return lower_.async_write_some(buffers, std::forward<Handler>(handler));
  }

 private:
  Lower lower_;
  std::unique_ptr<Upper> upper_;
};

}  // namespace furrow
