// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/framing/tcp_framing.h"

namespace furrow::testing_net {

// How long clients wait for data. It only prevents hanging tests.
inline constexpr std::chrono::seconds kGuard(60);

// A received message, decoded on demand.
struct Received {
  std::vector<std::uint8_t> bytes;
  protocol::MessageView view;
};

// A test client with one blocking socket, based on protocol/ only. Reads block until data arrives,
// for kGuard at most.
class RawClient {
 public:
  virtual ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  template <class Message>
  void Send(const Message& message, std::uint16_t stream = 0, std::uint32_t sequence = 0,
            std::int64_t capture_time_us = 0, auto... encoding) {
    encoder_.Encode({session, stream, sequence, capture_time_us}, message, out_, encoding...);
    SendBytes(out_);
  }
  // Sends raw bytes: a datagram, or a part of a TCP stream.
  void SendRaw(std::span<const std::uint8_t> bytes);

  // The next message of any kind but challenges, which it answers; nullopt after the peer has
  // closed or the timeout.
  std::optional<Received> Next();
  // The next message of this kind. Others before it are kept in `skipped`.
  template <class Message>
  std::optional<Message> Await(protocol::Header* header = nullptr) {
    while (auto received = Next()) {
      Message message;
      if (protocol::Decode(received->view, message) == protocol::DecodeStatus::kOk) {
        if (header != nullptr) *header = received->view.header;
        return message;
      }
      skipped.push_back(*std::move(received));
    }
    return std::nullopt;
  }
  // Does what the daemon asks of a client before anything else. False: the daemon did not reply.
  virtual bool Introduce() { return true; }
  // Reads until the peer closes. False: timeout.
  bool AwaitClose();
  [[nodiscard]] std::uint16_t local_port() const;
  [[nodiscard]] int socket() const { return socket_; }
  // That Next() has answered so far.
  [[nodiscard]] std::uint64_t challenges() const { return challenges_; }

  std::uint64_t session = 0x5E5510;
  std::vector<Received> skipped;

 protected:
  explicit RawClient(int socket) : socket_(socket) {}
  virtual void SendBytes(std::span<const std::uint8_t> message) = 0;
  // Reads more bytes into `ready_`. False: the stream has ended.
  virtual bool Fill() = 0;
  long ReadSome(std::span<std::uint8_t> buffer);

  int socket_;
  std::deque<std::vector<std::uint8_t>> ready_;

 private:
  std::uint64_t challenges_ = 0;
  protocol::Encoder encoder_;
  std::vector<std::uint8_t> out_;
};

// A socket of this type (SOCK_DGRAM, SOCK_STREAM) that is connected to the daemon. `from`: a
// loopback address. -1: there is none.
[[nodiscard]] int ConnectSocket(int type, std::uint16_t port, const char* from = "127.0.0.1");

// A stream that is connected already. The client that takes it owns the socket.
struct Connected {
  int socket = -1;
};

class TcpClient : public RawClient {
 public:
  explicit TcpClient(std::uint16_t port);
  explicit TcpClient(Connected stream) : RawClient(stream.socket) {}

 private:
  void SendBytes(std::span<const std::uint8_t> message) override;
  bool Fill() override;
  protocol::FrameReader frames_{protocol::kMaxReplyBytes};
};

class UdpClient : public RawClient {
 public:
  // `from`: a loopback address other than 127.0.0.1.
  explicit UdpClient(std::uint16_t port, const char* from = "127.0.0.1");
  // Proves the address with Hello, Welcome, Hello. False: the daemon did not reply. `bundles`: also
  // accepts bundles; otherwise a bundle fails to decode.
  bool Prove(bool bundles = false);
  bool Introduce() override { return proven_ || Prove(); }
  // That came so far.
  [[nodiscard]] std::uint64_t datagrams() const { return datagrams_; }

 private:
  void SendBytes(std::span<const std::uint8_t> message) override;
  bool Fill() override;
  protocol::Reassembler reassembler_;
  bool bundles_ = false;
  bool proven_ = false;
  std::uint64_t datagrams_ = 0;
  std::uint32_t message_id_ = 0;
};

}  // namespace furrow::testing_net
