// SPDX-License-Identifier: Apache-2.0
#include "server/saved/saved_state_codec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "protocol/framing/envelope.h"
#include "protocol/secure/crypto/primitives.h"
#include "server/saved/archive.h"

namespace furrow::server {

namespace secure = protocol::secure;

namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'F', 'R', 'R', 'W', 'S', 'A', 'V', 'E'};

// In front of the content.
struct Head {
  std::array<std::uint8_t, 8> magic = kMagic;
  std::uint32_t version = kSavedStateVersion;
  std::uint32_t wire = protocol::kVersion;
  secure::Hash hash{};  // of the content
};
constexpr std::size_t kHeadBytes = 48;

template <class Archive>
void Exchange(Archive& archive, Head& head) {
  archive(head.magic);
  archive(head.version);
  archive(head.wire);
  archive(head.hash);
}

}  // namespace

// The archives find these by the namespace of their arguments.

template <class Archive>
void Exchange(Archive& archive, SavedSubscription& subscription) {
  archive(subscription.id);
  archive(subscription.request);
}

template <class Archive>
void ExchangeGrant(Archive& archive, secure::Grant& grant) {
  std::uint16_t roles = grant.roles.bits();
  archive(grant.client_id);
  archive(roles);
  archive(grant.packets_per_second);
  archive(grant.subjects);
  archive(grant.audience);
  grant.roles = secure::Roles(roles);
}

template <class Archive>
void Exchange(Archive& archive, SavedAccess& access) {
  ExchangeGrant(archive, access.grant);
  archive(access.key_id);
  archive(access.expires);
}

template <class Archive>
void Exchange(Archive& archive, SavedPeer& peer) {
  archive(peer.id);
  archive(peer.consent);
  archive(peer.last_heard);
  archive(peer.last_subscription);
  archive(peer.follows_list);
  archive(peer.list_sequence);
  archive(peer.access);
  archive(peer.subscriptions);
}

template <class Archive>
void Exchange(Archive& archive, SavedUdpPeer& peer) {
  archive(peer.shard);
  archive(peer.address);
  archive(peer.scope);
  archive(peer.is_v4);
  archive(peer.session);
  archive(peer.secure_session);
  archive(peer.next_message);
  archive(peer.takes_bundles);
  Exchange(archive, peer.peer);
}

template <class Archive>
void Exchange(Archive& archive, SavedConnection& connection) {
  archive(connection.socket);
  archive(connection.input);
  archive(connection.output);
  Exchange(archive, connection.peer);
}

// Microseconds of the steady clock, with the bounds of a Time.
template <class Archive>
void ExchangeMicroseconds(Archive& archive, std::int64_t& microseconds) {
  Time time = std::chrono::microseconds(microseconds);
  archive(time);
  microseconds = ToMicroseconds(time);
}

template <class Archive>
void ExchangeSession(Archive& archive, secure::SessionState& session) {
  archive(session.index);
  archive(session.sealer.key);
  archive(session.sealer.index);
  archive(session.sealer.counter);
  archive(session.sealer.phase);
  archive(session.sealer.phase_packets);
  ExchangeMicroseconds(archive, session.sealer.phase_began_us);
  archive(session.opener.previous);
  archive(session.opener.current);
  archive(session.opener.phase);
  archive(session.opener.has_previous);
  archive(session.opener.phase_first_counter);
  ExchangeMicroseconds(archive, session.opener.turned_us);
  archive(session.opener.window.words);
  archive(session.opener.window.newest);
  archive(session.opener.window.any);
  archive(session.opener.failures);
  archive(session.handshake_hash);
  archive(session.address.host);
  archive(session.address.port);
  ExchangeGrant(archive, session.grant);
  archive(session.expires);
  archive(session.client_key);
  archive(session.token_nonce);
  archive(session.key_id);
  archive(session.token_host);
  ExchangeMicroseconds(archive, session.last_heard_us);
}

template <class Archive>
void Exchange(Archive& archive, SavedSecureSession& session) {
  archive(session.shard);
  archive(session.is_v4);
  archive(session.scope);
  ExchangeSession(archive, session.session);
}

template <class Archive>
void Exchange(Archive& archive, SavedSubject& subject) {
  archive(subject.owner);
  archive(subject.host);
  archive(subject.last_pose);
  archive(subject.last_update);
  archive(subject.last_no_face);
  archive(subject.no_face);
  archive(subject.ended);
  archive(subject.lost);
  archive(subject.needs_all_drivers);
  archive(subject.offer);
  archive(subject.state);
}

template <class Archive>
void Exchange(Archive& archive, SavedState& state) {
  archive(state.saved);
  archive(state.session);
  archive(state.udp_sockets);
  archive(state.udp);
  archive(state.connections);
  archive(state.secure);
  archive(state.subjects);
}

namespace {

bool IsGood(const secure::Grant& grant) {
  return grant.roles.valid() && !grant.subjects.empty() &&
         grant.subjects.size() <= secure::kMaxSubjectsBytes &&
         grant.audience.size() <= secure::kMaxAudienceBytes;
}

// What the types alone do not say. The rest is checked where it is used.
bool IsGood(const SavedState& state) {
  const auto has_good_access = [](const SavedPeer& peer) {
    return !peer.access || IsGood(peer.access->grant);
  };
  return state.session != 0 &&
         std::ranges::all_of(state.udp, has_good_access, &SavedUdpPeer::peer) &&
         std::ranges::all_of(state.connections, has_good_access, &SavedConnection::peer) &&
         std::ranges::all_of(state.secure, [](const SavedSecureSession& each) {
           return IsGood(each.session.grant);
         });
}

Status Damaged() { return {StatusCode::kParse, "the sessions of the former daemon are damaged"}; }

}  // namespace

std::vector<std::uint8_t> EncodeSavedState(const SavedState& state) {
  std::vector<std::uint8_t> content;
  ArchiveWriter writer(&content);
  // Writing changes nothing; one description serves both directions.
  Exchange(writer, const_cast<SavedState&>(state));
  Head head;
  head.hash = secure::Sha256(content);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kHeadBytes + content.size());
  ArchiveWriter front(&bytes);
  Exchange(front, head);
  bytes.insert(bytes.end(), content.begin(), content.end());
  secure::Wipe(content);
  return bytes;
}

Result<SavedState> DecodeSavedState(std::span<const std::uint8_t> bytes, Time now) {
  if (bytes.size() < kHeadBytes) return Damaged();
  Head head;
  ArchiveReader front(bytes.first(kHeadBytes));
  Exchange(front, head);
  if (head.magic != kMagic) return Damaged();
  if (head.version != kSavedStateVersion || head.wire != protocol::kVersion) {
    return Status(StatusCode::kUnsupported,
                  "the sessions of the former daemon have version " + std::to_string(head.version) +
                      "." + std::to_string(head.wire) + ", and this daemon reads " +
                      std::to_string(kSavedStateVersion) + "." +
                      std::to_string(int{protocol::kVersion}));
  }
  const auto content = bytes.subspan(kHeadBytes);
  if (secure::Sha256(content) != head.hash) return Damaged();
  SavedState state;
  ArchiveReader reader(content);
  Exchange(reader, state);
  if (!reader.complete() || !IsGood(state)) return Damaged();
  if (state.saved > now || now - state.saved > kSavedStateAge) {
    return Status(StatusCode::kUnavailable, "the sessions of the former daemon are too old");
  }
  return state;
}

}  // namespace furrow::server
