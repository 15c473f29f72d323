// SPDX-License-Identifier: Apache-2.0
// A hub with several peers, tokens, take-overs and time. The input is a program: each step is a
// byte that says what happens, and bytes that say how. Whatever the peers do, nobody gets or does
// more than its token allows: the links check what they receive.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "server/session/hub.h"
#include "tests/fuzz/fuzz_input.h"

namespace furrow::server {
namespace {

using fuzz::Input;
using protocol::secure::Grant;
using protocol::secure::Roles;

constexpr std::array<const char*, 4> kNames = {"ann", "bob", "stage-1", ""};

void Require(bool holds) {
  if (!holds) std::abort();
}

// Aborts if its peer receives what it may not see.
class Watchman : public Link {
 public:
  void SendReply(std::span<const std::uint8_t> message) override { Check(message); }
  int SendFrame(std::uint64_t, std::span<const std::uint8_t> message, std::size_t, int) override {
    Check(message);
    return 0;
  }
  void DropFrames(std::uint64_t) override {}
  void Finish() override { finished = true; }

  Access access;
  PeerId id = 0;
  std::uint64_t session = 1;
  bool finished = false;
  int errors = 0;

 private:
  void Check(std::span<const std::uint8_t> message) {
    protocol::MessageView view;
    Require(protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) ==
            protocol::DecodeStatus::kOk);
    protocol::SubscribeReply reply;
    protocol::Subjects subjects;
    protocol::SkeletonReply offered;
    if (!access.admitted()) {
      // One error, and the goodbye by which a WebSocket closes.
      if (view.kind == protocol::MessageKind::kError) Require(++errors == 1);
      Require(view.kind == protocol::MessageKind::kError ||
              view.kind == protocol::MessageKind::kGoodbye);
    } else if (protocol::Decode(view, reply) == protocol::DecodeStatus::kOk) {
      Require(reply.subject.empty() || access.MayWatch(reply.subject));
    } else if (protocol::Decode(view, subjects) == protocol::DecodeStatus::kOk) {
      for (const std::string& name : subjects.names) Require(access.MayWatch(name));
    } else if (protocol::Decode(view, offered) == protocol::DecodeStatus::kOk) {
      Require(offered.status != protocol::SkeletonStatus::kAccepted || access.Has(Role::kPublish));
    } else if (view.kind == protocol::MessageKind::kWeights) {
      Require(access.Has(Role::kWatch));
    }
  }
};

class Play {
 public:
  Play()
      : gate_(
            {.security = Security::kRequired}, [] { return std::uint64_t{1}; }, &metrics_) {
    protocol::secure::KeyRing keys;
    key_id_ = *keys.AddNew(1, ~std::uint64_t{0}, protocol::secure::SystemRandom());
    gate_.SetKeys(std::move(keys));
    Hub::Parts parts;
    parts.rig = std::make_shared<const wrinkle::Rig>();
    parts.metrics = &metrics_;
    parts.random = [this] { return ++random_; };
    parts.gate = &gate_;
    hub_ = std::make_unique<Hub>(std::move(parts));
    for (std::size_t i = 0; i < peers_.size(); ++i) Connect(i);
  }

  void Run(Input input) {
    while (!input.empty()) {
      const std::uint8_t step = input.Byte();
      Step(step, peers_[step & 7], input);
      // A subject belongs to a peer that may publish it, or to nobody any more.
      const Hub::ExclusiveLock lock(*hub_, 0);
      for (const auto& subject : hub_->subjects().all()) {
        for (const Watchman& peer : peers_) {
          if (subject->owner.peer == peer.id && !subject->ended && !subject->orphaned) {
            Require(peer.access.MayPublish(subject->name));
          }
        }
      }
    }
  }

