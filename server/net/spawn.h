// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <utility>

#include <asio/awaitable.hpp>
#include <asio/co_spawn.hpp>
#include <asio/io_context.hpp>

namespace furrow::server {

// Runs what a daemon cannot be without (its tick, an acceptor). What it throws is thrown by the
// loop's run(): no part may fall silent while the rest goes on.
inline void SpawnVital(asio::io_context& io, asio::awaitable<void> part) {
  asio::co_spawn(io, std::move(part), [](const std::exception_ptr& failed) {
    if (failed) std::rethrow_exception(failed);
  });
}

}  // namespace furrow::server
