// SPDX-License-Identifier: Apache-2.0
// The state that a daemon leaves to the next one, as somebody may have written it who can also
// compute its hash: the input is the content behind it. What can be read is used by a hub and by
// a server of secure sessions.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "protocol/messages/bytes.h"
#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/session/secure_server.h"
#include "server/saved/saved_state_codec.h"
#include "server/session/hub.h"
#include "tests/shape_rig.h"

namespace furrow::server {
namespace {

constexpr std::size_t kHeadBytes = 48;
constexpr std::size_t kHashAt = 16;

class Deaf : public Link {
 public:
  void SendReply(std::span<const std::uint8_t>) override {}
  int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
    return 0;
  }
  void DropFrames(std::uint64_t) override {}
};

// The content with a head that fits.
std::vector<std::uint8_t> Signed(std::span<const std::uint8_t> content) {
  std::vector<std::uint8_t> bytes = EncodeSavedState({});
  bytes.resize(kHeadBytes);
  std::ranges::copy(protocol::secure::Sha256(content), bytes.begin() + kHashAt);
  bytes.insert(bytes.end(), content.begin(), content.end());
  return bytes;
}

void Use(const SavedState& state, Time now) {
  Metrics metrics;
  std::uint64_t number = 0;
  Hub hub({.rig = std::make_shared<const wrinkle::Rig>(test::ShapeRig("rig", {"brow"})),
           .metrics = &metrics,
           .random = [&number] { return ++number; }});
  std::vector<std::unique_ptr<Deaf>> links;
  Hub::ResumedPeers peers;
  const auto add = [&](const SavedPeer& saved, Transport transport) {
    links.push_back(std::make_unique<Deaf>());
    peers[saved.id] = {hub.AddPeer(transport, "peer", links.back().get(), now), &saved};
  };
  for (const SavedUdpPeer& each : state.udp) add(each.peer, Transport::kUdp);
  for (const SavedConnection& each : state.connections) add(each.peer, Transport::kTcp);
  hub.Resume(state.subjects, peers, now - state.saved, now);
  hub.Tick(now);
  hub.Tick(now + std::chrono::seconds(1));
  (void)hub.SaveSubjects(now);
  for (const auto& [former, peer] : peers) {
    (void)hub.SavePeer(peer.id);
    hub.RemovePeer(peer.id);
  }
  protocol::secure::SecureServer server({});
  for (const SavedSecureSession& each : state.secure) {
    (void)server.Resume(each.session, {.us = ToMicroseconds(now), .unix_s = 1});
  }
  server.Expire({.us = ToMicroseconds(now), .unix_s = 1});
  (void)server.TakeAll();
}

}  // namespace
}  // namespace furrow::server

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using furrow::server::DecodeSavedState;
  using furrow::server::Time;
  const std::span<const std::uint8_t> input(data, size);
  (void)DecodeSavedState(input, Time{0});
  const auto bytes = furrow::server::Signed(input);
  // The state says when it was saved; a daemon reads it a moment later.
  Time saved{0};
  if (size >= 8) saved = Time(furrow::protocol::LoadLittle<std::int64_t>(data));
  if (saved < Time{0} || saved > Time(std::int64_t{1} << 61)) return 0;
  const Time now = saved + std::chrono::milliseconds(100);
  const auto state = DecodeSavedState(bytes, now);
  if (!state.ok()) return 0;
  // A state that can be read can be written and read again.
  if (!DecodeSavedState(furrow::server::EncodeSavedState(*state), now).ok()) std::abort();
  furrow::server::Use(*state, now);
  return 0;
}
