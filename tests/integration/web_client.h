// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/codec/codec.h"
#include "raw_client.h"

namespace furrow::testing_net {

// A blocking socket with the minimum of HTTP and WebSocket that the tests need, including invalid
// bytes. The long timeout only prevents hanging tests.
class WebClient {
 public:
  explicit WebClient(std::uint16_t port);
  explicit WebClient(Connected stream);
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  struct Answer {
    int status = 0;  // 0: the connection closed without a reply
    std::string head;
    std::string body;
  };
  // `headers`: whole lines with their line ends.
  Answer Ask(std::string_view method, std::string_view target, std::string_view body = {},
             std::string_view headers = "Host: localhost\r\n");
  Answer AskRaw(std::string_view bytes);
  // Closes the sending side. Replies still arrive.
  void EndSending();

  // The handshake of /ws. The reply has no body.
  Answer Upgrade(std::string_view headers = "Host: localhost\r\n");
  static constexpr int kText = 1;
  static constexpr int kBinary = 2;
  static constexpr int kClose = 8;
  void SendFrame(int opcode, std::span<const std::uint8_t> payload);
  template <class Message>
  void Send(const Message& message, std::uint16_t stream = 0, std::uint32_t sequence = 0) {
    std::vector<std::uint8_t> bytes;
    encoder_.Encode({.session = 77, .stream = stream, .sequence = sequence}, message, bytes);
    SendFrame(kBinary, bytes);
  }
  struct Frame {
    int opcode = 0;
    std::vector<std::uint8_t> payload;
    [[nodiscard]] int close_code() const {
      return payload.size() < 2 ? 0 : payload[0] << 8 | payload[1];
    }
  };
  std::optional<Frame> Next();
  // The next message, if it is of this kind.
  template <class Message>
  std::optional<Message> Take(protocol::Header* header = nullptr) {
    Message message;
    const std::optional<Frame> frame = Next();
    if (!frame || !DecodeFrame(*frame, &message, header)) return std::nullopt;
    return message;
  }
  // The next message of this kind. Other messages before it are dropped.
  template <class Message>
  std::optional<Message> Await(protocol::Header* header = nullptr) {
    Message message;
    while (const std::optional<Frame> frame = Next()) {
      if (DecodeFrame(*frame, &message, header)) return message;
    }
    return std::nullopt;
  }
  // Bytes up to and including `end`; empty if the connection closes first.
  std::string ReadUntil(std::string_view end);
  std::string Take(std::size_t count);

 private:
  template <class Message>
  static bool DecodeFrame(const Frame& frame, Message* message, protocol::Header* header) {
    protocol::MessageView view;
    if (protocol::OpenMessage(frame.payload, view, protocol::kMaxReplyBytes) !=
            protocol::DecodeStatus::kOk ||
        protocol::Decode(view, *message) != protocol::DecodeStatus::kOk) {
      return false;
    }
    if (header != nullptr) *header = view.header;
    return true;
  }
  void Write(std::string_view bytes);
  bool Fill();
  Answer ReadAnswer(bool has_body);

  int socket_ = -1;
  std::string in_;
  protocol::Encoder encoder_;
};

}  // namespace furrow::testing_net
