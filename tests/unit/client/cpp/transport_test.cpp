// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "client/cpp/tcp_transport.h"
#include "client/cpp/tls/client_tls.h"
#include "client/cpp/transports.h"
#include "protocol/codec/codec.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/framing/tcp_framing.h"

namespace furrow::client {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
constexpr milliseconds kGuard{10'000};  // only a failing test takes this long

// A plain system socket as the peer, on a free loopback port.
class Socket {
 public:
  explicit Socket(int type) : fd_(::socket(AF_INET, type, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    if (type == SOCK_STREAM) {
      EXPECT_EQ(::listen(fd_, 1), 0);
    }
  }
  ~Socket() { ::close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  int fd_;
  std::uint16_t port_ = 0;
};

std::vector<std::uint8_t> BigMessage() {
  protocol::SkeletonOffer offer;
  offer.subject = "ada";
  for (int i = 0; i < 200; ++i) {
    offer.joints.push_back(
        {.name = "joint_" + std::to_string(i), .parent = static_cast<std::int16_t>(i - 1)});
  }
  std::vector<std::uint8_t> bytes;
  protocol::Encoder().Encode({.session = 3}, offer, bytes);
  return bytes;
}

std::unique_ptr<Transport> Open(TransportKind kind, std::uint16_t port,
                                milliseconds timeout = kGuard) {
  auto transport = OpenTransport(kind, "localhost", port, timeout);
  EXPECT_TRUE(transport.ok()) << transport.status().ToString();
  return transport.ok() ? *std::move(transport) : nullptr;
}

TEST(OpenTransport, AnUnknownHostIsNamedWithTheWayOut) {
  for (const TransportKind kind : {TransportKind::kTcp, TransportKind::kUdp}) {
    const Status status = OpenTransport(kind, "no-such-host.invalid", 7400, kGuard).status();
    EXPECT_EQ(status.code(), StatusCode::kUnavailable);
    EXPECT_EQ(status.ToString(),
              "no connection to no-such-host.invalid: no host of this name was found (check the "
              "name and the network, or use a numeric address)");
  }
}

// A TCP transport and the other end of its connection.
class TcpTransportTest : public testing::Test {
 protected:
  void SetUp() override { Connect(kGuard); }
  ~TcpTransportTest() override { HangUp(); }

  void Connect(milliseconds timeout) {
    HangUp();
    transport_ = Open(TransportKind::kTcp, listener_.port(), timeout);
    ASSERT_NE(transport_, nullptr);
    peer_ = ::accept(listener_.fd(), nullptr, nullptr);
    ASSERT_GE(peer_, 0);
  }
  void HangUp() {
    if (peer_ >= 0) ::close(std::exchange(peer_, -1));
  }
  // Returns the framed bytes that the transport sends for a message.
  [[nodiscard]] std::vector<std::uint8_t> SendAndTake(std::span<const std::uint8_t> message) {
    EXPECT_EQ(transport_->Send(message), IoStatus::kOk);
    std::vector<std::uint8_t> wire(message.size() + protocol::kFramePrefixBytes);
    EXPECT_EQ(::recv(peer_, wire.data(), wire.size(), MSG_WAITALL),
              static_cast<ssize_t>(wire.size()));
    return wire;
  }
  void SendBack(std::span<const std::uint8_t> bytes) {
    ASSERT_EQ(::send(peer_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }
  void ExpectMessage(std::span<const std::uint8_t> message) {
    std::span<const std::uint8_t> received;
    ASSERT_EQ(transport_->Receive(received, kGuard), IoStatus::kOk);
    EXPECT_TRUE(std::ranges::equal(received, message));
  }
  [[nodiscard]] IoStatus ReceiveNothing(milliseconds timeout) {
    std::span<const std::uint8_t> received;
    return transport_->Receive(received, timeout);
  }

  Socket listener_{SOCK_STREAM};
  std::unique_ptr<Transport> transport_;
  int peer_ = -1;
};

TEST_F(TcpTransportTest, FramesPassInBothDirectionsInPieces) {
  const auto message = BigMessage();
  const auto wire = SendAndTake(message);
  EXPECT_TRUE(std::ranges::equal(message, std::span(wire).subspan(protocol::kFramePrefixBytes)));

  // The answer arrives in two pieces with a second frame attached: exactly two messages.
  SendBack(std::span(wire).first(wire.size() / 3));
  EXPECT_EQ(ReceiveNothing(milliseconds(1)), IoStatus::kTimeout);
  SendBack(std::span(wire).subspan(wire.size() / 3));
  SendBack(wire);
  for (int i = 0; i < 2; ++i) ExpectMessage(message);
  HangUp();
  EXPECT_EQ(ReceiveNothing(kGuard), IoStatus::kClosed);
}

TEST_F(TcpTransportTest, MessagesThatArriveDuringASendAreNotLost) {
  const auto message = BigMessage();
  const auto wire = SendAndTake(message);
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(ReceiveNothing(milliseconds(0)), IoStatus::kTimeout);
    SendBack(wire);
    for (int i = 0; i < 3; ++i) ASSERT_EQ(transport_->Send(message), IoStatus::kOk);
    ExpectMessage(message);
  }
}

TEST_F(TcpTransportTest, AnInvalidLengthIsMalformed) {
  SendBack(std::vector<std::uint8_t>(4, 0xff));
  EXPECT_EQ(ReceiveNothing(kGuard), IoStatus::kMalformed);
  EXPECT_EQ(ReceiveNothing(kGuard), IoStatus::kClosed);
  EXPECT_EQ(transport_->Send(BigMessage()), IoStatus::kClosed);
}

TEST_F(TcpTransportTest, APeerThatDoesNotReadBlocksASendOnlyUntilTheTimeout) {
  Connect(milliseconds(50));
  const std::vector<std::uint8_t> message(protocol::kMaxRequestBytes);
  IoStatus status = IoStatus::kOk;
  for (int i = 0; i < 10'000 && status == IoStatus::kOk; ++i) status = transport_->Send(message);
  EXPECT_EQ(status, IoStatus::kClosed);
  EXPECT_EQ(ReceiveNothing(kGuard), IoStatus::kClosed);
}

TEST(TcpAddressTest, AClosedPortIsAnErrorThatNamesTheAddress) {
  std::uint16_t port = 0;
  { port = Socket(SOCK_STREAM).port(); }
  const auto transport = OpenTransport(TransportKind::kTcp, "127.0.0.1", port, kGuard);
  ASSERT_FALSE(transport.ok());
  EXPECT_EQ(transport.status().code(), StatusCode::kUnavailable);
  const std::string error = transport.status().what();
  EXPECT_NE(error.find("127.0.0.1:" + std::to_string(port)), std::string::npos) << error;
}

// A peer at a TCP port that is addressed with TLS.
class TlsHandshakeTest : public testing::Test {
 protected:
  ~TlsHandshakeTest() override {
    if (thread_.joinable()) thread_.join();
  }
  // Accepts connections, reads the first bytes of each, and ends it after the answer: the next of
  // `answers`.
  void Answer(std::vector<std::string> answers) {
    thread_ = std::thread([this, answers = std::move(answers)] {
      for (const std::string& answer : answers) {
        const int peer = ::accept(listener_.fd(), nullptr, nullptr);
        std::array<char, 4096> hello{};
        EXPECT_GT(::recv(peer, hello.data(), hello.size(), 0), 0);
        EXPECT_EQ(::send(peer, answer.data(), answer.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(answer.size()));
        ::close(peer);
      }
    });
  }
  [[nodiscard]] Status Connect(milliseconds timeout) const {
    return OpenTransport(TransportKind::kTcp, "127.0.0.1", listener_.port(), timeout,
                         {.token = {}, .tls = *MakeTlsContext({})})
        .status();
  }

  Socket listener_{SOCK_STREAM};
  std::thread thread_;
};

const std::string kPlainAnswer = "HTTP/1.1 400 Bad Request\r\n\r\n";

TEST_F(TlsHandshakeTest, AnAnswerWithoutTlsIsFinal) {
  Answer({kPlainAnswer});
  const Status status = Connect(kGuard);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.what(), HasSubstr("it does not speak TLS"));
}

// A daemon closes handshakes while other clients of the host have their turn.
TEST_F(TlsHandshakeTest, AConnectionThatIsClosedIsTriedAgain) {
  Answer({"", "", kPlainAnswer});
  EXPECT_EQ(Connect(kGuard).code(), StatusCode::kInvalidArgument) << "the last answer";
}

TEST_F(TlsHandshakeTest, AConnectionThatIsClosedMayBeBusy) {
  Answer({""});
  TcpTransport transport(kGuard, {.token = {}, .tls = *MakeTlsContext({})});
  ASSERT_TRUE(transport.Begin("127.0.0.1", listener_.port()).ok());
  const Status status = transport.Await(TcpTransport::Clock::now() + kGuard);
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.what(), HasSubstr("the daemon closed the connection during the TLS handshake: "
                                       "it is busy with other clients of this address, or does not "
                                       "speak TLS at this port"));
  EXPECT_TRUE(transport.handshake_cut());
}

TEST_F(TlsHandshakeTest, ASilentDaemonMayBeBusy) {
  const Status status = Connect(milliseconds(20));
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.what(), HasSubstr("the TLS handshake took too long: the daemon is busy"));
}

// What a ReconnectingTransport sees, which tries again after every end.
TEST_F(TlsHandshakeTest, AnAttemptEndsWithoutAFailureOfTls) {
  Answer({""});
  auto transport = BeginTransport(TransportKind::kTcp, "127.0.0.1", listener_.port(), kGuard,
                                  {.token = {}, .tls = *MakeTlsContext({})});
  ASSERT_TRUE(transport.ok());
  EXPECT_EQ((*transport)->connect_timeout(), std::chrono::seconds(3));
  std::span<const std::uint8_t> received;
  EXPECT_EQ((*transport)->Receive(received, kGuard), IoStatus::kNoConnection);
  EXPECT_FALSE((*transport)->tls_failed());
  EXPECT_THAT((*transport)->failure(), HasSubstr("it is busy with other clients"));
}

TEST_F(TlsHandshakeTest, AHandshakeMayTakeLongerThanAConnect) {
  auto transport = BeginTransport(TransportKind::kTcp, "127.0.0.1", listener_.port(), kGuard,
                                  {.token = {}, .tls = *MakeTlsContext({})});
  ASSERT_TRUE(transport.ok());
  std::span<const std::uint8_t> received;
  const auto deadline = std::chrono::steady_clock::now() + kGuard;
  while ((*transport)->connect_timeout() != kTlsConnectTimeout &&
         std::chrono::steady_clock::now() < deadline) {
    EXPECT_EQ((*transport)->Receive(received, milliseconds(1)), IoStatus::kTimeout);
  }
  EXPECT_GT((*transport)->connect_timeout(), std::chrono::seconds(5)) << "of the daemon";
  EXPECT_FALSE((*transport)->tls_failed());
  EXPECT_THAT((*transport)->failure(), HasSubstr("the TLS handshake took too long"));
}

TEST(TcpAddressTest, AnIpv6AddressIsWrittenInBrackets) {
  EXPECT_EQ(AddressText("::1", 7400), "[::1]:7400");
  EXPECT_EQ(AddressText("stage-7", 7401), "stage-7:7401");
}

TEST(UdpTransportTest, LargeMessagesPassInFragments) {
  Socket peer(SOCK_DGRAM);
  auto transport = Open(TransportKind::kUdp, peer.port());
  ASSERT_NE(transport, nullptr);
  const auto message = BigMessage();
  ASSERT_GT(protocol::NumDatagrams(message.size()), 2u);
  ASSERT_EQ(transport->Send(message), IoStatus::kOk);

  // The fragments return unchanged, the last one first.
  std::vector<std::vector<std::uint8_t>> datagrams;
  sockaddr_in from{};
  for (std::size_t i = 0; i < protocol::NumDatagrams(message.size()); ++i) {
    std::vector<std::uint8_t> datagram(2000);
    socklen_t size = sizeof from;
    const ssize_t bytes = ::recvfrom(peer.fd(), datagram.data(), datagram.size(), 0,
                                     reinterpret_cast<sockaddr*>(&from), &size);
    ASSERT_GT(bytes, 0);
    ASSERT_LE(bytes, static_cast<ssize_t>(protocol::kMaxDatagramBytes));
    datagram.resize(static_cast<std::size_t>(bytes));
    datagrams.insert(datagrams.begin(), datagram);
  }
  for (const auto& datagram : datagrams) {
    ::sendto(peer.fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&from),
             sizeof from);
  }
  std::span<const std::uint8_t> received;
  ASSERT_EQ(transport->Receive(received, kGuard), IoStatus::kOk);
  EXPECT_TRUE(std::equal(received.begin(), received.end(), message.begin(), message.end()));
}

TEST(UdpTransportTest, BundlesAreSplitAndMalformedOnesReturnedWhole) {
  Socket peer(SOCK_DGRAM);
  auto transport = Open(TransportKind::kUdp, peer.port());
  ASSERT_NE(transport, nullptr);
  EXPECT_TRUE(transport->takes_bundles());
  std::vector<std::vector<std::uint8_t>> messages(3);
  for (std::uint32_t i = 0; i < 3; ++i)
    protocol::Encoder().Encode({.session = 3, .sequence = i}, protocol::Ping{i}, messages[i]);
  ASSERT_EQ(transport->Send(messages[0]), IoStatus::kOk);
  sockaddr_in to{};
  socklen_t size = sizeof to;
  std::vector<std::uint8_t> bundle(2000);
  ASSERT_GT(::recvfrom(peer.fd(), bundle.data(), bundle.size(), 0, reinterpret_cast<sockaddr*>(&to),
                       &size),
            0);
  ASSERT_TRUE(protocol::WriteBundle(messages, bundle));
  std::vector<std::uint8_t> cut(bundle.begin(), bundle.end() - 1);
  for (const auto& datagram : {bundle, cut, messages[1]}) {
    ::sendto(peer.fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&to),
             sizeof to);
  }
  std::vector<std::vector<std::uint8_t>> got;
  std::span<const std::uint8_t> received;
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(transport->Receive(received, kGuard), IoStatus::kOk);
    got.emplace_back(received.begin(), received.end());
  }
  EXPECT_EQ(got, (std::vector{messages[0], messages[1], messages[2], cut, messages[1]}));
  EXPECT_EQ(transport->Receive(received, milliseconds(0)), IoStatus::kTimeout);
}

TEST(UdpTransportTest, EachReceiveWaitsForItsOwnTime) {
  Socket peer(SOCK_DGRAM);
  auto transport = Open(TransportKind::kUdp, peer.port());
  ASSERT_NE(transport, nullptr);
  std::vector<std::uint8_t> bytes;
  protocol::Encoder().Encode({.session = 3}, protocol::Ping{}, bytes);
  ASSERT_EQ(transport->Send(bytes), IoStatus::kOk);
  std::span<const std::uint8_t> received;
  for (const int wait : {0, 1, 2, 0}) {
    EXPECT_EQ(transport->Receive(received, milliseconds(wait)), IoStatus::kTimeout);
  }
  std::vector<std::uint8_t> datagram(2000);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  ASSERT_GT(::recvfrom(peer.fd(), datagram.data(), datagram.size(), 0,
                       reinterpret_cast<sockaddr*>(&from), &size),
            0);
  for (const auto wait : {milliseconds(0), milliseconds(kGuard)}) {
    ::sendto(peer.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from),
             sizeof from);
    ASSERT_EQ(transport->Receive(received, wait), IoStatus::kOk);
    EXPECT_EQ(received.size(), bytes.size());
    EXPECT_EQ(transport->Receive(received, milliseconds(0)), IoStatus::kTimeout);
  }
}

TEST(UdpTransportTest, AClosedPortIsReportedByReceive) {
  std::uint16_t port = 0;
  { port = Socket(SOCK_DGRAM).port(); }
  auto transport = Open(TransportKind::kUdp, port);
  ASSERT_NE(transport, nullptr);
  std::vector<std::uint8_t> bytes;
  protocol::Encoder().Encode({.session = 3}, protocol::Ping{}, bytes);
  (void)transport->Send(bytes);
  std::span<const std::uint8_t> received;
  EXPECT_EQ(transport->Receive(received, kGuard), IoStatus::kNoConnection);
}

TEST(TransportTest, MessagesBeyondTheLimitAreRejected) {
  Socket peer(SOCK_DGRAM);
  auto transport = Open(TransportKind::kUdp, peer.port());
  ASSERT_NE(transport, nullptr);
  EXPECT_EQ(transport->Send(std::vector<std::uint8_t>(1 << 20)), IoStatus::kTooLarge);
}

}  // namespace
}  // namespace furrow::client
