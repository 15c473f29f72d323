// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "protocol/secure/session/secure_client.h"
#include "protocol/secure/session/secure_server.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure::test {

inline Bytes Text(std::string_view text) { return {text.begin(), text.end()}; }

// A packet with room for header and tag around `inner`.
inline Bytes Packet(const Bytes& inner) {
  Bytes packet(kPacketOverheadBytes + inner.size());
  std::copy(inner.begin(), inner.end(), packet.begin() + kPacketHeaderBytes);
  return packet;
}

// One client and one server without a network between them.
class Meeting {
 public:
  explicit Meeting(SecureServerSettings settings = {}, std::uint64_t seed = 1)
      : random(seed),
        ring(MakeRing(random)),
        token(MakeTestToken(ring, random)),
        server(settings, random),
        client(token, Text("hello"), random) {
    server.SetKeys(ring);
  }

  // What the client has to send, or an empty vector.
  Bytes Poll() { return Poll(client); }
  Bytes Poll(SecureClient& from) {
    Bytes packet(kMaxPacketBytes);
    packet.resize(from.Poll(now, packet));
    return packet;
  }
  ServerEvent ToServer(Bytes datagram, const PeerAddress& from = kHome) {
    // Kept alive for event.inner.
    to_server = std::move(datagram);
    return server.OnDatagram(to_server, from, now);
  }
  ClientEvent ToClient(ByteView datagram) { return ToClient(client, datagram); }
  ClientEvent ToClient(SecureClient& to, ByteView datagram) {
    to_client.assign(datagram.begin(), datagram.end());
    return to.OnDatagram(to_client, now);
  }
  // A data packet of the client.
  Bytes FromClient(std::string_view text) {
    Bytes packet = Packet(Text(text));
    EXPECT_EQ(client.Seal(packet, now), SealStatus::kOk);
    return packet;
  }
  // The handshake. Returns the index of the session at the server, 0 if none began.
  std::uint32_t Connect(const PeerAddress& from = kHome) {
    std::uint32_t session = 0;
    for (int i = 0; i < 16 && session == 0; ++i) {
      const Bytes packet = Poll();
      if (packet.empty()) {
        now = Later(now, 200'000);  // until the client repeats itself
        continue;
      }
      const ServerEvent event = ToServer(packet, from);
      if (event.opened) session = event.session;
      if (event.reply_size > 0) (void)ToClient(event.reply());
    }
    return session;
  }

  RepeatableRandom random;
  KeyRing ring;
  ClientToken token;
  SecureServer server;
  SecureClient client;
  Now now = kNow;
  Bytes to_server;
  Bytes to_client;
};

}  // namespace furrow::protocol::secure::test
