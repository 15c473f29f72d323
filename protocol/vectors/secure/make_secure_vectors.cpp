// SPDX-License-Identifier: Apache-2.0
// Writes the examples of connect tokens and secure datagrams. Usage: furrow-make-secure-vectors
// [--check] FOLDER. --check writes nothing and fails if a committed file differs.
//
// Each *.bin is one datagram or token; secure.json states all keys and what the files hold. Secrets
// are fixed bytes, so the files never change by themselves.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "protocol/secure/handshake/handshake_packets.h"
#include "protocol/secure/packet/packet_sealer.h"
#include "protocol/secure/session/channel.h"
#include "protocol/secure/token/connect_token.h"
#include "protocol/secure/token/token_text.h"
#include "protocol/vectors/json.h"
#include "protocol/vectors/vector_files.h"

namespace furrow::protocol::secure {
namespace {

using vectors::Fields;
using vectors::Json;
using vectors::JsonHex;
using Bytes = std::vector<std::uint8_t>;
using vectors::Files;

// Counts up from a first byte.
class CountingRandom : public RandomSource {
 public:
  explicit CountingRandom(std::uint8_t first) : next_(first) {}
  void Fill(ByteSpan bytes) override {
    for (std::uint8_t& byte : bytes) byte = next_++;
  }

