// SPDX-License-Identifier: Apache-2.0
#include "server/saved/saved_state_codec.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/secure/crypto/primitives.h"
#include "server/core/metrics.h"
#include "server/session/access/token_gate.h"

namespace furrow::server {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr Time kSaved = std::chrono::seconds(1000);
constexpr std::size_t kHeadBytes = 48;  // magic, two versions, hash
constexpr std::size_t kVersionAt = 8;
constexpr std::size_t kWireAt = 12;
constexpr std::size_t kHashAt = 16;

protocol::secure::Key KeyOf(std::uint8_t first) {
  protocol::secure::Key key;
  for (std::uint8_t& byte : key.bytes()) byte = first++;
  return key;
}

// Every field differs from its default.
SavedState Example() {
  protocol::secure::Grant grant{.client_id = 7,
                                .roles = protocol::secure::Role::kWatch,
                                .packets_per_second = 90,
                                .subjects = "stage-*",
                                .audience = "daemon"};
  const SavedPeer peer{.id = 12,
                       .consent = kSaved - std::chrono::seconds(1),
                       .last_heard = kSaved - std::chrono::seconds(2),
                       .last_subscription = 3,
                       .follows_list = true,
                       .list_sequence = 4,
                       .access = SavedAccess{grant, 5, kSaved + std::chrono::hours(1)},
                       .subscriptions = {{2, {1, 2, 3}}, {3, {}}}};
  SavedState state;
  state.saved = kSaved;
  state.session = 99;
  state.udp_sockets = {1001, 1002};
  state.udp.push_back({.shard = 1,
                       .scope = 2,
                       .is_v4 = true,
                       .session = 77,
                       .secure_session = 0x10002,
                       .next_message = 8,
                       .takes_bundles = true,
                       .peer = peer});
  state.udp[0].address[17] = 9;
  state.connections.push_back({.socket = 1003, .input = {4, 5}, .output = {6}, .peer = peer});
  protocol::secure::SessionState session;
  session.index = 0x10002;
  session.sealer = {KeyOf(1), 11, 12, true, 13, 14'000};
  session.opener = {KeyOf(40), KeyOf(80), true, true, 15, 16'000, {{}, 17, true}, 18};
  session.opener.window.words[3] = 19;
  session.handshake_hash[31] = 20;
  session.address.port = 21;
  session.grant = grant;
  session.expires = 22;
  session.client_key[0] = 23;
  session.token_nonce[1] = 24;
  session.key_id = 25;
  session.token_host[2] = 26;
  session.last_heard_us = 27'000;
  state.secure.push_back({.shard = 1, .is_v4 = true, .scope = 28, .session = session});
  state.subjects.push_back({.owner = 12,
                            .host = "10.0.0.7",
                            .last_pose = kSaved - std::chrono::milliseconds(3),
                            .last_update = kSaved - std::chrono::milliseconds(2),
                            .last_no_face = kSaved - std::chrono::milliseconds(1),
                            .no_face = true,
                            .ended = true,
                            .lost = true,
                            .needs_all_drivers = true,
                            .offer = {7, 8},
                            .state = {9}});
  return state;
}

StatusCode CodeOf(const Bytes& bytes, Time now = kSaved) {
  return DecodeSavedState(bytes, now).status().code();
}

// Makes the hash right again, as whoever changes a state on purpose would.
void Sign(Bytes& bytes) {
  const auto hash =
      protocol::secure::Sha256(std::span<const std::uint8_t>(bytes).subspan(kHeadBytes));
  std::ranges::copy(hash, bytes.begin() + kHashAt);
}

// The second encoding covers every field, because each differs from its default.
TEST(SavedStateCodec, ReadsWhatItWrote) {
  const Bytes bytes = EncodeSavedState(Example());
  const auto state = DecodeSavedState(bytes, kSaved);
  ASSERT_TRUE(state.ok()) << state.status().ToString();
  EXPECT_EQ(EncodeSavedState(*state), bytes);
  EXPECT_NE(EncodeSavedState(SavedState()), bytes);
  EXPECT_EQ(state->udp[0].peer.subscriptions[0].request, (Bytes{1, 2, 3}));
  EXPECT_EQ(state->connections[0].input, (Bytes{4, 5}));
  EXPECT_EQ(state->secure[0].session.opener.window.words[3], 19u);
  EXPECT_EQ(state->secure[0].session.sealer.key.bytes()[31], 32);
  EXPECT_EQ(state->subjects[0].host, "10.0.0.7");
}

// The clock of the token and that of the daemon are both at their ends.
TEST(SavedStateCodec, ReadsTheLongestToken) {
  Metrics metrics;
  const TokenGate gate(
      {}, [] { return std::uint64_t{0}; }, &metrics);
  const Time years = std::chrono::hours(24 * 365 * 40);  // since the machine started
  SavedState state = Example();
  state.saved = years;
  const Time expires = gate.ExpiryOf(std::numeric_limits<std::uint64_t>::max(), years);
  state.connections[0].peer.access->expires = expires;
  const auto read = DecodeSavedState(EncodeSavedState(state), years);
  ASSERT_TRUE(read.ok()) << read.status().ToString();
  EXPECT_EQ(read->connections[0].peer.access->expires, expires);
}

TEST(SavedStateCodec, RefusesOtherVersions) {
  for (const std::size_t at : {kVersionAt, kWireAt}) {
    Bytes bytes = EncodeSavedState(Example());
    ++bytes[at];
    EXPECT_EQ(CodeOf(bytes), StatusCode::kUnsupported);
  }
  Bytes newer = EncodeSavedState(Example());
  newer[kVersionAt] = 2;
  EXPECT_THAT(DecodeSavedState(newer, kSaved).status().ToString(),
              HasSubstr("have version 2.1, and this daemon reads 1.1"));
}

TEST(SavedStateCodec, RefusesOldStatesAndThoseOfTheFuture) {
  const Bytes bytes = EncodeSavedState(Example());
  EXPECT_EQ(CodeOf(bytes, kSaved + kSavedStateAge), StatusCode::kOk);
  EXPECT_EQ(CodeOf(bytes, kSaved + kSavedStateAge + Time(1)), StatusCode::kUnavailable);
  EXPECT_EQ(CodeOf(bytes, kSaved - Time(1)), StatusCode::kUnavailable);
}

TEST(SavedStateCodec, RefusesEveryTruncationAndEveryFlippedBit) {
  const Bytes bytes = EncodeSavedState(Example());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(CodeOf(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))),
              StatusCode::kOk);
  }
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    Bytes damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_NE(CodeOf(damaged), StatusCode::kOk) << bit;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(CodeOf(longer), StatusCode::kParse);
}

