// SPDX-License-Identifier: Apache-2.0
#include "client/cli/output/take_conversion.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/cli/play/play_source.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/envelope.h"
#include "protocol/messages/hash.h"
#include "recording/take_clip.h"
#include "recording/take_writer.h"
#include "tests/temporary_folder.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;
using recording::TakeKind;

class TakeConversionTest : public testing::Test {
 protected:
  static motion::Clip MakeClip() {
    motion::Clip clip;
    clip.name = "ada";
    clip.skeleton = *wrinkle::Skeleton::Create({{.name = "hip"}});
    clip.blend_shape_names = {"jawOpen"};
    clip.times = {3.0, 3.5, 3.75};
    for (int i = 0; i < 3; ++i) {
      clip.locals.push_back(clip.skeleton.rest_pose()[0]);
      clip.locals.back().translation.y = static_cast<float>(i);
      clip.blend_shapes.push_back(0.25f * static_cast<float>(i));
    }
    return clip;
  }
  template <class Message>
  void Put(recording::TakeWriter& take, TakeKind kind, const std::string& subject,
           std::uint32_t sequence, const Message& message) {
    std::vector<std::uint8_t> bytes;
    encoder_.Encode({.session = 1}, message, bytes);
    const recording::TakeStamp stamp{1, sequence, 500'000 * std::int64_t{sequence}, sequence + 1};
    ASSERT_TRUE(
        take.Write(kind, subject, stamp, std::span(bytes).subspan(protocol::kEnvelopeBytes)).ok());
  }

  TemporaryFolder folder_;
  protocol::Encoder encoder_;
};

TEST_F(TakeConversionTest, AClipRoundTripsThroughATake) {
  const motion::Clip clip = MakeClip();
  const std::string path = (folder_ / "clip.mcap").string();
  ASSERT_TRUE(SaveTake(clip, path).ok());
  const auto back = recording::LoadTakeClip(path);
  ASSERT_TRUE(back.ok()) << back.status().ToString();
  EXPECT_EQ(back->name, "ada");
  EXPECT_EQ(back->times, (std::vector<double>{0.0, 0.5, 0.75}));
  EXPECT_EQ(back->blend_shapes, clip.blend_shapes);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(back->locals[i].translation, clip.locals[i].translation);
  EXPECT_EQ(SaveTake(clip, path).code(), StatusCode::kIo) << "never overwritten";
}

TEST_F(TakeConversionTest, TimecodesRoundTripThroughATake) {
  motion::Clip clip = MakeClip();
  const std::string without = (folder_ / "without.mcap").string();
  ASSERT_TRUE(SaveTake(clip, without).ok());
  EXPECT_TRUE(recording::LoadTakeClip(without)->timecodes.empty());
  clip.timecodes = {MakeTimecode(1799, 0.0, 30'000, 1001), std::nullopt,
                    MakeTimecode(1800, 0.5, 30'000, 1001)};
  const std::string with = (folder_ / "with.mcap").string();
  ASSERT_TRUE(SaveTake(clip, with).ok());
  EXPECT_EQ(recording::LoadTakeClip(with)->timecodes, clip.timecodes);
}

TEST_F(TakeConversionTest, AClipThatTheWireCannotCarryLeavesNoFile) {
  motion::Clip clip = MakeClip();
  clip.blend_shapes[1] = 1e9f;
  const fs::path path = folder_ / "clip.mcap";
  const Status status = SaveTake(clip, path);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.ToString().find("frame 1"), std::string::npos);
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(TakeConversionTest, ATakeIsPlayedUnderItsRecordedName) {
  const std::string path = (folder_ / "clip.mcap").string();
  ASSERT_TRUE(SaveTake(MakeClip(), path).ok());
  const auto sources = PlaySource::Load(path);
  ASSERT_TRUE(sources.ok());
  ASSERT_EQ(sources->size(), 1u);
  const PlaySource* source = &sources->front();
  EXPECT_EQ(source->subject(), "ada");
  EXPECT_EQ(source->times().size(), 3u);
  EXPECT_EQ(source->Offer("bob", 0.01f).subject, "bob");
  EXPECT_EQ(source->Offer("bob", 0.01f).metres_per_unit, 0.01f);
  protocol::PoseFrame pose;
  source->Fill(2, &pose);
  EXPECT_EQ(pose.blend_shapes, (std::vector<float>{0.5f}));
}

TEST_F(TakeConversionTest, TheTableContainsOnlyWeightsOfNewPoses) {
  auto take = *recording::TakeWriter::Create(folder_ / "take.mcap", {});
  protocol::SubscribeReply names{.subject = "ada", .names_hash = 0, .names = {"a.x", "b.y"}};
  Put(*take, TakeKind::kNames, "ada", 0, names);
  protocol::WeightFrame weights;
  weights.names_hash = 0;
  {  // Reads the hash that the encoder gave the names.
    std::vector<std::uint8_t> bytes;
    encoder_.Encode({.session = 1}, names, bytes);
    protocol::MessageView view;
    ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
    ASSERT_EQ(protocol::Decode(view, names), protocol::DecodeStatus::kOk);
    weights.names_hash = names.names_hash;
  }
  weights.values = {0.5f, 0.25f};
  Put(*take, TakeKind::kWeights, "ada", 3, weights);
  weights.age_us = 100;
  Put(*take, TakeKind::kWeights, "ada", 3, weights);  // held without a new pose
  weights.age_us = 0;
  weights.values = {1.0f, 0.0f};
  Put(*take, TakeKind::kWeights, "ada", 5, weights);
  weights.names_hash ^= 1;
  Put(*take, TakeKind::kWeights, "ada", 6, weights);  // with other names
  ASSERT_TRUE(take->Close().ok());
  const auto reader = recording::TakeReader::Open(folder_ / "take.mcap");
  ASSERT_TRUE(reader.ok());
  motion::ClipReport report;
  const auto csv = WeightsToCsv(**reader, "", &report);
  ASSERT_TRUE(csv.ok()) << csv.status().ToString();
  EXPECT_EQ(*csv,
            "frame,time,a.x,b.y\n3,0.000000,0.500000,0.250000\n5,1.000000,1.000000,0.000000\n");
  EXPECT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(WeightsToCsv(**reader, "bob", &report).status().code(), StatusCode::kNotFound);
}

TEST_F(TakeConversionTest, TimecodesAreTheLastColumnOfTheTable) {
  auto take = *recording::TakeWriter::Create(folder_ / "take.mcap", {});
  const std::vector<std::string> names = {"a.x"};
  Put(*take, TakeKind::kNames, "ada", 0,
      protocol::SubscribeReply{.subject = "ada", .names_hash = 0, .names = names});
  protocol::WeightFrame weights;
  weights.names_hash = protocol::NamesHash(names);
  weights.values = {0.5f};
  Put(*take, TakeKind::kWeights, "ada", 1, weights);  // before the source has a timecode
  weights.timecode = MakeTimecode(1799, 0.0, 30'000, 1001);
  Put(*take, TakeKind::kWeights, "ada", 2, weights);
  weights.timecode = MakeTimecode(1800, 0.0, 30'000, 1001);
  Put(*take, TakeKind::kWeights, "ada", 3, weights);
  ASSERT_TRUE(take->Close().ok());
  const auto reader = recording::TakeReader::Open(folder_ / "take.mcap");
  ASSERT_TRUE(reader.ok());
  motion::ClipReport report;
  const auto csv = WeightsToCsv(**reader, "", &report);
  ASSERT_TRUE(csv.ok()) << csv.status().ToString();
  EXPECT_EQ(*csv,
            "frame,time,a.x,timecode\n"
            "1,0.000000,0.500000,\n"
            "2,0.500000,0.500000,00:00:59;29\n"
            "3,1.000000,0.500000,00:01:00;02\n");
}

}  // namespace
}  // namespace furrow::cli