 private:
  std::uint8_t next_;
};

std::string Hex(ByteView bytes) {
  std::string text = "\"";
  for (const std::uint8_t byte : bytes) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text + '"';
}

void AddFile(Files& files, const std::string& name, ByteView bytes) {
  files[name] = {bytes.begin(), bytes.end()};
}

constexpr std::uint32_t kKeyId = 0x7f3a0c21;
constexpr std::uint64_t kExpires = 1'900'000'000;
constexpr std::uint32_t kClientIndex = 0x11223344;
constexpr std::uint32_t kServerIndex = 0x00050007;

ClientToken AddToken(Files& files, const Key& token_key, Fields& json) {
  Grant grant;
  grant.client_id = 0x0123456789abcdefULL;
  grant.roles = Roles(Role::kPublish) | Role::kWatch;
  grant.packets_per_second = 4'000;
  grant.subjects = "stage-*, \u00c5nna";
  grant.audience = "stage-a";
  CountingRandom random(0x80);
  const ClientToken token = *MakeToken(kKeyId, token_key, kExpires, grant, random);
  AddFile(files, "token.bin", token.bytes);
  TokenBytes changed = token.bytes;
  changed[kTokenPublicBytes + 40] ^= 4;
  AddFile(files, "refuse_token.bin", changed);
  json = {{"key_id", Json(std::int64_t{kKeyId})},
          {"token_key", Hex(token_key.bytes())},
          {"expires", Json(static_cast<std::int64_t>(kExpires))},
          {"client_id", JsonHex(grant.client_id)},
          {"client_key", Hex(token.key.bytes())},
          {"roles", Json(ToText(grant.roles))},
          {"packets_per_second", Json(std::int64_t{grant.packets_per_second})},
          {"audience", Json(grant.audience)},
          {"subjects", Json(grant.subjects)},
          {"text", Json(ToText(token))}};
  return token;
}

Bytes Initiation(Handshake& handshake, const Bytes& head, ByteView hello) {
  Bytes datagram = head;
  datagram.resize(kInitiationBytes);
  std::array<std::uint8_t, kInitiationPayloadBytes> payload{};
  payload[0] = static_cast<std::uint8_t>(hello.size());
  payload[1] = static_cast<std::uint8_t>(hello.size() >> 8);
  std::copy(hello.begin(), hello.end(), payload.begin() + 2);
  (void)handshake.Write(payload, ByteSpan(datagram).subspan(kInitiationMessageAt));
  return datagram;
}

Bytes Head(const ClientToken& token, const Cookie& cookie) {
  Bytes head(kInitiationMessageAt);
  WriteInitiationHead(kClientIndex, token.bytes, cookie, head);
  return head;
}

// The handshake after a retry. Returns the keys of the client.
SessionKeys AddHandshake(Files& files, const ClientToken& token, ByteView hello, Fields& json) {
  Cookie cookie{};
  CountingRandom first_random(0x10);
  const Bytes first_head = Head(token, cookie);
  Handshake first(Handshake::Side::kInitiator, token.key, PrologueOf(first_head), first_random);
  AddFile(files, "initiation_first.bin", Initiation(first, first_head, hello));
  CountingRandom(0xc0).Fill(cookie);
  AddFile(files, "retry.bin", WriteRetry(kClientIndex, cookie));

  CountingRandom client_random(0x20);
  CountingRandom server_random(0x40);
  const Bytes head = Head(token, cookie);
  Handshake client(Handshake::Side::kInitiator, token.key, PrologueOf(head), client_random);
  Handshake server(Handshake::Side::kResponder, token.key, PrologueOf(head), server_random);
  const Bytes initiation = Initiation(client, head, hello);
  AddFile(files, "initiation.bin", initiation);
  Bytes refused = initiation;
  refused[4] ^= 1;  // the client's index
  AddFile(files, "refuse_initiation.bin", refused);

  std::array<std::uint8_t, kInitiationPayloadBytes> payload;
  (void)server.Read(ByteView(initiation).subspan(kInitiationMessageAt), payload);
  Bytes response(kResponseBytes);
  WriteShortHeader(PacketKind::kResponse, kClientIndex, response);
  const std::array<std::uint8_t, 4> index = {7, 0, 5, 0};
  (void)server.Write(index, ByteSpan(response).subspan(kShortHeaderBytes));
  AddFile(files, "response.bin", response);
  AddFile(files, "refused.bin", WriteRefused(kClientIndex, Refusal::kExpired));
  std::array<std::uint8_t, kResponsePayloadBytes> read;
  (void)client.Read(ByteView(response).subspan(kShortHeaderBytes), read);
  const SessionKeys keys = client.Split();
  Key client_secret;
  Key server_secret;
  CountingRandom(0x20).Fill(client_secret.bytes());
  CountingRandom(0x40).Fill(server_secret.bytes());
  json = {{"client_index", Json(std::int64_t{kClientIndex})},
          {"server_index", Json(std::int64_t{kServerIndex})},
          {"cookie", Hex(cookie)},
          {"hello", Hex(hello)},
          {"client_ephemeral", Hex(client_secret.bytes())},
          {"server_ephemeral", Hex(server_secret.bytes())},
          {"handshake_hash", Hex(keys.handshake_hash)},
          {"client_key", Hex(keys.send.bytes())},
          {"server_key", Hex(keys.receive.bytes())}};
  return keys;
}

// Seals one packet after `skipped` earlier ones, and describes it.
void AddPacket(Files& files, const std::string& name, PacketSealer& sealer, PacketKind kind,
               const std::string& from, ByteView inner, std::string& list) {
  Bytes packet(kPacketOverheadBytes + inner.size());
  std::copy(inner.begin(), inner.end(), packet.begin() + kPacketHeaderBytes);
  (void)sealer.Seal(kind, packet, 0);
  PacketHeader header;
  (void)ReadPacketHeader(packet, header);
  AddFile(files, name + ".bin", packet);
  list +=
      (list.empty() ? "" : ",\n    ") +
      Json(Fields{{"file", Json(name + ".bin")},
                  {"from", Json(from)},
                  {"kind", Json(std::string_view(kind == PacketKind::kData ? "data" : "control"))},
                  {"phase", Json(header.phase)},
                  {"counter", JsonHex(header.counter)},
                  {"inner", Hex(inner)}},
           "    ");
}

std::string AddPackets(Files& files, const SessionKeys& keys, const ClientToken& token,
                       ByteView hello) {
  std::string list;
  // The key changes after every two packets, so that the third has another phase.
  const RekeyLimits limits{2, 1};
  PacketSealer client(keys.send, kServerIndex, 0, limits);
  Bytes probe(1 + kCookieBytes);
  probe[0] = static_cast<std::uint8_t>(ControlType::kProbe);
  AddPacket(files, "client_0", client, PacketKind::kControl, "client", probe, list);
  AddPacket(files, "client_1", client, PacketKind::kData, "client", hello, list);
  AddPacket(files, "client_2", client, PacketKind::kData, "client", {}, list);
  Bytes renewal = {static_cast<std::uint8_t>(ControlType::kRenew)};
  renewal.insert(renewal.end(), token.bytes.begin(), token.bytes.end());
  const Mac proof = RenewalProof(token.key, keys.handshake_hash);
  renewal.insert(renewal.end(), proof.begin(), proof.end());
  AddPacket(files, "client_3", client, PacketKind::kControl, "client", renewal, list);
  AddPacket(files, "client_4", client, PacketKind::kData, "client", hello, list);
  PacketSealer server(keys.receive, kClientIndex, 0);
  const Bytes full(kMaxDatagramBytes, 0x5A);
  AddPacket(files, "server_0", server, PacketKind::kData, "server", full, list);
  PacketSealer last(keys.receive, kClientIndex, 0, {}, kMaxCounter);
  AddPacket(files, "server_last", last, PacketKind::kData, "server", hello, list);
  std::string changed = files["client_1.bin"];
  changed[0] = static_cast<char>(PacketKind::kControl);
  files["refuse_packet.bin"] = changed;
  return "[" + list + "]";
}

}  // namespace

Files MakeFiles() {
  Files files;
  Fields token_json;
  Fields session_json;
  const Bytes hello = {'h', 'e', 'l', 'l', 'o'};
  const Key token_key = CountingRandom(0).MakeKey();
  const ClientToken token = AddToken(files, token_key, token_json);
  const SessionKeys keys = AddHandshake(files, token, hello, session_json);
  const std::string packets = AddPackets(files, keys, token, hello);
  files["secure.json"] = Json(Fields{{"token", Json(token_json, "  ")},
                                     {"session", Json(session_json, "  ")},
                                     {"packets", packets}}) +
                         "\n";
  return files;
}

}  // namespace furrow::protocol::secure

int main(int argc, char** argv) {
  return furrow::protocol::vectors::MakeOrCheck("furrow-make-secure-vectors",
                                                {argv, static_cast<std::size_t>(argc)},
                                                furrow::protocol::secure::MakeFiles);
}
