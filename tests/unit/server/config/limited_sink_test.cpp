// SPDX-License-Identifier: Apache-2.0
#include "server/config/limited_sink.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

namespace furrow::server {
namespace {

class LimitedSinkTest : public testing::Test {
 protected:
  void SetUp() override {
    sink = std::make_unique<LimitedSink>(std::make_shared<spdlog::sinks::ostream_sink_st>(out));
    sink->set_pattern("%l %v");
  }
  void Log(double seconds, const std::string& text,
           spdlog::level::level_enum level = spdlog::level::info) {
    const spdlog::log_clock::time_point time(
        std::chrono::duration_cast<spdlog::log_clock::duration>(
            std::chrono::duration<double>(1000.0 + seconds)));
    sink->log({time, spdlog::source_loc(), "test", level, text});
  }
  std::string Take() {
    std::string text = out.str();
    out.str("");
    return text;
  }

  std::ostringstream out;
  std::unique_ptr<LimitedSink> sink;
};

TEST_F(LimitedSinkTest, LinesWithinTheLimitPassUnchanged) {
  Log(0, "one");
  Log(0, "two", spdlog::level::warn);
  EXPECT_EQ(Take(), "info one\nwarning two\n");
}

TEST_F(LimitedSinkTest, AFloodIsCutAndTheDropsAreReported) {
  for (int i = 0; i < 5000; ++i) Log(0, "flood");
  const std::string flood = Take();
  EXPECT_EQ(std::ranges::count(flood, '\n'), static_cast<long>(LimitedSink::kBurst));
  Log(0, "broken", spdlog::level::err);
  EXPECT_EQ(Take(), "error broken\n") << "errors pass";
  Log(1, "calm");
  EXPECT_EQ(Take(), "warning 4000 log lines were dropped because of the rate limit\ninfo calm\n");
  Log(1, "calm");
  EXPECT_EQ(Take(), "info calm\n");
}

TEST_F(LimitedSinkTest, CountsItsFlushes) {
  EXPECT_EQ(sink->flushes(), 0u);
  Log(0, "one");
  sink->flush();
  EXPECT_EQ(sink->flushes(), 1u);
}

TEST_F(LimitedSinkTest, DropsAtTheEndAreReportedAtTheEnd) {
  for (int i = 0; i < 1003; ++i) Log(0, "flood");
  Take();
  sink.reset();
  EXPECT_EQ(Take(), "warning 3 log lines were dropped because of the rate limit\n");
}

}  // namespace
}  // namespace furrow::server
