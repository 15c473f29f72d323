// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/secure/session/secure_client.h"
#include "protocol/secure/token/key_ring.h"
#include "raw_client.h"
#include "server/config/config.h"
#include "tests/temporary_folder.h"

namespace furrow::testing_net {

// A key file, and tokens that are sealed with its key.
class TestKeys {
 public:
  TestKeys();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::uint32_t key_id() const { return ring_.keys().front().id; }
  [[nodiscard]] protocol::secure::ClientToken Token(protocol::secure::Roles roles,
                                                    const std::string& subjects = "*",
                                                    std::int64_t seconds = 3600,
                                                    const std::string& audience = "") const;
  // The same as a file.
  [[nodiscard]] std::string TokenFile(protocol::secure::Roles roles,
                                      const std::string& subjects = "*",
                                      std::int64_t seconds = 3600) const;
  // Replaces the key by another one in the file.
  void Replace();

 private:
  void Save() const;

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "furrow.keys";
  protocol::secure::KeyRing ring_;
  mutable int num_files_ = 0;
};

// The configuration of a daemon that requires tokens of these keys.
[[nodiscard]] server::Config SecureConfig(const TestKeys& keys);

// A client of secure sessions with a real socket, and with what attackers need: the packets that
// were sent, and other addresses.
class SealedClient : public RawClient {
 public:
  SealedClient(std::uint16_t port, const protocol::secure::ClientToken& token,
               const char* from = "127.0.0.1");

  // Waits for a session. False: the daemon refuses the token; see refusal().
  bool Introduce() override;
  [[nodiscard]] protocol::secure::Refusal refusal() const { return refusal_; }
  // From now on, no time passes for this client, so it repeats nothing, however late answers are.
  void StopClock();
  // Waits for a session and closes it with the first packet.
  void ConnectAndClose();
  // Continues from another address, with the same session.
  void MoveTo(const char* from);
  // The last sealed packet that was sent, and the ones before it.
  [[nodiscard]] const std::vector<std::vector<std::uint8_t>>& sent() const { return sent_; }
  // Seals a message without sending it.
  template <class Message>
  std::vector<std::uint8_t> Seal(const Message& message, std::uint16_t stream = 0,
                                 std::uint32_t sequence = 0) {
    held_ = true;
    Send(message, stream, sequence);
    held_ = false;
    return sent_.back();
  }
  // The next message, if one arrives within some milliseconds.
  std::optional<Received> TryNext();
  // Shows a newer token inside of the session, and waits until the daemon has accepted it.
  bool Renew(const protocol::secure::ClientToken& token);

 private:
  void SendBytes(std::span<const std::uint8_t> message) override;
  bool Fill() override;
  bool Exchange();
  void Poll();
  [[nodiscard]] protocol::secure::Now Time() const;

  std::uint16_t port_;
  protocol::secure::SecureClient client_;
  protocol::secure::Refusal refusal_ = protocol::secure::Refusal::kNone;
  std::optional<protocol::secure::Now> stopped_;
  bool renewed_ = false;
  bool held_ = false;
  std::vector<std::vector<std::uint8_t>> sent_;
  protocol::Reassembler reassembler_;
  std::uint32_t message_id_ = 0;
};

}  // namespace furrow::testing_net