 private:
  [[nodiscard]] Access AccessOf(std::size_t i) const {
    Grant grant;
    grant.roles = Roles(static_cast<std::uint16_t>(1 + i % Roles::kAllBits));
    grant.subjects = i % 2 == 0 ? "ann,stage-*" : "bob";
    return Access::Of(grant, key_id_, now_ + FromSeconds(static_cast<double>(i) * 10.0));
  }
  void Connect(std::size_t i) {
    Watchman& peer = peers_[i];
    peer = {};
    peer.session = i + 1;
    constexpr std::array<Transport, 3> kTransports = {Transport::kUdp, Transport::kTcp,
                                                      Transport::kWeb};
    const Transport transport = kTransports[i % 3];
    // The last one has shown nothing, which only a stream can do.
    const bool stranger = i == 7;
    if (!stranger) peer.access = AccessOf(i);
    peer.id = hub_->AddPeer(transport, "fuzz", &peer, now_, 0, peer.access);
  }
  template <class Message>
  void Send(const Watchman& peer, const Message& message, std::uint8_t stream,
            std::uint32_t sequence) {
    encoder_.Encode({peer.session, stream, sequence, 0}, message, bytes_);
    hub_->OnMessage(peer.id, bytes_, now_);
  }
  void Step(std::uint8_t step, Watchman& peer, Input& input) {
    const std::uint8_t how = input.Byte();
    const std::string name = kNames[how & 3];
    const auto stream = static_cast<std::uint8_t>(how >> 4 & 3);
    switch (step >> 3 & 15) {
      case 0: {
        protocol::SkeletonOffer offer;
        offer.subject = name.empty() ? "stage-2" : name;
        offer.blend_shape_names = {"brow"};
        offer.skeleton_hash = protocol::SkeletonHash(offer);
        return Send(peer, offer, stream, 0);
      }
      case 1: {
        protocol::SkeletonOffer offer;
        offer.blend_shape_names = {"brow"};
        protocol::PoseFrame pose;
        pose.skeleton_hash = protocol::SkeletonHash(offer);
        pose.num_blend_shapes = 1;
        pose.blend_shape_indices = {0};
        pose.blend_shapes = {static_cast<float>(how) / 255.0f};
        return Send(peer, pose, stream, input.Byte());
      }
      case 2:
        return Send(peer, protocol::SubscribeWeights{.subject = name, .wait = (how & 4) != 0}, 0,
                    how);
      case 3:
        return Send(peer, protocol::SubscribePoses{.subject = name, .wait = (how & 4) != 0}, 0,
                    how);
      case 4: return Send(peer, protocol::Unsubscribe{}, stream, how);
      case 5: return Send(peer, protocol::Goodbye{}, stream, how);
      case 6: return Send(peer, protocol::ListSubjects{(how & 1) != 0}, 0, how);
      case 7: return Send(peer, protocol::Hello{"fuzz", 0, false, name}, 0, how);
      case 8: return Send(peer, protocol::Ping{how}, 0, how);
      case 9: {
        // A newer token inside of the session.
        if (!peer.access.admitted() || peer.finished) return;
        peer.access = AccessOf(how & 7);
        const Hub::ShardLock lock(*hub_, 0);
        return hub_->SetAccess(peer.id, peer.access);
      }
      case 10:
        hub_->RemovePeer(peer.id);
        return Connect(static_cast<std::size_t>(&peer - peers_.data()));
      case 11:
      case 12:
        now_ += FromSeconds(how / 20.0);
        // What ends at this tick may be told so afterwards.
        for (Watchman& each : peers_) each.errors = std::min(each.errors, 0);
        return hub_->Tick(now_);
      default: {
        const auto raw = input.Bytes(how);
        return hub_->OnMessage(peer.id, raw, now_);
      }
    }
  }

  Metrics metrics_;
  TokenGate gate_;
  std::uint32_t key_id_ = 0;
  std::uint64_t random_ = 0;
  std::unique_ptr<Hub> hub_;
  std::array<Watchman, 8> peers_;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> bytes_;
  Time now_ = FromSeconds(1);
};

}  // namespace
}  // namespace furrow::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  furrow::server::Play().Run(furrow::fuzz::Input({data, size}));
  return 0;
}
