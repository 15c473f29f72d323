// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/co_spawn.hpp>
#include <asio/io_context.hpp>

namespace furrow::server {

// Starts a coroutine that the daemon cannot work without, such as the tick or an acceptor. An
// exception propagates out of the event loop's run(), because a daemon that has silently lost a
// part is worse than one that exits.
inline void StartCriticalTask(asio::io_context& io, asio::awaitable<void> task) {
  asio::co_spawn(io, std::move(task), [](const std::exception_ptr& failed) {
    if (failed) std::rethrow_exception(failed);
  });
}

}  // namespace furrow::server
