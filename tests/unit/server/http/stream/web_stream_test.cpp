// SPDX-License-Identifier: Apache-2.0
// Web connections over TLS, as Beast uses them.
#include "server/http/stream/web_stream.h"

#include <array>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gtest/gtest.h>

#include "tests/unit/server/tls/tls_peer.h"

namespace furrow::server {
namespace {

using net::ip::tcp;

class HeldStranger : public Stranger {
 public:
  [[nodiscard]] bool IsWanted() const override { return true; }
  void NoteRequest() override { ++requests; }
  int requests = 0;
};

class WebStreamTest : public testing::Test {
 protected:
  WebStreamTest() {
    socket.connect(acceptor.local_endpoint());
    stream.emplace(acceptor.accept());
    socket.non_blocking(true);
  }

  // Lets both sides talk until `done`.
  template <class Done>
  [[nodiscard]] bool TalkUntil(const Done& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done()) {
      if (std::chrono::steady_clock::now() >= deadline) return false;
      if (loop.stopped()) loop.restart();
      loop.run_one_for(std::chrono::milliseconds(10));
      (void)client.Handshake();
      if (const std::string bytes = client.Outgoing(); !bytes.empty()) {
        net::write(socket, net::buffer(bytes));
      }
      std::array<char, 65536> bytes;
      beast::error_code error;
      const std::size_t size = socket.read_some(net::buffer(bytes), error);
      if (!error) client.Hear({bytes.data(), size});
      heard += client.Heard();
    }
    return true;
  }
  // Runs the coroutine until it has ended.
  void Run(net::awaitable<void> task) {
    bool is_over = false;
    net::co_spawn(loop, std::move(task), [&](const std::exception_ptr& failed) {
      EXPECT_TRUE(failed == nullptr);
      is_over = true;
    });
    EXPECT_TRUE(TalkUntil([&] { return is_over; }));
  }
  net::awaitable<void> Shake() {
    const beast::error_code error = co_await stream->Handshake(context);
    EXPECT_FALSE(error) << error.message();
    EXPECT_TRUE(stream->is_tls());
  }

  net::io_context loop{1};
  tcp::acceptor acceptor{loop, tcp::endpoint(net::ip::address_v4::loopback(), 0)};
  tcp::socket socket{loop};  // of the client
  const TlsContext context = ServerContext(TestCertificate());
  std::optional<WebStream> stream;
  TlsPeer client;
  std::string heard;  // by the client
};

TEST_F(WebStreamTest, CarriesRequestsAndReplies) {
  Run(Shake());
  client.Say("GET /a HTTP/1.1\r\nHost: b\r\n\r\n");
  Run([](WebStream& server) -> net::awaitable<void> {
    beast::flat_buffer buffer;
    WebRequest request;
    beast::error_code error;
    co_await http::async_read(server, buffer, request, Redirect(error));
    EXPECT_FALSE(error) << error.message();
    EXPECT_EQ(request.target(), "/a");
    http::response<http::string_body> reply(http::status::ok, 11);
    reply.body() = std::string(100'000, 'x');
    reply.prepare_payload();
    co_await http::async_write(server, reply, Redirect(error));
    EXPECT_FALSE(error) << error.message();
    co_await server.EndSending();
  }(*stream));
  ASSERT_TRUE(TalkUntil([this] { return client.HeardGoodbye(); }));
  EXPECT_TRUE(heard.starts_with("HTTP/1.1 200 OK\r\n"));
  EXPECT_TRUE(heard.ends_with(std::string(100'000, 'x')));
}

TEST_F(WebStreamTest, CarriesWebSockets) {
  Run(Shake());
  client.Say(
      "GET /ws HTTP/1.1\r\nHost: b\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n");
  beast::websocket::stream<WebStream> web_socket(*std::move(stream));
  Run([](beast::websocket::stream<WebStream>& server) -> net::awaitable<void> {
    beast::error_code error;
    co_await server.async_accept(Redirect(error));
    EXPECT_FALSE(error) << error.message();
  }(web_socket));
  EXPECT_TRUE(heard.starts_with("HTTP/1.1 101 "));
  // A text message and a close frame, with a mask of zeros.
  client.Say(std::string("\x81\x82\0\0\0\0hi\x88\x82\0\0\0\0\x03\xe8", 16));
  Run([](beast::websocket::stream<WebStream>& server) -> net::awaitable<void> {
    beast::flat_buffer buffer;
    beast::error_code error;
    co_await server.async_read(buffer, Redirect(error));
    EXPECT_EQ(beast::buffers_to_string(buffer.data()), "hi");
    co_await server.async_read(buffer, Redirect(error));
    EXPECT_EQ(error, beast::websocket::error::closed);
  }(web_socket));
  ASSERT_TRUE(TalkUntil([this] { return client.HeardGoodbye(); })) << "the end of TLS";
}

TEST_F(WebStreamTest, ReadsExpire) {
  Run(Shake());
  Run([](WebStream& server) -> net::awaitable<void> {
    std::array<char, 10> bytes;
    beast::error_code error;
    server.expires_after(std::chrono::milliseconds(1));
    co_await server.async_read_some(net::buffer(bytes), Redirect(error));
    EXPECT_EQ(error, net::error::timed_out);
    EXPECT_FALSE(server.is_open());
  }(*stream));
}

TEST_F(WebStreamTest, AStrangerIsHeldUntilItIsAdmitted) {
  Run(Shake());
  EXPECT_FALSE(stream->MustMakeRoom());
  auto stranger = std::make_shared<HeldStranger>();
  const std::weak_ptr<Stranger> held = stranger;
  HeldStranger& watch = *stranger;
  stream->NoteRequest();
  stream->Hold(std::move(stranger));
  EXPECT_EQ(watch.requests, 0);
  stream->NoteRequest();
  EXPECT_EQ(watch.requests, 1);
  EXPECT_TRUE(stream->MustMakeRoom());
  stream->Admit();
  EXPECT_TRUE(held.expired());
  EXPECT_FALSE(stream->MustMakeRoom());
}

TEST_F(WebStreamTest, TheEndIsSeenWithoutReading) {
  Run(Shake());
  EXPECT_FALSE(stream->HasEnded());
  client.SayGoodbye();
  EXPECT_TRUE(TalkUntil([this] { return stream->HasEnded(); }));
  EXPECT_FALSE(stream->has_client_certificate());
}

}  // namespace
}  // namespace furrow::server
