// SPDX-License-Identifier: Apache-2.0
#include "server/net/run_loop.h"

#include <new>
#include <stdexcept>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <gtest/gtest.h>

#include "server/net/critical_task.h"

namespace furrow::server {
namespace {

asio::awaitable<void> RunOutOfMemory() {
  throw std::bad_alloc();
  co_return;
}

TEST(RunLoop, AHandlerWithoutMemoryEndsAlone) {
  asio::io_context loop;
  Metrics metrics;
  bool goes_on = false;
  asio::post(loop, [] { throw std::bad_alloc(); });
  asio::post(loop, [&] { goes_on = true; });
  RunLoop(loop, &metrics);
  EXPECT_TRUE(goes_on);
  EXPECT_EQ(metrics.Get(Counter::kAllocationsFailed), 1u);
}

TEST(RunLoop, WhatTheDaemonCannotDoWithoutEndsIt) {
  asio::io_context loop;
  Metrics metrics;
  StartCriticalTask(loop, RunOutOfMemory());
  EXPECT_THROW(RunLoop(loop, &metrics), std::runtime_error);
}

}  // namespace
}  // namespace furrow::server
