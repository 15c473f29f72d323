// SPDX-License-Identifier: Apache-2.0
// What a connection makes OpenSSL hold, in bytes. The daemon promises a bound of it
// (docs/SECURITY.md).
#include "server/tls/tls_connection.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/unit/server/tls/tls_peer.h"

namespace furrow::server {
namespace {

std::atomic<long> held{0};  // by OpenSSL

void* Counted(void* memory) {
  held += static_cast<long>(malloc_usable_size(memory));
  return memory;
}
void* Allocate(std::size_t size, const char*, int) { return Counted(std::malloc(size)); }
void* Reallocate(void* memory, std::size_t size, const char*, int) {
  held -= static_cast<long>(malloc_usable_size(memory));
  return Counted(std::realloc(memory, size));
}
void Release(void* memory, const char*, int) {
  held -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}
// Before OpenSSL allocates anything.
const bool is_counting = CRYPTO_set_mem_functions(&Allocate, &Reallocate, &Release) == 1;

using Progress = TlsConnection::Progress;

// Both ends of a TCP connection: a socket of another kind knows no low-water mark.
struct Sockets {
  // `room`: for what the server has not read; 0: the default of the kernel.
  explicit Sockets(int room = 0) {
    const int acceptor = socket(AF_INET, SOCK_STREAM, 0);
    if (room > 0) setsockopt(acceptor, SOL_SOCKET, SO_RCVBUF, &room, sizeof(room));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(acceptor, any, size), 0);
    EXPECT_EQ(listen(acceptor, 1), 0);
    EXPECT_EQ(getsockname(acceptor, any, &size), 0);
    EXPECT_EQ(connect(client, any, size), 0);
    const int at_once = 1;
    setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    server = accept(acceptor, nullptr, nullptr);
    close(acceptor);
  }
  ~Sockets() {
    close(client);
    close(server);
  }
  Sockets(const Sockets&) = delete;
  Sockets& operator=(const Sockets&) = delete;

  // Sends, and waits until all has arrived.
  void Send(const std::string& bytes) const {
    int before = 0;
    int after = 0;
    ioctl(server, FIONREAD, &before);
    EXPECT_EQ(send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    while (after < before + static_cast<int>(bytes.size())) ioctl(server, FIONREAD, &after);
  }
  // What the server has sent.
  [[nodiscard]] std::string Receive() const {
    std::string bytes(65536, '\0');
    const ssize_t size = recv(client, bytes.data(), bytes.size(), 0);
    EXPECT_GT(size, 0);
    bytes.resize(static_cast<std::size_t>(size > 0 ? size : 0));
    return bytes;
  }

  const int client = socket(AF_INET, SOCK_STREAM, 0);
  int server = -1;
};

class TlsConnectionTest : public testing::Test {
 protected:
  Progress Read() { return tls->Read(sockets->server, bytes).progress; }
  // Makes the handshake.
  void Shake() {
    Hello();
    sockets->Send(client->Outgoing());
    EXPECT_EQ(tls->Handshake(sockets->server).progress, Progress::kNeedsInput);
    client->Hear(sockets->Receive());
    EXPECT_TRUE(client->Handshake());
    sockets->Send(client->Outgoing());
    EXPECT_EQ(tls->Handshake(sockets->server).progress, Progress::kDone);
  }
  void Hello() { EXPECT_FALSE(client->Handshake()); }
  // Without a connection.
  void StartAnew(int room = 0) {
    tls.reset();
    sockets = std::make_unique<Sockets>(room);
    client = std::make_unique<TlsPeer>();
  }

