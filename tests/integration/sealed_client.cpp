// SPDX-License-Identifier: Apache-2.0
#include "sealed_client.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/files.h"
#include "daemon_fixture.h"
#include "protocol/secure/token/token_text.h"
#include "server/net/clock.h"

namespace furrow::testing_net {
namespace {

namespace secure = protocol::secure;
using Clock = std::chrono::steady_clock;

secure::Now ReadNow() {
  const auto us =
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch());
  return {.us = us.count(), .unix_s = 0};
}

}  // namespace

TestKeys::TestKeys() { Replace(); }

void TestKeys::Replace() {
  ring_ = {};
  EXPECT_TRUE(
      ring_.AddNew(server::UnixSeconds(), server::UnixSeconds() + 86'400, secure::SystemRandom())
          .ok());
  EXPECT_TRUE(secure::SaveKeyRing(ring_, file_).ok());
}

secure::ClientToken TestKeys::Token(secure::Roles roles, const std::string& subjects,
                                    std::int64_t seconds, const std::string& audience) const {
  secure::Grant grant;
  grant.client_id = 1;
  grant.roles = roles;
  grant.subjects = subjects;
  grant.audience = audience;
  const secure::TokenKey& key = ring_.keys().front();
  return *secure::MakeToken(key.id, key.key,
                            server::UnixSeconds() + static_cast<std::uint64_t>(seconds), grant,
                            secure::SystemRandom());
}

std::string TestKeys::TokenFile(secure::Roles roles, const std::string& subjects,
                                std::int64_t seconds) const {
  const auto path = folder_ / ("token" + std::to_string(num_files_++));
  EXPECT_TRUE(WriteSecretFile(path, ToText(Token(roles, subjects, seconds)) + "\n").ok());
  return path.string();
}

server::Config SecureConfig(const TestKeys& keys) {
  server::Config config = WeightsConfig("arkit.json");
  config.security.mode = server::Security::kRequired;
  config.security.keys = keys.file();
  config.security.name = "stage";
  config.limits.loss_seconds = 1000;  // a slow machine must not give the subject away
  return config;
}

SealedClient::SealedClient(std::uint16_t port, const secure::ClientToken& token, const char* from)
    : RawClient(ConnectSocket(SOCK_DGRAM, port, from)), port_(port), client_(token, {}) {}

bool SealedClient::Introduce() {
  const auto end = Clock::now() + kGuard;
  while (!client_.connected() && refusal_ == secure::Refusal::kNone && Clock::now() < end) {
    (void)Exchange();
  }
  // The first packet begins the session at the daemon.
  Poll();
  return client_.connected();
}

void SealedClient::StopClock() { stopped_ = Time(); }

secure::Now SealedClient::Time() const { return stopped_ ? *stopped_ : ReadNow(); }

void SealedClient::ConnectAndClose() {
  while (!client_.connected()) (void)Exchange();
  std::array<std::uint8_t, secure::kMaxPacketBytes> packet;
  const std::size_t size = client_.Close(Time(), packet);
  ASSERT_GT(size, 0u);
  SendRaw({packet.data(), size});
}

bool SealedClient::Renew(const secure::ClientToken& token) {
  client_.Renew(token);
  const auto end = Clock::now() + kGuard;
  while (!renewed_ && refusal_ == secure::Refusal::kNone && Clock::now() < end) (void)Exchange();
  return renewed_;
}

void SealedClient::MoveTo(const char* from) {
  ::close(socket_);
  socket_ = ConnectSocket(SOCK_DGRAM, port_, from);
}

void SealedClient::Poll() {
  std::array<std::uint8_t, secure::kMaxPacketBytes> packet;
  while (const std::size_t size = client_.Poll(Time(), packet)) {
    SendRaw({packet.data(), size});
  }
}

void SealedClient::SendBytes(std::span<const std::uint8_t> message) {
  const std::size_t count = protocol::NumDatagrams(message.size());
  const std::uint32_t id = message_id_++;
  std::array<std::uint8_t, secure::kMaxPacketBytes> packet;
  for (std::size_t index = 0; index < count; ++index) {
    const auto inner =
        std::span(packet).subspan(secure::kPacketHeaderBytes, protocol::kMaxDatagramBytes);
    const std::size_t size =
        protocol::WriteDatagram(message, id, index, inner) + secure::kPacketOverheadBytes;
    ASSERT_EQ(client_.Seal(std::span(packet).first(size), Time()), secure::SealStatus::kOk);
    sent_.emplace_back(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
    if (!held_) SendRaw(sent_.back());
  }
}

// Sends what is due and reads one datagram, if one arrives soon. True: it held a message.
bool SealedClient::Exchange() {
  constexpr int kInterval = 20;  // ms
  Poll();
  pollfd poll_socket{socket_, POLLIN, 0};
  if (::poll(&poll_socket, 1, kInterval) <= 0) return false;
  std::array<std::uint8_t, 2048> buffer;
  const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), 0);
  if (size <= 0) return false;
  const secure::ClientEvent event =
      client_.OnDatagram(std::span(buffer).first(static_cast<std::size_t>(size)), Time());
  if (event.refusal != secure::Refusal::kNone) refusal_ = event.refusal;
  renewed_ = renewed_ || event.renewed;
  if (event.inner.empty()) return false;
  std::span<const std::uint8_t> message;
  const auto status = reassembler_.Push({}, event.inner, 0, message);
  if (status != protocol::FragmentStatus::kWhole && status != protocol::FragmentStatus::kComplete) {
    return false;
  }
  ready_.emplace_back(message.begin(), message.end());
  return true;
}

std::optional<Received> SealedClient::TryNext() {
  if (ready_.empty() && !Exchange()) return std::nullopt;
  return Next();
}

bool SealedClient::Fill() {
  const auto end = Clock::now() + kGuard;
  while (!Exchange()) {
    if (Clock::now() >= end) return false;
  }
  return true;
}

}  // namespace furrow::testing_net
