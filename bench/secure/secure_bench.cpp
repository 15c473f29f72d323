// SPDX-License-Identifier: Apache-2.0
// Measures secure datagrams: sealing, opening and refusing packets of an inner size, beside a copy
// of the same bytes; and the steps of a handshake, beside one key agreement.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/codec/messages.h"
#include "protocol/secure/handshake/cookie.h"
#include "protocol/secure/packet/packet_opener.h"
#include "protocol/secure/packet/packet_sealer.h"
#include "protocol/secure/session/secure_client.h"
#include "protocol/secure/session/secure_server.h"
#include "tests/unit/protocol/secure/secure_testing.h"

namespace furrow::protocol::secure {
namespace {

using test::Bytes;
using test::kHome;
using test::kNow;

std::size_t PacketBytes(const benchmark::State& state) {
  return static_cast<std::size_t>(state.range(0)) + kPacketOverheadBytes;
}

void BM_Copy(benchmark::State& state) {
  const Bytes from(PacketBytes(state), 7);
  Bytes to(from.size());
  for (auto _ : state) {
    std::copy(from.begin(), from.end(), to.begin());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
}

void BM_Seal(benchmark::State& state) {
  test::RepeatableRandom random;
  PacketSealer sealer(random.MakeKey(), 1, 0);
  Bytes packet(PacketBytes(state));
  bool ok = true;
  const protocol::bench::Allocations allocations;
  for (auto _ : state) {
    ok = sealer.Seal(PacketKind::kData, packet, 0) == SealStatus::kOk && ok;
    benchmark::ClobberMemory();
  }
  allocations.Refuse(state);
  if (!ok) state.SkipWithError("not sealed");
}

// Each packet is new: opens in place after a copy, as from a socket's buffer.
void BM_SealAndOpen(benchmark::State& state) {
  test::RepeatableRandom random;
  const Key key = random.MakeKey();
  PacketSealer sealer(key, 1, 0);
  PacketOpener opener(key);
  Bytes packet(PacketBytes(state));
  OpenedPacket opened;
  bool ok = true;
  const protocol::bench::Allocations allocations;
  for (auto _ : state) {
    ok = sealer.Seal(PacketKind::kData, packet, 0) == SealStatus::kOk && ok;
    ok = opener.Open(packet, 0, opened) == OpenStatus::kOk && ok;
    benchmark::ClobberMemory();
  }
  allocations.Refuse(state);
  if (!ok) state.SkipWithError("refused");
}

// A server with a session. `forge` changes a packet that the client has sealed.
template <class Forge>
void Refuse(benchmark::State& state, OpenStatus expected, const Forge& forge) {
  test::RepeatableRandom random;
  const KeyRing ring = test::MakeRing(random);
  const ClientToken token = test::MakeTestToken(ring, random);
  SecureServer server({}, random);
  server.SetKeys(ring);
  SecureClient client(token, Bytes{1}, random);
  Bytes packet(kMaxPacketBytes);
  for (int i = 0; i < 3; ++i) {
    packet.resize(kMaxPacketBytes);
    packet.resize(client.Poll(kNow, packet));
    const ServerEvent event = server.OnDatagram(packet, kHome, kNow);
    Bytes reply(event.reply().begin(), event.reply().end());
    (void)client.OnDatagram(reply, kNow);
  }
  Bytes forged(PacketBytes(state));
  if (client.Seal(forged, kNow) != SealStatus::kOk) {
    state.SkipWithError("no session");
    return;
  }
  forge(server, forged);
  bool ok = true;
  for (auto _ : state) {
    ok = server.OnDatagram(forged, kHome, kNow).open_status == expected && ok;
    benchmark::ClobberMemory();
  }
  if (!ok) state.SkipWithError("another status");
}

void BM_RefuseForged(benchmark::State& state) {
  Refuse(state, OpenStatus::kNotAuthentic,
         [](SecureServer&, Bytes& packet) { packet.back() ^= 1; });
}
void BM_RefuseForgedPhase(benchmark::State& state) {
  Refuse(state, OpenStatus::kNotAuthentic,
         [](SecureServer&, Bytes& packet) { packet[0] ^= kPhaseBit; });
}
void BM_RefuseDuplicate(benchmark::State& state) {
  Refuse(state, OpenStatus::kDuplicate, [](SecureServer& server, Bytes& packet) {
    Bytes copy = packet;
    (void)server.OnDatagram(copy, kHome, kNow);
  });
}
void BM_RefuseUnknownSession(benchmark::State& state) {
  Refuse(state, OpenStatus::kUnknownSession, [](SecureServer&, Bytes& packet) { packet[6] ^= 1; });
}

void BM_Cookie(benchmark::State& state) {
  test::RepeatableRandom random;
  CookieMaker maker(random);
  TokenNonce nonce{};
  for (auto _ : state) {
    Cookie cookie = maker.Make(CookieMaker::Purpose::kInitiation, kHome, nonce, kNow.us);
    benchmark::DoNotOptimize(cookie);
  }
}

void BM_OpenToken(benchmark::State& state) {
  test::RepeatableRandom random;
  const KeyRing ring = test::MakeRing(random);
  const ClientToken token = test::MakeTestToken(ring, random);
  OpenedToken opened;
  for (auto _ : state) {
    benchmark::DoNotOptimize(OpenToken(token.bytes, ring.keys()[0].key, opened));
  }
}

void BM_X25519(benchmark::State& state) {
  test::RepeatableRandom random;
  const KeyPair one = MakeKeyPair(random);
  const KeyPair two = MakeKeyPair(random);
  Key result;
  for (auto _ : state) benchmark::DoNotOptimize(X25519(one.secret, two.shared, result));
}

// What a server does for an initiation: range(0) says how far an attacker gets.
enum Attacker : std::int64_t { kNoToken, kSeenToken, kProvenAddress, kHolder };

void BM_Initiation(benchmark::State& state) {
  const auto attacker = static_cast<Attacker>(state.range(0));
  test::RepeatableRandom random;
  const KeyRing ring = test::MakeRing(random);
  ClientToken token = test::MakeTestToken(ring, random);
  if (attacker == kNoToken) token.bytes[8] ^= 1;  // another key id
  if (attacker == kProvenAddress) token.key = random.MakeKey();
  Admission admission(
      {.handshakes_per_second = 1'000'000'000, .handshakes_per_second_of_a_token = 1'000'000'000},
      random);
  admission.SetKeys(ring);
  TokenHead head;
  (void)ReadTokenHead(token.bytes, head);
  Cookie cookie{};
  if (attacker >= kProvenAddress) {
    cookie =
        admission.cookies().Make(CookieMaker::Purpose::kInitiation, kHome, head.nonce, kNow.us);
  }
  Bytes datagram(kInitiationBytes);
  WriteInitiationHead(1, token.bytes, cookie, datagram);
  Handshake handshake(Handshake::Side::kInitiator, token.key,
                      PrologueOf(ByteView(datagram).first(kInitiationMessageAt)), random);
  const Bytes payload(kInitiationPayloadBytes);
  (void)handshake.Write(payload, ByteSpan(datagram).subspan(kInitiationMessageAt));
  AcceptedHandshake accepted;
  AdmissionResult result;
  for (auto _ : state) {
    result = admission.OnInitiation(datagram, kHome, kNow, 1, accepted);
    if (result.outcome == AdmissionOutcome::kAccepted) {
      admission.Release(accepted.client_key, accepted.use, 1);
    }
  }
  const AdmissionOutcome expected[] = {AdmissionOutcome::kRefused, AdmissionOutcome::kRetry,
                                       AdmissionOutcome::kRefused, AdmissionOutcome::kAccepted};
  if (result.outcome != expected[attacker]) state.SkipWithError("another outcome");
}

void Sizes(benchmark::internal::Benchmark* bench) { bench->ArgName("bytes")->Arg(400)->Arg(1'200); }

BENCHMARK(BM_Copy)->Apply(Sizes);
BENCHMARK(BM_Seal)->Apply(Sizes);
BENCHMARK(BM_SealAndOpen)->Apply(Sizes);
BENCHMARK(BM_RefuseForged)->Apply(Sizes);
BENCHMARK(BM_RefuseForgedPhase)->Apply(Sizes);
BENCHMARK(BM_RefuseDuplicate)->Apply(Sizes);
BENCHMARK(BM_RefuseUnknownSession)->Apply(Sizes);
BENCHMARK(BM_Cookie);
BENCHMARK(BM_OpenToken);
BENCHMARK(BM_X25519);
BENCHMARK(BM_Initiation)
    ->ArgName("attacker")
    ->Arg(kNoToken)
    ->Arg(kSeenToken)
    ->Arg(kProvenAddress)
    ->Arg(kHolder);

}  // namespace
}  // namespace furrow::protocol::secure
