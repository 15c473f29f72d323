// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "server/session/hub.h"
#include "tests/shape_rig.h"

namespace furrow::server {

// A peer in memory: keeps the messages that the hub sends.
class FakePeer : public Link {
 public:
  void SendReply(std::span<const std::uint8_t> message) override { Receive(message); }
  int SendFrame(std::uint64_t, std::span<const std::uint8_t> message, std::size_t, int) override {
    if (!has_room) return kNoRoom;
    Receive(message);
    return 0;
  }
  void DropFrames(std::uint64_t key) override { dropped_keys.push_back(key); }
  void Finish() override { finished = true; }
  bool IsStuck(Time) const override { return stuck; }

  template <class Message>
  struct Got {
    protocol::Header header;
    Message message;
  };
  // Takes the next message, which must be a `Message`. nullopt: there is none.
  template <class Message>
  std::optional<Got<Message>> Take() {
    if (inbox.empty()) return std::nullopt;
    protocol::MessageView view;
    EXPECT_EQ(protocol::OpenMessage(inbox.front(), view, protocol::kMaxReplyBytes),
              protocol::DecodeStatus::kOk);
    Got<Message> got;
    got.header = view.header;
    const auto status = protocol::Decode(view, got.message);
    if (status != protocol::DecodeStatus::kOk) {
      ADD_FAILURE() << "got a " << protocol::MessageKindName(view.kind);
      return std::nullopt;
    }
    inbox.pop_front();
    return got;
  }

  std::deque<std::vector<std::uint8_t>> inbox;
  std::vector<std::uint64_t> dropped_keys;
  std::uint64_t bytes_received = 0;
  bool stuck = false;
  bool has_room = true;   // for frames
  bool finished = false;  // the hub has ended the connection
  PeerId id = 0;
  std::uint64_t session = 77;

 private:
  void Receive(std::span<const std::uint8_t> message) {
    bytes_received += message.size();
    inbox.emplace_back(message.begin(), message.end());
  }
};

class FakePictures : public PictureSource {
 public:
  void Submit(RenderJob job) override { jobs.push_back(std::move(job)); }
  Result<render::Camera> Preset(std::string_view name) const override {
    if (name == "face" || name == "body") return render::Camera();
    return Status(StatusCode::kNotFound, "no camera '" + std::string(name) + "'");
  }
  bool WithdrawStill(std::uint64_t subscription) override {
    withdrawn.push_back(subscription);
    return withdraws;
  }
  void Withdraw(std::uint64_t subscription) override { ended.push_back(subscription); }
  bool OpenVideo(std::uint64_t subscription, const std::string& host,
                 const render::VideoFormat& format) override {
    opened.push_back({subscription, host, format});
    return has_video;
  }
  void CloseVideo(std::uint64_t subscription) override { closed.push_back(subscription); }
  bool is_stuck() const override { return stuck; }
  struct Opened {
    std::uint64_t subscription;
    std::string host;
    render::VideoFormat format;
  };
  std::vector<Opened> opened;         // by OpenVideo()
  std::vector<std::uint64_t> closed;  // by CloseVideo()
  bool has_video = true;              // the result of OpenVideo()
  std::vector<RenderJob> jobs;
  std::vector<std::uint64_t> withdrawn;
  std::vector<std::uint64_t> ended;  // by Withdraw()
  bool stuck = false;
  bool withdraws = false;  // the result of WithdrawStill()
};

// A hub with a rig of two blend-shape drivers. The filter is off unless a test turns it on.
class HubTest : public testing::Test {
 protected:
  void SetUp() override { Make({}); }

  static wrinkle::Rig MakeRig(bool filter) {
    wrinkle::Rig rig = test::ShapeRig("test", {"brow", "nose"});
    rig.filter.enabled = filter;
    for (wrinkle::Region& region : rig.regions) region.modulation = wrinkle::Modulation::kLinear;
    return rig;
  }