  const SslContext context = ServerContext(TestCertificate());
  std::unique_ptr<Sockets> sockets = std::make_unique<Sockets>();
  std::unique_ptr<TlsPeer> client = std::make_unique<TlsPeer>();
  std::unique_ptr<TlsConnection> tls = std::make_unique<TlsConnection>(context.get());
  std::array<std::uint8_t, 100> bytes;
};

TEST_F(TlsConnectionTest, AStrangerMakesOpenSslHoldLittle) {
  ASSERT_TRUE(is_counting);
  // The first connection of a program makes OpenSSL load what all share.
  Shake();
  StartAnew();
  long own = 0;  // what OpenSSL holds for this connection; the client's changes are left out
  const auto count = [&own](auto call) {
    const long before = held;
    call();
    own += held - before;
  };
  count([&] { tls = std::make_unique<TlsConnection>(context.get()); });
  EXPECT_LT(own, 10'000) << "before the handshake";

  Hello();
  sockets->Send(client->Outgoing(100));
  const long before = own;
  count([&] { EXPECT_EQ(tls->Handshake(sockets->server).progress, Progress::kNeedsInput); });
  // OpenSSL prepares a handshake when it first looks for a message. Connections are made when
  // theirs has arrived.
  EXPECT_LT(own, before + 40'000) << "half a ClientHello";

  sockets->Send(client->Outgoing());
  count([&] { EXPECT_EQ(tls->Handshake(sockets->server).progress, Progress::kNeedsInput); });
  EXPECT_LT(own, 46'000) << "waiting for the answer of the client";

  client->Hear(sockets->Receive());
  EXPECT_TRUE(client->Handshake());
  const std::string answer = client->Outgoing();
  const long waiting = own;
  for (std::size_t at = 0; at + 1 < answer.size(); ++at) {
    sockets->Send(answer.substr(at, 1));
    count([&] { EXPECT_NE(tls->Handshake(sockets->server).progress, Progress::kDone); });
  }
  EXPECT_LE(own, waiting + 1000) << "half an answer";
  sockets->Send(answer.substr(answer.size() - 1));
  count([&] { EXPECT_EQ(tls->Handshake(sockets->server).progress, Progress::kDone); });
  EXPECT_LT(own, 16'000) << "after the handshake";

  const long idle = own;
  client->Say(std::string(10'000, 'a'));
  const std::string record = client->Outgoing();
  sockets->Send(record.substr(0, record.size() - 1));
  count([&] { EXPECT_EQ(Read(), Progress::kNeedsInput); });
  EXPECT_EQ(own, idle) << "half a record";
  for (int looks = 0; looks < 20; ++looks) {
    count([&] { EXPECT_EQ(Read(), Progress::kNeedsInput); });
  }
  EXPECT_EQ(own, idle) << "the same, woken for nothing";
}

// OpenSSL keeps a record that the socket does not take.
TEST_F(TlsConnectionTest, AStrangerThatDoesNotReadCostsLittle) {
  Shake();
  const long before = held;
  const std::vector<std::uint8_t> page(100'000);
  TlsConnection::Outcome outcome;
  while (outcome.progress == Progress::kDone) outcome = tls->Write(sockets->server, page);
  EXPECT_EQ(outcome.progress, Progress::kNeedsOutput);
  EXPECT_LT(held - before, 3'000);
}

// A client that has shown who it is may make OpenSSL hold a record, which saves system calls.
TEST_F(TlsConnectionTest, ATrustedClientHasItsBuffers) {
  Shake();
  tls->SetTrusting(sockets->server);
  client->Say("hello");
  const std::string record = client->Outgoing();
  sockets->Send(record.substr(0, 10));
  EXPECT_EQ(Read(), Progress::kNeedsInput);
  int left = -1;
  ioctl(sockets->server, FIONREAD, &left);
  EXPECT_EQ(left, 0);
  sockets->Send(record.substr(10));
  EXPECT_EQ(tls->Read(sockets->server, bytes).size, 5u);
}

// OpenSSL keeps its buffer for small records until the write is over. A larger record would fail.
TEST_F(TlsConnectionTest, RecordsGrowAfterTheWriteThatGoesOn) {
  for (const bool is_waiting : {false, true}) {
    StartAnew();
    tls = std::make_unique<TlsConnection>(context.get());
    Shake();
    const std::vector<std::uint8_t> page(10'000'000, 'p');
    std::size_t written = 0;
    std::size_t heard = 0;
    const auto hear = [&] {
      client->Hear(sockets->Receive());
      const std::string text = client->Heard();
      EXPECT_EQ(text, std::string(text.size(), 'p'));
      heard += text.size();
    };
    // Writes up to this byte.
    const auto write = [&](std::size_t end) {
      const auto outcome = tls->Write(sockets->server, std::span(page).first(end - written));
      EXPECT_TRUE(outcome.progress == Progress::kDone ||
                  outcome.progress == Progress::kNeedsOutput);
      written += outcome.size;
      return outcome;
    };
    std::size_t end = TlsConnection::kRecordBytes;
    if (is_waiting) {
      end = page.size();
      while (write(end).progress == Progress::kDone) {
      }
      end = written + TlsConnection::kRecordBytes;  // the same bytes again, and no more
    } else {
      EXPECT_EQ(write(end).progress, Progress::kDone);
    }
    ASSERT_LT(written, end);
    tls->SetTrusting(sockets->server);
    while (written < end) {
      const auto outcome = write(end);
      ASSERT_LT(outcome.size, TlsConnection::kRecordBytes);
      ASSERT_TRUE(outcome.size > 0 || outcome.progress == Progress::kNeedsOutput);
      if (outcome.size == 0) hear();
    }
    while (heard < written) hear();
    EXPECT_EQ(write(end + TlsConnection::kRecordBytes).size, TlsConnection::kRecordBytes)
        << "records of full size from now on";
    while (heard < written) hear();
    EXPECT_EQ(heard, written);
  }
}

// The socket's buffer is smaller than a record, which never arrives as a whole.
TEST_F(TlsConnectionTest, ALargeRecordPassesASmallSocket) {
  StartAnew(/*room=*/4096);
  tls = std::make_unique<TlsConnection>(context.get());
  Shake();
  client->Say(std::string(16'000, 'a'));
  std::string record = client->Outgoing();
  std::size_t size = 0;
  int looks = 0;
  while (size == 0) {
    const ssize_t sent = send(sockets->client, record.data(), record.size(), MSG_DONTWAIT);
    if (sent > 0) record.erase(0, static_cast<std::size_t>(sent));
    const auto outcome = tls->Read(sockets->server, bytes);
    ASSERT_TRUE(outcome.progress == Progress::kDone || outcome.progress == Progress::kNeedsInput ||
                outcome.progress == Progress::kNeedsTime);
    if (outcome.progress == Progress::kNeedsTime) ++looks;
    size = outcome.size;
  }
  EXPECT_EQ(size, bytes.size());
  EXPECT_GT(looks, 0) << "the buffer is smaller than the record";
}

// The number of a closed socket may belong to another connection.
TEST_F(TlsConnectionTest, AClosedSocketIsBroken) {
  Shake();
  const auto outcome = tls->Read(-1, bytes);
  EXPECT_EQ(outcome.progress, Progress::kBroken);
  EXPECT_EQ(outcome.code, static_cast<unsigned long>(EBADF));
  EXPECT_EQ(tls->Write(-1, bytes).progress, Progress::kBroken);
}

TEST_F(TlsConnectionTest, ErrorsThatOthersHaveLeftDoNotCount) {
  Shake();
  ERR_raise(ERR_LIB_SSL, SSL_R_BAD_EXTENSION);
  EXPECT_EQ(Read(), Progress::kNeedsInput);
  EXPECT_EQ(ERR_peek_error(), 0u);
}

}  // namespace
}  // namespace furrow::server