// With a right hash, the content is checked field by field.
TEST(SavedStateCodec, RefusesEverySignedTruncation) {
  const Bytes bytes = EncodeSavedState(Example());
  for (std::size_t size = kHeadBytes; size < bytes.size(); ++size) {
    Bytes shorter(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    Sign(shorter);
    EXPECT_EQ(CodeOf(shorter), StatusCode::kParse) << size;
  }
  Bytes longer = bytes;
  longer.push_back(0);
  Sign(longer);
  EXPECT_EQ(CodeOf(longer), StatusCode::kParse);
}

// A list may state any length; memory grows with what is there.
TEST(SavedStateCodec, ReadsNoListBeyondItsEnd) {
  Bytes bytes = EncodeSavedState(SavedState{.saved = kSaved, .session = 1});
  constexpr std::size_t kFirstList = kHeadBytes + 16;
  for (std::size_t i = 0; i < 4; ++i) bytes[kFirstList + i] = 0xFF;
  Sign(bytes);
  EXPECT_EQ(CodeOf(bytes), StatusCode::kParse);
}

TEST(SavedStateCodec, RefusesValuesThatNoDaemonWrites) {
  const auto refused = [](const auto& change) {
    SavedState state = Example();
    change(state);
    return CodeOf(EncodeSavedState(state)) == StatusCode::kParse;
  };
  EXPECT_TRUE(refused([](SavedState& state) { state.session = 0; }));
  EXPECT_TRUE(refused([](SavedState& state) { state.udp[0].peer.consent = Time(-1); }));
  EXPECT_TRUE(refused([](SavedState& state) { state.subjects[0].last_pose = Time::max(); }));
  const auto refuses_grant = [&](const auto& change) {
    EXPECT_TRUE(refused([&](SavedState& state) { change(state.secure[0].session.grant); }));
    EXPECT_TRUE(refused([&](SavedState& state) { change(state.udp[0].peer.access->grant); }));
    EXPECT_TRUE(
        refused([&](SavedState& state) { change(state.connections[0].peer.access->grant); }));
  };
  using protocol::secure::Grant;
  refuses_grant([](Grant& grant) { grant.roles = protocol::secure::Roles(std::uint16_t{16}); });
  refuses_grant([](Grant& grant) { grant.roles = protocol::secure::Roles(); });
  refuses_grant([](Grant& grant) { grant.subjects.clear(); });
  refuses_grant([](Grant& grant) { grant.subjects = std::string(96, '*'); });
  refuses_grant([](Grant& grant) { grant.audience = std::string(48, 'a'); });
}

}  // namespace
}  // namespace furrow::server
