// SPDX-License-Identifier: Apache-2.0
#include "server/net/tls_stream.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/error.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/read.hpp>
#include <asio/ssl/error.hpp>
#include <asio/write.hpp>
#include <gtest/gtest.h>

#include "server/net/asio_net.h"
#include "tests/unit/server/net/door/run_until.h"
#include "tests/unit/server/tls/tls_peer.h"

namespace furrow::server {
namespace {

using asio::ip::tcp;
using std::chrono::steady_clock;

// What an operation has come to.
struct OperationResult {
  std::optional<asio::error_code> error;
  std::size_t size = 0;
};

class TlsStreamTest : public testing::Test {
 protected:
  TlsStreamTest() {
    socket.connect(acceptor.local_endpoint());
    acceptor.accept(server);
    socket.non_blocking(true);
    socket.set_option(tcp::no_delay(true));
    client.Handshake();
  }

  auto Into(OperationResult* result) {
    return [result](asio::error_code error, std::size_t size = 0) { *result = {error, size}; };
  }
  // Lets both sides talk until `done`.
  template <class Done>
  [[nodiscard]] bool TalkUntil(const Done& done) {
    return RunUntil(loop, [&] {
      Carry();
      return done();
    });
  }
  // Carries what waits, once, as far as the socket takes it.
  void Carry() {
    Send();
    std::array<char, 65536> bytes;
    asio::error_code error;
    const std::size_t size = socket.is_open() ? socket.read_some(asio::buffer(bytes), error) : 0;
    if (!error) client.Hear({bytes.data(), size});
  }
  void Send() {
    waiting += client.Outgoing();
    asio::error_code error;
    const std::size_t size = waiting.empty() ? 0 : socket.write_some(asio::buffer(waiting), error);
    waiting.erase(0, size);
  }
  // Sends these bytes, and lets the server see them.
  void SendRaw(const std::string& bytes) { asio::write(socket, asio::buffer(bytes)); }
  // Runs the loop until nothing is ready.
  void RunReady() {
    loop.restart();
    while (loop.run_one_for(std::chrono::milliseconds(0)) > 0) {
    }
  }

  void Shake() {
    OperationResult result;
    stream.async_handshake(Into(&result));
    bool is_over = false;
    ASSERT_TRUE(TalkUntil([&] {
      is_over = is_over || client.Handshake();
      return is_over && result.error.has_value();
    }));
    ASSERT_FALSE(*result.error) << result.error->message();
  }

  asio::io_context loop{1};
  tcp::acceptor acceptor{loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  tcp::socket socket{loop};  // of the client
  tcp::socket server{loop};
  const SslContext context = ServerContext(TestCertificate());
  TlsStream<AsioNet> stream{server, context.get()};
  TlsPeer client;
  std::string waiting;  // of the client, for the socket
};

TEST_F(TlsStreamTest, CarriesBytesBothWays) {
  Shake();
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  client.Say("hello");
  ASSERT_TRUE(TalkUntil([&] { return read.error.has_value(); }));
  EXPECT_FALSE(*read.error);
  EXPECT_EQ(std::string(bytes.data(), read.size), "hello");
  OperationResult written;
  asio::async_write(stream, asio::buffer(std::string_view("welcome")), Into(&written));
  std::string heard;
  ASSERT_TRUE(TalkUntil([&] { return (heard += client.Heard()).size() >= 7; }));
  EXPECT_EQ(heard, "welcome");
  ASSERT_TRUE(RunUntil(loop, [&] { return written.error.has_value(); }));
  EXPECT_EQ(written.size, 7u);
}

TEST_F(TlsStreamTest, NoHandlerRunsInsideTheCallThatBeginsAnOperation) {
  Shake();
  client.Say("hello");
  Send();
  std::array<char, 5> bytes;
  OperationResult read;
  OperationResult written;
  OperationResult nothing;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  stream.async_write_some(asio::buffer("abc", 3), Into(&written));
  EXPECT_FALSE(read.error || written.error);
  ASSERT_TRUE(TalkUntil([&] { return read.error && written.error; }));
  stream.async_read_some(asio::mutable_buffer(), Into(&nothing));
  EXPECT_FALSE(nothing.error);
  ASSERT_TRUE(TalkUntil([&] { return nothing.error.has_value(); }));
  EXPECT_FALSE(*nothing.error);
  EXPECT_EQ(nothing.size, 0u);
}

// Megabytes, so that the socket fills up and writes end in the middle of a record.
TEST_F(TlsStreamTest, ASlowReaderGetsAll) {
  Shake();
  std::string sent(8 << 20, '\0');
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<char>(i * 2654435761u >> 24);
  OperationResult written;
  asio::async_write(stream, asio::buffer(sent), Into(&written));
  for (int i = 0; i < 10; ++i) loop.run_one_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(written.error) << "the client has not read";
  // The other direction goes on meanwhile.
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  client.Say("hello");
  Send();
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error.has_value(); }));
  EXPECT_EQ(read.size, 5u);
  std::string heard;
  ASSERT_TRUE(TalkUntil([&] { return (heard += client.Heard()).size() >= sent.size(); }));
  EXPECT_TRUE(heard == sent);
  ASSERT_TRUE(TalkUntil([&] { return written.error.has_value(); }));
  EXPECT_FALSE(*written.error);
}

