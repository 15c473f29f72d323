// SPDX-License-Identifier: Apache-2.0
#include "server/core/accept_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/log_capture.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(AcceptLog, CountsEveryFailureAndLogsTheFirst) {
  const LogCapture log;
  Metrics metrics;
  AcceptLog accepts("TCP port", "limits.max_connections", &metrics);
  accepts.Accepted();
  EXPECT_EQ(log.text(), "");
  accepts.Failed("Too many open files");
  EXPECT_THAT(log.text(), HasSubstr("Too many open files; raise LimitNOFILE= or lower "
                                    "limits.max_connections"));
  accepts.Failed("another reason");
  accepts.Failed("another reason");
  EXPECT_THAT(log.text(), Not(HasSubstr("another reason")));
  EXPECT_EQ(metrics.Get(Counter::kAcceptsFailed), 3u);
  accepts.Accepted();
  accepts.Accepted();
  EXPECT_THAT(log.text(), HasSubstr("accepts connections again"));
  EXPECT_EQ(metrics.Get(Counter::kAcceptsFailed), 3u);
}

}  // namespace
}  // namespace furrow::server