  void Make(Limits limits, bool filter = false) { MakeWith(MakeRig(filter), limits); }
  void MakeWith(wrinkle::Rig rig, Limits limits = {}, int shards = 1) {
    Hub::Parts parts;
    parts.limits = limits;
    parts.shards = shards;
    parts.jitter = jitter;
    parts.session = 4242;
    parts.rig = std::make_shared<const wrinkle::Rig>(std::move(rig));
    parts.pictures = &pictures;
    parts.metrics = &metrics;
    parts.gate = gate;
    parts.cluster = cluster;
    parts.drain = drain;
    parts.is_own_address = [](const std::string& address) { return address == "127.0.0.1"; };
    parts.random = [this] { return ++last_token; };
    parts.clock = [this] { return now + ++clock_reads * FromSeconds(0.001); };
    hub = std::make_unique<Hub>(std::move(parts));
  }

  void Connect(FakePeer* peer, Transport transport = Transport::kTcp) {
    peer->id = hub->AddPeer(transport, "fake", peer, now);
  }

  template <class Message>
  std::size_t Send(FakePeer& peer, const Message& message, std::uint16_t stream = 0,
                   std::uint32_t sequence = 0, std::int64_t capture_us = 0) {
    std::vector<std::uint8_t> bytes;
    encoder.Encode({peer.session, stream, sequence, capture_us}, message, bytes);
    hub->OnMessage(peer.id, bytes, now);
    return bytes.size();
  }

  static protocol::SkeletonOffer Offer(std::string subject) {
    protocol::SkeletonOffer offer;
    offer.subject = std::move(subject);
    offer.blend_shape_names = {"brow", "nose"};
    offer.skeleton_hash = protocol::SkeletonHash(offer);
    return offer;
  }
  static protocol::PoseFrame Pose(float brow, float nose = 0.0f) {
    protocol::PoseFrame pose;
    pose.skeleton_hash = Offer("any").skeleton_hash;
    pose.num_blend_shapes = 2;
    pose.blend_shape_indices = {0, 1};
    pose.blend_shapes = {brow, nose};
    return pose;
  }
  void Publish(FakePeer& peer, const std::string& subject, std::uint16_t stream = 1) {
    Send(peer, Offer(subject), stream);
    const auto reply = peer.Take<protocol::SkeletonReply>();
    ASSERT_TRUE(reply.has_value());
    ASSERT_EQ(reply->message.status, protocol::SkeletonStatus::kAccepted) << reply->message.message;
  }
  // The id of the new subscription; 0 if the reply is something else.
  std::uint16_t Watch(FakePeer& peer, const protocol::SubscribeWeights& request,
                      std::uint32_t sequence = 1) {
    Send(peer, request, 0, sequence);
    const auto reply = peer.Take<protocol::SubscribeReply>();
    return reply ? reply->header.stream : 0;
  }
  void Advance(double seconds) { now += FromSeconds(seconds); }
  std::uint64_t Count(Counter counter) const { return metrics.Get(counter); }

  Metrics metrics;
  const TokenGate* gate = nullptr;  // this and the next: of hubs that are made from now on
  Coordinator* cluster = nullptr;
  std::function<protocol::DrainState(bool begin)> drain;
  std::vector<JitterRule> jitter;
  FakePictures pictures;
  std::unique_ptr<Hub> hub;
  protocol::Encoder encoder;
  Time now = FromSeconds(1000);
  std::uint64_t last_token = 900;
  int clock_reads = 0;  // each shows a millisecond more
};

// A hub with two peers.
class HubPeersTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender);
    Connect(&viewer);
  }
  static void ExpectError(FakePeer& peer, protocol::ErrorCode code) {
    const auto error = peer.Take<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->message.code, code) << error->message.message;
    EXPECT_FALSE(error->message.message.empty());
  }

  FakePeer sender;
  FakePeer viewer;
};

}  // namespace furrow::server
