// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <asio/experimental/as_tuple.hpp>
#include <asio/use_awaitable.hpp>

namespace furrow::server {

// The completion token of asynchronous calls in the daemon: `co_await` returns a tuple that begins
// with the error code, and does not throw.
inline constexpr auto kAwaitTuple = asio::experimental::as_tuple(asio::use_awaitable);

}  // namespace furrow::server
