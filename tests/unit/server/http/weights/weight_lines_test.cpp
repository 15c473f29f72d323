// SPDX-License-Identifier: Apache-2.0
#include "server/http/weights/weight_lines.h"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"

namespace furrow::server {
namespace {

using Json = nlohmann::json;
using Line = WeightLines::Line;

class WeightLinesTest : public testing::Test {
 protected:
  template <class Message>
  Line Translate(const protocol::Header& header, const Message& message) {
    protocol::Header complete = header;
    complete.session = 1;
    encoder_.Encode(complete, message, bytes_);
    return lines_.Translate(bytes_, &line_);
  }
  Line Names(std::vector<std::string> names, std::string subject = "ada") {
    protocol::SubscribeReply reply;
    reply.subject = std::move(subject);
    reply.names_hash = protocol::NamesHash(names);
    reply.names = std::move(names);
    return Translate({.stream = 3, .sequence = 1}, reply);
  }
  Line Weights(std::vector<float> values, std::uint16_t stream = 3) {
    protocol::WeightFrame frame;
    frame.values = std::move(values);
    frame.age_us = 2'500;
    return Translate({.stream = stream, .sequence = 4'000'000'000, .capture_time_us = 17}, frame);
  }

  WeightLines lines_{{{.subject = "ada"}, {.subject = "bob"}}};
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> bytes_;
  std::string line_;
};

TEST_F(WeightLinesTest, NamesComeFirstThenShortNumbers) {
  ASSERT_EQ(Names({"brow_l.squash", "a\"b"}), Line::kText);
  EXPECT_EQ(line_, R"({"type":"names","subject":"ada","names":["brow_l.squash","a\"b"]})");
  ASSERT_EQ(Weights({0.0333f, 1.0f}), Line::kText);
  EXPECT_EQ(line_,
            R"({"type":"weights","subject":"ada","sequence":4000000000,"time_us":17,"age_ms":2,)"
            R"("values":[0.0333,1]})");
}

TEST_F(WeightLinesTest, TimecodesOfSourcesThatSendThem) {
  ASSERT_EQ(Names({"a"}), Line::kText);
  protocol::WeightFrame frame;
  frame.values = {1.0f};
  frame.timecode = MakeTimecode(17'982, 0.0, 30'000, 1001);
  ASSERT_EQ(Translate({.stream = 3, .sequence = 1, .capture_time_us = 17}, frame), Line::kText);
  EXPECT_EQ(line_, R"({"type":"weights","subject":"ada","sequence":1,"time_us":17,"age_ms":0,)"
                   R"("timecode":"00:10:00;00","values":[1]})");
}

TEST_F(WeightLinesTest, EveryFloatReadsBack) {
  ASSERT_EQ(Names({"a", "b", "c", "d"}), Line::kText);
  const std::vector<float> values = {1.0f / 3.0f, std::numeric_limits<float>::denorm_min(), 1e-7f,
                                     std::nextafter(1.0f, 0.0f)};
  ASSERT_EQ(Weights(values), Line::kText);
  EXPECT_EQ(Json::parse(line_)["values"].get<std::vector<float>>(), values);
}

TEST_F(WeightLinesTest, TellsWhoIsAwaitedWhoLeftAndWhatIsWrong) {
  ASSERT_EQ(Translate({.stream = 4, .sequence = 2}, protocol::SubscribeReply{}), Line::kText);
  EXPECT_EQ(line_, R"({"type":"waiting","subject":"bob"})");
  ASSERT_EQ(Names({"a"}), Line::kText);
  ASSERT_EQ(Translate({.stream = 3}, protocol::Goodbye{protocol::GoodbyeReason::kSubjectGone}),
            Line::kText);
  EXPECT_EQ(line_, R"({"type":"gone","subject":"ada"})");
  ASSERT_EQ(Translate({.sequence = 2},
                      protocol::ErrorMessage{protocol::ErrorCode::kNoMatch, "no \"x\" here"}),
            Line::kText);
  EXPECT_EQ(line_, R"({"type":"error","subject":"bob","message":"no \"x\" here"})");
  ASSERT_EQ(Translate({}, protocol::Goodbye{protocol::GoodbyeReason::kDraining}), Line::kLast);
  EXPECT_EQ(line_, R"({"type":"bye"})");
}

TEST_F(WeightLinesTest, ASubjectOfAnotherDaemonNamesItsAddress) {
  protocol::ErrorMessage error{
      protocol::ErrorCode::kUnknownSubject, "gone", "10.0.0.2", 7400, 7401, 7480, true};
  ASSERT_EQ(Translate({.sequence = 2}, error), Line::kText) << "the other subject goes on";
  EXPECT_EQ(line_,
            R"({"type":"error","subject":"bob","message":"gone","web":"https://10.0.0.2:7480"})");
  WeightLines single({{.subject = "ada"}});
  const auto translate = [&] {
    std::vector<std::uint8_t> bytes;
    protocol::Encoder().Encode({.session = 1, .sequence = 1}, error, bytes);
    return single.Translate(bytes, &line_);
  };
  EXPECT_EQ(translate(), Line::kLast) << "nothing else can follow";
  error.web = 0;
  EXPECT_EQ(translate(), Line::kText);
  EXPECT_EQ(line_, R"({"type":"error","subject":"ada","message":"gone"})");
}

TEST_F(WeightLinesTest, WhatBelongsToNothingIsLeftOut) {
  EXPECT_EQ(Weights({1.0f}), Line::kNone) << "before the names";
  EXPECT_EQ(Translate({.stream = 9}, protocol::Goodbye{}), Line::kNone);
  EXPECT_EQ(Translate({}, protocol::Pong{}), Line::kNone);
  ASSERT_EQ(Names({"a"}), Line::kText);
  ASSERT_EQ(Weights({1.0f}), Line::kText);
  for (std::size_t size = 0; size < bytes_.size(); ++size) {
    std::string line;
    EXPECT_EQ(lines_.Translate(std::span(bytes_).first(size), &line), Line::kNone) << size;
  }
}

}  // namespace
}  // namespace furrow::server
