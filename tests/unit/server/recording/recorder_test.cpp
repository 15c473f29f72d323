// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recorder.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>

#include "recording/take_poses.h"
#include "recording/take_summary.h"
#include "rig/rig_file.h"
#include "server/net/clock.h"
#include "tests/shape_rig.h"
#include "tests/temporary_folder.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

namespace fs = std::filesystem;
using recording::TakeKind;
using recording::TakeMessage;

// A hub with a recorder, and the contents of the take after closing.
class RecorderTest : public HubTest {
 protected:
  void SetUp() override {
    auto started = Recorder::Start({.folder = {.folder = folder_.path(), .rig_json = "{}"},
                                    .wall_offset = FromSeconds(5000),
                                    .retry = Time(0),
                                    .least_space = 0},
                                   now, &metrics);
    ASSERT_TRUE(started.ok()) << started.status().ToString();
    recorder_ = *std::move(started);
    Hub::Parts parts;
    parts.session = 4242;
    parts.rig = std::make_shared<const wrinkle::Rig>(MakeRig(/*filter=*/false));
    parts.metrics = &metrics;
    parts.random = [] { return 1u; };
    parts.recording = recorder_.get();
    hub = std::make_unique<Hub>(std::move(parts));
    Connect(&sender_);
  }
  void TearDown() override { recorder_.reset(); }
  // Closes the recording and reads its only take.
  std::unique_ptr<recording::TakeReader> Finish() {
    recorder_.reset();
    auto take = recording::TakeReader::Open(fs::directory_iterator(folder_.path())->path());
    EXPECT_TRUE(take.ok()) << take.status().ToString();
    return take.ok() ? *std::move(take) : nullptr;
  }

  TemporaryFolder folder_;
  std::unique_ptr<Recorder> recorder_;
  FakePeer sender_;
};

