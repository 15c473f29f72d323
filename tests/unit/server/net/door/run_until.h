// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include <asio/io_context.hpp>

namespace furrow::server {

// Runs the loop until `done` returns true. False after a time that only a hanging test needs.
template <class Done>
[[nodiscard]] bool RunUntil(asio::io_context& loop, const Done& done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    if (loop.stopped()) loop.restart();
    loop.run_one_for(std::chrono::milliseconds(10));
  }
  return true;
}

}  // namespace furrow::server
