// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/co_spawn.hpp>
#include <asio/io_context.hpp>

namespace furrow::server {

// Starts a coroutine that the daemon cannot work without, such as the tick or an acceptor. An
// exception propagates out of the event loop's run(), because a daemon that has silently lost a
// part is worse than one that exits. Lack of memory becomes another exception: std::bad_alloc out
// of run() means that only one handler has failed.
inline void StartCriticalTask(asio::io_context& io, asio::awaitable<void> task) {
  asio::co_spawn(io, std::move(task), [](const std::exception_ptr& failed) {
    try {
      if (failed) std::rethrow_exception(failed);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error("out of memory: a part of the daemon has ended");
    }
  });
}

}  // namespace furrow::server