TEST_F(RecorderTest, PosesAndWeightsAreRecordedWithTheirTimes) {
  Publish(sender_, "ada");
  Publish(sender_, "ada");  // repeated, as senders do until they receive the reply
  Send(sender_, Pose(0.25f, 1.0f), 1, 0, 7'000);
  const auto take = Finish();
  int seen = 0;
  ASSERT_TRUE(take->ForEach([&](const TakeMessage& message) {
                    EXPECT_EQ(message.subject, "ada");
                    EXPECT_EQ(message.stamp.session, sender_.session);
                    EXPECT_EQ(message.stamp.log_time_ns, 6000'000'000'000u) << "1000 s + 5000 s";
                    ++seen;
                    if (message.kind != TakeKind::kWeights) return true;
                    EXPECT_EQ(message.stamp.capture_time_us, 7'000);
                    protocol::WeightFrame weights;
                    EXPECT_EQ(protocol::Decode(message.View(), weights),
                              protocol::DecodeStatus::kOk);
                    EXPECT_EQ(weights.values, (std::vector<float>{0.25f, 1.0f}));
                    EXPECT_EQ(weights.age_us, 0);
                    return true;
                  })
                  .ok());
  EXPECT_EQ(seen, 4) << "skeleton, names, pose, weights";
  EXPECT_EQ(Count(Counter::kRecordingMessages), 4u);
  EXPECT_EQ(Count(Counter::kRecordingDropped), 0u);
}

TEST_F(RecorderTest, APartialPoseIsRecordedWhole) {
  Publish(sender_, "ada");
  Send(sender_, Pose(0.25f, 1.0f), 1, 0, 1'000);
  auto partial = Pose(0.5f);
  partial.partial = true;
  partial.blend_shape_indices = {0};
  partial.blend_shapes = {0.5f};
  Send(sender_, partial, 1, 1, 2'000);
  const auto poses = recording::TakePoses::Load(*Finish(), "ada", nullptr);
  ASSERT_TRUE(poses.ok()) << poses.status().ToString();
  ASSERT_EQ(poses->size(), 2u);
  protocol::PoseFrame pose;
  poses->Get(1, &pose);
  EXPECT_FALSE(pose.partial);
  EXPECT_EQ(pose.blend_shapes, (std::vector<float>{0.5f, 1.0f}));
}

TEST_F(RecorderTest, AnotherRigBeginsAnotherFile) {
  Publish(sender_, "ada");
  Send(sender_, Pose(0.25f, 1.0f), 1, 0, 1'000);
  const wrinkle::Rig other = test::ShapeRig("other", {"nose"});
  ASSERT_TRUE(hub->SetRig(std::make_shared<const wrinkle::Rig>(other), now).ok());
  Advance(1);
  Send(sender_, Pose(0.25f, 1.0f), 1, 1, 2'000);
  const std::size_t num_weights = hub->subjects().all()[0]->pipeline->wrinkle_weights().size();
  recorder_.reset();
  std::vector<std::size_t> values;  // of the weights of each file
  std::vector<std::string> rigs;
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_.path())) files.insert(entry.path());
  ASSERT_EQ(files.size(), 2u);
  for (const fs::path& file : files) {
    const auto take = recording::TakeReader::Open(file);
    ASSERT_TRUE(take.ok()) << take.status().ToString();
    const auto rig = (*take)->file().ReadAttachment((*take)->file().attachments().at(0));
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    rigs.emplace_back(rig->begin(), rig->end());
    std::uint64_t names = 0;
    ASSERT_TRUE(
        (*take)
            ->ForEach([&](const TakeMessage& message) {
              protocol::SubscribeReply declared;
              protocol::WeightFrame frame;
              if (message.kind == TakeKind::kNames) {
                EXPECT_EQ(protocol::Decode(message.View(), declared), protocol::DecodeStatus::kOk);
                names = protocol::NamesHash(declared.names);
              }
              if (message.kind == TakeKind::kWeights) {
                EXPECT_EQ(protocol::Decode(message.View(), frame), protocol::DecodeStatus::kOk);
                EXPECT_EQ(frame.names_hash, names) << file;
                values.push_back(frame.values.size());
              }
              return true;
            })
            .ok());
  }
  EXPECT_EQ(rigs, (std::vector<std::string>{"{}", rig::RigToJson(other)}));
  EXPECT_EQ(values.back(), num_weights);
}

TEST_F(RecorderTest, ARemovedFileIsFollowedByAnother) {
  Publish(sender_, "ada");
  const auto files = [this] {
    std::set<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_.path())) found.insert(entry.path());
    return found;
  };
  const fs::path first = *files().begin();
  fs::rename(first, folder_ / "moved.txt");
  // The recorder looks at each flush.
  while (files().size() < 2) std::this_thread::yield();
  now = ReadClock() + FromSeconds(1);  // the clock of the recording thread
  Send(sender_, Pose(0.25f, 1.0f), 1, 0, 1'000);
  recorder_.reset();
  std::set<fs::path> after = files();
  after.erase(folder_ / "moved.txt");
  ASSERT_EQ(after.size(), 1u);
  const auto poses = recording::TakePoses::Load(
      *recording::TakeReader::Open(*after.begin()).value(), "ada", nullptr);
  ASSERT_TRUE(poses.ok()) << poses.status().ToString();
  EXPECT_EQ(poses->size(), 1u);
}

TEST_F(RecorderTest, AFailedStartLeavesNoFile) {
  recorder_->Discard();
  recorder_.reset();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RecorderTest, TimecodesAreRecordedWithPosesAndWeights) {
  Publish(sender_, "ada");
  protocol::PoseFrame whole = Pose(0.25f);
  whole.timecode = MakeTimecode(1799, 0.0, 30'000, 1001);
  Send(sender_, whole, 1, 0, 1'000);
  protocol::PoseFrame partial = whole;  // which is recorded in another encoding
  partial.partial = true;
  partial.timecode = MakeTimecode(1800, 0.0, 30'000, 1001);
  Send(sender_, partial, 1, 1, 2'000);
  std::vector<std::string> poses;
  std::vector<std::string> weights;
  const auto text = [](const std::optional<Timecode>& timecode) {
    return timecode ? TimecodeText(*timecode) : std::string("none");
  };
  ASSERT_TRUE(Finish()
                  ->ForEach([&](const TakeMessage& message) {
                    protocol::PoseFrame pose;
                    protocol::WeightFrame frame;
                    if (protocol::Decode(message.View(), pose) == protocol::DecodeStatus::kOk) {
                      poses.push_back(text(pose.timecode));
                    } else if (protocol::Decode(message.View(), frame) ==
                               protocol::DecodeStatus::kOk) {
                      weights.push_back(text(frame.timecode));
                    }
                    return true;
                  })
                  .ok());
  EXPECT_EQ(poses, (std::vector<std::string>{"00:00:59;29", "00:01:00;02"}));
  EXPECT_EQ(weights, poses);
}

// A limit on the size of files stands for the full disk.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(RecorderTest, GoesOnInANewFileWhenTheDiskHasRoom) {
  Publish(sender_, "ada");
  std::uint64_t sequence = 0;
  const auto send_until = [&](bool is_paused) {
    while (recorder_->is_paused() != is_paused) {
      Send(sender_, Pose(0.25f, 1.0f), 1, sequence++, 7'000);
      now += FromSeconds(1e-4);  // half of what a peer may send
      std::this_thread::yield();
    }
  };
  {
    const FullDisk full;
    send_until(true);
    EXPECT_EQ(Count(Counter::kRecordingFailures), 1u);
    // A subject that comes during the pause.
    Publish(sender_, "bob", 2);
  }
  send_until(false);
  Send(sender_, Pose(0.5f, 1.0f), 1, sequence++, 7'000);
  Send(sender_, Pose(0.5f, 1.0f), 2, 0, 7'000);
  recorder_.reset();
  EXPECT_GT(Count(Counter::kRecordingDropped), 0u) << "nothing is lost silently";
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_.path())) files.push_back(entry.path());
  ASSERT_EQ(files.size(), 2u) << "failed attempts leave nothing behind";
  std::sort(files.begin(), files.end());
  const auto take = recording::TakeReader::Open(files.back());
  ASSERT_TRUE(take.ok()) << take.status().ToString();
  const auto summary = recording::Summarise(**take);
  ASSERT_TRUE(summary.ok()) << summary.status().ToString();
  EXPECT_GE(summary->subjects.at("ada").poses, 1u);
  EXPECT_EQ(summary->subjects.at("bob").poses, 1u);
}

TEST_F(RecorderTest, DroppedPosesAreNotRecorded) {
  Publish(sender_, "ada");
  Send(sender_, Pose(0.25f), 1, 5, 1'000);
  Send(sender_, Pose(0.75f), 1, 5, 1'000);  // twice
  Send(sender_, Pose(0.75f), 1, 4, 900);    // late
  Send(sender_, Pose(0.75f), 2, 6, 1'000);  // from a stream without an offer
  const auto summary = recording::Summarise(*Finish());
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->subjects.at("ada").poses, 1u);
}

TEST_F(RecorderTest, DatagramsAreRecordedUnchanged) {
  recording::DatagramSender sender{};
  sender[15] = 1;
  sender[17] = 80;
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  recorder_->OnDatagram(sender, bytes, now);
  std::vector<std::uint8_t> seen;
  ASSERT_TRUE(Finish()
                  ->ForEach([&](const TakeMessage& message) {
                    EXPECT_EQ(message.kind, TakeKind::kDatagram);
                    seen.assign(message.payload.begin(), message.payload.end());
                    return true;
                  })
                  .ok());
  std::vector<std::uint8_t> expected(sender.begin(), sender.end());
  expected.insert(expected.end(), bytes.begin(), bytes.end());
  EXPECT_EQ(seen, expected);
}

}  // namespace
}  // namespace furrow::server
