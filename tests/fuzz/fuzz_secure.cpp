// SPDX-License-Identifier: Apache-2.0
// A client and a server of secure datagrams, between which the input decides: it delivers, drops,
// repeats and changes packets, injects its own, moves the client and lets time pass. Nothing that
// the client did not send may come out at the server or the other way round, nothing comes out
// twice, and no answer is larger than its question.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <vector>

#include "protocol/messages/bytes.h"
#include "protocol/secure/session/secure_client.h"
#include "protocol/secure/session/secure_server.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace s = furrow::protocol::secure;
using Bytes = std::vector<std::uint8_t>;

namespace {

void Require(bool holds) {
  if (!holds) std::abort();
}

class Room {
 public:
  Room()
      : ring_(s::test::MakeRing(random_)),
        token_(s::test::MakeTestToken(ring_, random_)),
        server_({}, random_),
        client_(token_, Bytes{1, 2, 3}, random_) {
    server_.SetKeys(ring_);
  }

  void Run(s::ByteView input) {
    while (input.size() >= 2) {
      const std::uint8_t action = input[0] % 12;
      const std::uint8_t value = input[1];
      input = input.subspan(2);
      switch (action) {
        case 0: Poll(); break;
        case 1: SendFromClient(value); break;
        case 2: SendFromServer(value); break;
        case 3: Deliver(value, /*keep=*/false, false); break;
        case 4: Deliver(value, /*keep=*/true, false); break;
        case 5: Deliver(value, /*keep=*/true, true); break;
        case 6: Pass(std::int64_t{value} * 10'000); break;
        case 7: Pass(std::int64_t{value} * 10'000'000); break;
        case 8: address_.port = value % 4; break;
        case 9: {
          const std::size_t size = std::min<std::size_t>(value * 5, input.size());
          ToServer(Bytes(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(size)));
          ToClient(Bytes(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(size)));
          input = input.subspan(size);
          break;
        }
        case 10: client_.Renew(s::test::MakeTestToken(ring_, random_)); break;
        case 11: server_.Expire(now_); break;
      }
    }
  }

 private:
  struct Packet {
    Bytes bytes;
    bool to_server = false;
  };

  void Put(Bytes bytes, bool to_server) {
    if (network_.size() >= 64) network_.erase(network_.begin());
    network_.push_back({std::move(bytes), to_server});
  }
  void Pass(std::int64_t us) { now_ = s::test::Later(now_, us); }
  // Numbers every inner datagram, so that the receiver can tell them apart.
  Bytes Numbered(std::uint8_t size) {
    Bytes packet(s::kPacketOverheadBytes + 8 + size);
    furrow::protocol::StoreLittle(++number_, &packet[s::kPacketHeaderBytes]);
    return packet;
  }
  void Poll() {
    Bytes packet(s::kMaxPacketBytes);
    packet.resize(client_.Poll(now_, packet));
    if (!packet.empty()) Put(std::move(packet), true);
  }
  void SendFromClient(std::uint8_t size) {
    Bytes packet = Numbered(size);
    if (client_.Seal(packet, now_) != s::SealStatus::kOk) return;
    at_server_.insert(number_);
    Put(std::move(packet), true);
  }
  void SendFromServer(std::uint8_t size) {
    Bytes packet = Numbered(size);
    s::PeerAddress to;
    if (server_.Seal(session_, packet, now_, to) != s::SealStatus::kOk) return;
    at_client_.insert(number_);
    Put(std::move(packet), false);
  }
  void Deliver(std::uint8_t which, bool keep, bool change) {
    if (network_.empty()) return;
    const std::size_t at = which % network_.size();
    Packet packet = network_[at];
    if (!keep) network_.erase(network_.begin() + static_cast<std::ptrdiff_t>(at));
    if (change)
      packet.bytes[which * 7 % packet.bytes.size()] ^= static_cast<std::uint8_t>(which | 1);
    if (packet.to_server) {
      ToServer(std::move(packet.bytes));
    } else {
      ToClient(std::move(packet.bytes));
    }
  }
  void ToServer(Bytes datagram) {
    const std::size_t size = datagram.size();
    const s::ServerEvent event = server_.OnDatagram(datagram, address_, now_);
    Require(event.reply_size <= size);
    if (event.opened) {
      Require((event.hello == Bytes{1, 2, 3}));
      session_ = event.session;
    }
    if (event.reply_size > 0) Put({event.reply().begin(), event.reply().end()}, false);
    Expect(event.inner, at_server_);
    Require(server_.num_sessions() <= 32);
  }
  void ToClient(Bytes datagram) { Expect(client_.OnDatagram(datagram, now_).inner, at_client_); }
  // The inner datagram is one that the other side sent and that did not arrive before.
  static void Expect(s::ByteView inner, std::set<std::uint64_t>& expected) {
    if (inner.empty()) return;
    Require(inner.size() >= 8);
    Require(expected.erase(furrow::protocol::LoadLittle<std::uint64_t>(inner.data())) == 1);
  }

  s::test::RepeatableRandom random_;
  s::KeyRing ring_;
  s::ClientToken token_;
  s::SecureServer server_;
  s::SecureClient client_;
  s::Now now_ = s::test::kNow;
  s::PeerAddress address_ = s::test::kHome;
  std::vector<Packet> network_;
  std::uint32_t session_ = 0;
  std::uint64_t number_ = 0;
  std::set<std::uint64_t> at_server_, at_client_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Room room;
  room.Run({data, std::min<std::size_t>(size, 4'096)});
  // Any bytes as a datagram of a size that the room cannot write.
  s::test::RepeatableRandom random;
  s::SecureServer server({}, random);
  Bytes copy(data, data + size);
  const s::ServerEvent event = server.OnDatagram(copy, s::test::kHome, s::test::kNow);
  Require(event.session == 0 && event.reply_size <= size);
  return 0;
}
