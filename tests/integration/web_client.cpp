// SPDX-License-Identifier: Apache-2.0
#include "web_client.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace furrow::testing_net {
WebClient::WebClient(Connected stream) : socket_(stream.socket) {
  const timeval guard{.tv_sec = kGuard.count(), .tv_usec = 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &guard, sizeof guard);
}

WebClient::WebClient(std::uint16_t port) : WebClient(Connected{::socket(AF_INET, SOCK_STREAM, 0)}) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
}

WebClient::~WebClient() { close(socket_); }

void WebClient::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the peer has closed; its last bytes can still be read
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void WebClient::EndSending() { shutdown(socket_, SHUT_WR); }

bool WebClient::Fill() {
  std::array<char, 65536> buffer;
  const ssize_t size = recv(socket_, buffer.data(), buffer.size(), 0);
  if (size <= 0) return false;
  in_.append(buffer.data(), static_cast<std::size_t>(size));
  return true;
}

std::string WebClient::Take(std::size_t count) {
  while (in_.size() < count && Fill()) {
  }
  count = std::min(count, in_.size());
  std::string out = in_.substr(0, count);
  in_.erase(0, count);
  return out;
}

std::string WebClient::ReadUntil(std::string_view end) {
  std::size_t found = in_.find(end);
  while (found == std::string::npos) {
    if (!Fill()) return {};
    found = in_.find(end);
  }
  return Take(found + end.size());
}

WebClient::Answer WebClient::ReadAnswer(bool has_body) {
  Answer answer;
  answer.head = ReadUntil("\r\n\r\n");
  if (answer.head.size() < 12) return answer;
  std::from_chars(answer.head.data() + 9, answer.head.data() + 12, answer.status);
  constexpr std::string_view kLength = "Content-Length: ";
  const std::size_t at = answer.head.find(kLength);
  if (!has_body || at == std::string::npos) return answer;
  std::size_t length = 0;
  std::from_chars(answer.head.data() + at + kLength.size(), answer.head.data() + answer.head.size(),
                  length);
  answer.body = Take(length);
  return answer;
}

WebClient::Answer WebClient::Ask(std::string_view method, std::string_view target,
                                 std::string_view body, std::string_view headers) {
  std::string request = std::string(method) + " " + std::string(target) + " HTTP/1.1\r\n";
  request += headers;
  if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  Write(request + "\r\n" + std::string(body));
  return ReadAnswer(method != "HEAD");
}

WebClient::Answer WebClient::AskRaw(std::string_view bytes) {
  Write(bytes);
  return ReadAnswer(true);
}

WebClient::Answer WebClient::Upgrade(std::string_view headers) {
  Write("GET /ws HTTP/1.1\r\n" + std::string(headers) +
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: furrow.1\r\n\r\n");
  return ReadAnswer(true);
}

// Client frames must be masked; a mask of zeros leaves the payload unchanged.
void WebClient::SendFrame(int opcode, std::span<const std::uint8_t> payload) {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const std::size_t size = payload.size();
  const auto push = [&](int bytes) {
    for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8 * i) & 0xFF);
  };
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else if (size < 65536) {
    frame += static_cast<char>(0x80 | 126);
    push(2);
  } else {
    frame += static_cast<char>(0x80 | 127);
    push(8);
  }
  frame.append(4, '\0');
  frame.append(reinterpret_cast<const char*>(payload.data()), size);
  Write(frame);
}

std::optional<WebClient::Frame> WebClient::Next() {
  const std::string head = Take(2);
  if (head.size() < 2) return std::nullopt;
  Frame frame;
  frame.opcode = head[0] & 0x0F;
  std::size_t size = static_cast<std::uint8_t>(head[1]) & 0x7F;
  const std::size_t extra = size == 126 ? 2 : size == 127 ? 8 : 0;
  if (extra > 0) {
    size = 0;
    for (const char byte : Take(extra)) size = size << 8 | static_cast<std::uint8_t>(byte);
  }
  const std::string payload = Take(size);
  if (payload.size() < size) return std::nullopt;
  frame.payload.assign(payload.begin(), payload.end());
  return frame;
}

}  // namespace furrow::testing_net
