// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/refusal_log.h"

#include <chrono>
#include <memory>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace furrow::server {
namespace {

using ::testing::HasSubstr;

class RefusalLogTest : public testing::Test {
 protected:
  void SetUp() override {
    auto logger = std::make_shared<spdlog::logger>(
        "refusals", std::make_shared<spdlog::sinks::ostream_sink_st>(out_));
    logger->set_pattern("%l %v");
    former_ = spdlog::default_logger();
    spdlog::set_default_logger(std::move(logger));
  }
  void TearDown() override { spdlog::set_default_logger(former_); }
  std::string Take() {
    std::string text = out_.str();
    out_.str("");
    return text;
  }

  void Note(const std::string& who, std::string_view why, Time now) {
    log_.Note([&] { return ++names_, who; }, why, now);
  }

  int names_ = 0;

 private:
  RefusalLog log_;
  std::ostringstream out_;
  std::shared_ptr<spdlog::logger> former_;
};

TEST_F(RefusalLogTest, SaysWhoIsRefusedAndWhy) {
  Note("udp 192.0.2.1", "the token has expired", std::chrono::seconds(1));
  EXPECT_EQ(Take(), "warning refused udp 192.0.2.1: the token has expired\n");
}

TEST_F(RefusalLogTest, AFloodLeavesFewLinesAndACount) {
  for (int i = 0; i < 1000; ++i) Note("udp 192.0.2.1", "forged", std::chrono::seconds(1));
  const std::string flood = Take();
  EXPECT_EQ(names_, 10);  // lines that are left out cost no text
  EXPECT_EQ(std::count(flood.begin(), flood.end(), '\n'), 10);
  Note("udp 192.0.2.7", "the token has expired", std::chrono::seconds(7));
  EXPECT_THAT(Take(), HasSubstr("192.0.2.7: the token has expired; 990 others"));
}

}  // namespace
}  // namespace furrow::server