TEST_F(TlsStreamTest, SmallBuffersLeaveInOneRecord) {
  Shake();
  OperationResult written;
  const std::array<asio::const_buffer, 4> buffers{asio::buffer("ab", 2), asio::const_buffer(),
                                                  asio::buffer("cd", 2), asio::buffer("e", 1)};
  stream.async_write_some(buffers, Into(&written));
  ASSERT_TRUE(RunUntil(loop, [&] { return written.error.has_value(); }));
  EXPECT_EQ(written.size, 5u);
  std::string record(100, '\0');
  record.resize(socket.read_some(asio::buffer(record)));
  EXPECT_EQ(record.size(), 5u + 5 + 1 + 16) << "header, text, type and tag";
  client.Hear(record);
  EXPECT_EQ(client.Heard(), "abcde");
}

TEST_F(TlsStreamTest, ManyBuffersFillARecordAndTheRestFollows) {
  Shake();
  stream.SetTrusting();
  const std::string part(7000, 'x');
  const std::vector<asio::const_buffer> buffers(5, asio::buffer(part));
  OperationResult first;
  stream.async_write_some(buffers, Into(&first));
  ASSERT_TRUE(TalkUntil([&] { return first.error.has_value(); }));
  EXPECT_EQ(first.size, TlsConnection::kRecordBytes);
  OperationResult all;
  asio::async_write(stream, buffers, Into(&all));
  std::string heard;
  ASSERT_TRUE(TalkUntil([&] { return (heard += client.Heard()).size() >= first.size + 35'000; }));
  ASSERT_TRUE(RunUntil(loop, [&] { return all.error.has_value(); }));
  EXPECT_EQ(all.size, 35'000u);
}

TEST_F(TlsStreamTest, TheEndOfTlsIsNoTruncation) {
  Shake();
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  client.SayGoodbye();
  ASSERT_TRUE(TalkUntil([&] { return read.error.has_value(); }));
  EXPECT_EQ(*read.error, asio::error::eof);
}

TEST_F(TlsStreamTest, AClosedSocketTruncates) {
  Shake();
  client.Say("the first half");
  const std::string record = client.Outgoing();
  SendRaw(record.substr(0, record.size() / 2));
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  RunReady();
  EXPECT_FALSE(read.error) << "more may arrive";
  socket.shutdown(tcp::socket::shutdown_send);
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error.has_value(); }));
  EXPECT_EQ(*read.error, asio::ssl::error::stream_truncated);
  // The other direction is open.
  OperationResult written;
  stream.async_write_some(asio::buffer("abc", 3), Into(&written));
  std::string heard;
  ASSERT_TRUE(TalkUntil([&] { return (heard += client.Heard()).size() >= 3; }));
  EXPECT_EQ(heard, "abc");
}

TEST_F(TlsStreamTest, AResetIsAnErrorOfTheSocket) {
  Shake();
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  socket.set_option(tcp::socket::linger(true, 0));
  socket.close();
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error.has_value(); }));
  EXPECT_EQ(*read.error, asio::error::connection_reset);
  // A signal would end the test.
  OperationResult written;
  for (int i = 0; i < 2; ++i) {
    written = {};
    stream.async_write_some(asio::buffer("abc", 3), Into(&written));
    ASSERT_TRUE(RunUntil(loop, [&] { return written.error.has_value(); }));
  }
  EXPECT_TRUE(*written.error);
}

TEST_F(TlsStreamTest, GarbageFailsTheHandshake) {
  for (const char* garbage : {"GET / HTTP/1.1\r\n\r\n", "\x16\x03\x01\xff\xff\x01 and so on"}) {
    SCOPED_TRACE(garbage);
    tcp::socket other(loop);
    tcp::socket end(loop);
    other.connect(acceptor.local_endpoint());
    acceptor.accept(end);
    TlsStream<AsioNet> one(end, context.get());
    OperationResult result;
    one.async_handshake(Into(&result));
    asio::write(other, asio::buffer(std::string_view(garbage)));
    ASSERT_TRUE(RunUntil(loop, [&] { return result.error.has_value(); }));
    EXPECT_EQ(result.error->category(), asio::error::get_ssl_category());
    EXPECT_EQ(ERR_GET_LIB(static_cast<unsigned long>(result.error->value())), ERR_LIB_SSL);
  }
}

TEST_F(TlsStreamTest, AClientThatLeavesInTheMiddleTruncates) {
  OperationResult result;
  stream.async_handshake(Into(&result));
  SendRaw(client.Outgoing(100));
  RunReady();
  EXPECT_FALSE(result.error);
  socket.close();
  ASSERT_TRUE(RunUntil(loop, [&] { return result.error.has_value(); }));
  EXPECT_EQ(*result.error, asio::ssl::error::stream_truncated);
}

