// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <asio/awaitable.hpp>
#include <asio/steady_timer.hpp>
#include <asio/this_coro.hpp>

#include "server/core/time.h"
#include "server/net/await_tuple.h"

namespace furrow::server {

// Waits for `time` on the event loop of the coroutine that awaits it.
[[nodiscard]] inline asio::awaitable<void> Pause(Time time) {
  asio::steady_timer timer(co_await asio::this_coro::executor);
  timer.expires_after(time);
  co_await timer.async_wait(kAwaitTuple);
}

}  // namespace furrow::server
