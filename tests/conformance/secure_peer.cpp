// SPDX-License-Identifier: Apache-2.0
// The C++ side of secure_meeting.py, over standard input and output. Usage:
//
//   secure_peer server KEY_ID_HEX TOKEN_KEY_HEX    lines in: PORT DATAGRAM_HEX
//   secure_peer client TOKEN                       lines in: DATAGRAM_HEX, or "wait MILLISECONDS"
//
// After each line it prints what happened, one thing a line, and then a line with a full stop:
// "send HEX" (a datagram for the other side), "inner HEX", "opened HEX" (with the hello),
// "connected", "renewed", "refused NUMBER". The server sends every inner datagram back in a packet
// of its own.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "protocol/secure/crypto/base64url.h"
#include "protocol/secure/session/secure_client.h"
#include "protocol/secure/session/secure_server.h"
#include "protocol/secure/token/token_text.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;

Now g_now = test::kNow;

void Say(const char* what, ByteView bytes) {
  std::cout << what << ' ' << test::ToHex(bytes) << '\n';
}

int Serve(std::uint32_t key_id, const std::string& key_hex) {
  SecureServer server({});
  const auto ring =
      KeyRing::Parse("furrow-keys 1\nkey " + KeyIdText(key_id) +
                         " created 2026-01-01T00:00:00Z expires 2036-01-01T00:00:00Z " +
                         ToBase64Url(test::FromHex(key_hex)) + "\n",
                     "arguments");
  if (!ring.ok()) {
    std::cerr << ring.status().ToString() << "\n";
    return 1;
  }
  server.SetKeys(*ring);
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::uint16_t port = 0;
    std::string hex;
    words >> port >> hex;
    Bytes datagram = test::FromHex(hex);
    g_now = test::Later(g_now, 200'000);
    const ServerEvent event = server.OnDatagram(datagram, FromIpv4({127, 0, 0, 1}, port), g_now);
    if (event.reply_size > 0) Say("send", event.reply());
    if (event.opened) Say("opened", event.hello);
    if (event.renewed) std::cout << "renewed\n";
    if (event.refusal != Refusal::kNone) std::cout << "refused " << int(event.refusal) << '\n';
    if (!event.inner.empty()) {
      Say("inner", event.inner);
      Bytes packet(kPacketOverheadBytes + event.inner.size());
      std::copy(event.inner.begin(), event.inner.end(), packet.begin() + kPacketHeaderBytes);
      PeerAddress to;
      if (server.Seal(event.session, packet, g_now, to) == SealStatus::kOk) {
        std::cout << "to " << to.port << '\n';
        Say("send", packet);
      }
    }
    std::cout << "." << std::endl;
  }
  return 0;
}

int Connect(const std::string& text) {
  const auto token = ParseToken(text);
  if (!token.ok()) {
    std::cerr << token.status().ToString() << "\n";
    return 1;
  }
  const Bytes hello = {'h', 'e', 'l', 'l', 'o'};
  SecureClient client(*token, hello);
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line.starts_with("wait ")) {
      g_now = test::Later(g_now, std::stoll(line.substr(5)) * 1'000);
    } else {
      Bytes datagram = test::FromHex(line);
      const ClientEvent event = client.OnDatagram(datagram, g_now);
      if (event.connected) {
        std::cout << "connected\n";
        Bytes packet(kPacketOverheadBytes + 4);
        std::copy_n("pose", 4, packet.begin() + kPacketHeaderBytes);
        if (client.Seal(packet, g_now) == SealStatus::kOk) Say("send", packet);
      }
      if (!event.inner.empty()) Say("inner", event.inner);
    }
    Bytes packet(kMaxPacketBytes);
    while (const std::size_t size = client.Poll(g_now, packet)) {
      Say("send", ByteView(packet).first(size));
    }
    std::cout << "." << std::endl;
  }
  return 0;
}

}  // namespace

int Run(const std::vector<std::string>& arguments) {
  std::uint32_t key_id = 0;
  if (arguments.size() == 3 && arguments[0] == "server" && ParseKeyId(arguments[1], key_id)) {
    return Serve(key_id, arguments[2]);
  }
  if (arguments.size() == 2 && arguments[0] == "client") return Connect(arguments[1]);
  std::cerr << "usage: secure_peer server KEY_ID_HEX TOKEN_KEY_HEX | client TOKEN\n";
  return 2;
}

}  // namespace furrow::protocol::secure

int main(int argc, char** argv) { return furrow::protocol::secure::Run({argv + 1, argv + argc}); }