TEST_F(TlsStreamTest, ClosingEndsWhatIsPending) {
  OperationResult result;
  stream.async_handshake(Into(&result));
  SendRaw(client.Outgoing());
  RunReady();  // the server waits for the answer of the client
  EXPECT_FALSE(result.error);
  server.close();
  ASSERT_TRUE(RunUntil(loop, [&] { return result.error.has_value(); }));
  EXPECT_EQ(*result.error, asio::error::operation_aborted);
  // The number of the socket may belong to another connection by now.
  std::array<char, 100> bytes;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error.has_value(); }));
  EXPECT_EQ(*read.error, asio::error::bad_descriptor);
}

TEST_F(TlsStreamTest, OperationsExpire) {
  Shake();
  std::array<char, 100> bytes;
  OperationResult patient;
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&patient));
  stream.expires_at(steady_clock::now());
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error && patient.error; }));
  EXPECT_EQ(*read.error, asio::error::timed_out);
  EXPECT_EQ(*patient.error, asio::error::operation_aborted) << "it began before";
  EXPECT_FALSE(server.is_open());
}

TEST_F(TlsStreamTest, TheEndIsSaidAndAwaited) {
  Shake();
  OperationResult said;
  stream.async_end(/*awaits_client=*/false, Into(&said));
  ASSERT_TRUE(TalkUntil([&] { return said.error && client.Heard().empty(); }));
  EXPECT_FALSE(*said.error);
  ASSERT_TRUE(TalkUntil([&] {
    (void)client.Heard();
    return client.HeardGoodbye();
  }));
  OperationResult awaited;
  stream.async_end(/*awaits_client=*/true, Into(&awaited));
  RunReady();
  EXPECT_FALSE(awaited.error);
  client.SayGoodbye();
  ASSERT_TRUE(TalkUntil([&] { return awaited.error.has_value(); }));
  EXPECT_FALSE(*awaited.error);
}

// Each byte wakes a reader that is not wary, and OpenSSL then holds 17 KiB.
TEST_F(TlsStreamTest, RecordsStayInTheKernelUntilTheyAreWhole) {
  Shake();
  client.Say(std::string(10'000, 'a') + "b");
  const std::string record = client.Outgoing();
  std::string bytes(20'000, '\0');
  OperationResult read;
  stream.async_read_some(asio::buffer(bytes), Into(&read));
  for (std::size_t at = 0; at + 1 < record.size(); at += 100) {
    SendRaw(record.substr(at, std::min<std::size_t>(100, record.size() - 1 - at)));
    RunReady();
  }
  ASSERT_TRUE(RunUntil(loop, [&] { return server.available() == record.size() - 1; }));
  RunReady();
  EXPECT_FALSE(read.error);
  SendRaw(record.substr(record.size() - 1));
  ASSERT_TRUE(RunUntil(loop, [&] { return read.error.has_value(); }));
  EXPECT_EQ(read.size, 10'001u);
  // After that, one byte is enough again.
  OperationResult next;
  stream.async_read_some(asio::buffer(bytes), Into(&next));
  client.Say("c");
  ASSERT_TRUE(TalkUntil([&] { return next.error.has_value(); }));
  EXPECT_EQ(next.size, 1u);
  // A trusted client may leave half a record with OpenSSL.
  stream.SetTrusting();
  client.Say("de");
  const std::string later = client.Outgoing();
  OperationResult trusted;
  stream.async_read_some(asio::buffer(bytes), Into(&trusted));
  SendRaw(later.substr(0, 10));
  ASSERT_TRUE(RunUntil(loop, [&] { return server.available() == 0; }));
  SendRaw(later.substr(10));
  ASSERT_TRUE(RunUntil(loop, [&] { return trusted.error.has_value(); }));
  EXPECT_EQ(trusted.size, 2u);
}

// A Unix socket always wakes its reader, as a TCP socket does when the kernel lacks memory.
TEST_F(TlsStreamTest, AReaderThatIsWokenForNothingWaitsForAMoment) {
  std::array<int, 2> pair{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()), 0);
  server.close();
  server.assign(tcp::v4(), pair[0]);
  socket.close();
  socket.assign(tcp::v4(), pair[1]);
  socket.non_blocking(true);
  OperationResult result;
  stream.async_handshake(Into(&result));
  SendRaw(client.Outgoing(100));
  for (int i = 0; i < 5; ++i) loop.run_one_for(std::chrono::milliseconds(30));
  EXPECT_FALSE(result.error);
  bool is_over = false;
  ASSERT_TRUE(TalkUntil([&] {
    is_over = is_over || client.Handshake();
    return is_over && result.error.has_value();
  }));
  EXPECT_FALSE(*result.error) << result.error->message();
}

}  // namespace
}  // namespace furrow::server
