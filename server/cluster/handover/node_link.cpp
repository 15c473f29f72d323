// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/handover/node_link.h"

#include <utility>

#include <asio/buffer.hpp>
#include <asio/steady_timer.hpp>

#include "protocol/framing/envelope.h"
#include "protocol/messages/limits.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/pause.h"

namespace furrow::server {
namespace {

namespace secure = protocol::secure;
using asio::ip::udp;

constexpr char kProgram[] = "furrowd " FURROW_VERSION;
// How often a step of the connection is repeated.
constexpr Time kHelloRepeat = std::chrono::milliseconds(50);
constexpr Time kConnectLook = std::chrono::milliseconds(2);

}  // namespace

NodeLink::NodeLink(asio::io_context& io, Options options)
    : socket_(io), options_(std::move(options)) {
  if (options_.token) secure_.emplace(*options_.token, secure::ByteView());
}

secure::Now NodeLink::At() const { return {.us = ToMicroseconds(ReadClock())}; }

// Finds the address and opens the socket. The system's look-up of names cannot be interrupted, so
// it is left alone after `patience`.
asio::awaitable<Status> NodeLink::Open(Time patience) {
  struct Found {
    bool done = false;
    asio::error_code error;
    udp::resolver::results_type results;
  };
  const auto found = std::make_shared<Found>();
  // Numeric addresses do not wait behind names.
  const auto address = asio::ip::make_address(options_.node.host, found->error);
  found->done = !found->error;
  if (found->done) {
    found->results = udp::resolver::results_type::create(udp::endpoint(address, options_.node.udp),
                                                         options_.node.host, "");
  }
  const auto timer = std::make_shared<asio::steady_timer>(socket_.get_executor());
  timer->expires_after(patience);
  udp::resolver resolver(socket_.get_executor());
  if (!found->done) {
    const auto on_found = [found, timer](const asio::error_code& error,
                                         const udp::resolver::results_type& results) {
      *found = {true, error, results};
      timer->cancel();
    };
    if (options_.look_up) {
      options_.look_up(options_.node, on_found);
    } else {
      resolver.async_resolve(options_.node.host, std::to_string(options_.node.udp), on_found);
    }
    if (!found->done) co_await timer->async_wait(kAwaitTuple);
  }
  asio::error_code error = found->done ? found->error : asio::error::timed_out;
  for (const auto& entry : found->results) {
    asio::error_code ignored;
    socket_.close(ignored);
    socket_.open(entry.endpoint().protocol(), error);
    if (!error) socket_.connect(entry.endpoint(), error);  // sends nothing
    if (!error) socket_.non_blocking(true, error);
    if (!error) break;
  }
  if (!error) co_return Status();
  co_return Fault("cannot be reached: " + error.message());
}

Status NodeLink::Fault(const std::string& why) const {
  return {StatusCode::kUnavailable, "the node '" + options_.node.name + "' " + why};
}

asio::awaitable<Status> NodeLink::Connect(Time patience) {
  const Time end = ReadClock() + patience;
  if (Status opened = co_await Open(patience); !opened.ok()) co_return opened;
  StartCriticalTask(static_cast<asio::io_context&>(socket_.get_executor().context()),
                    Read(shared_from_this()));
  Time next{0};
  while (!connected_ && refusal_.empty() && ReadClock() < end) {
    if (secure_) {
      Maintain();
    } else if (ReadClock() >= next) {
      next = ReadClock() + kHelloRepeat;
      SendHello();
    }
    co_await Pause(kConnectLook);
  }
  if (connected_) co_return Status();
  co_return Fault(refusal_.empty() ? "does not answer" : "refuses this one: " + refusal_);
}

void NodeLink::Close() {
  if (secure_ && socket_.is_open()) {
    if (const std::size_t size = secure_->Close(At(), out_); size > 0) {
      SendDatagram(std::span(out_).first(size));
    }
  }
  asio::error_code ignored;
  socket_.close(ignored);
}

void NodeLink::SendDatagram(std::span<const std::uint8_t> datagram) {
  asio::error_code lost;  // what is lost is repeated
  socket_.send(asio::buffer(datagram.data(), datagram.size()), 0, lost);
}

// Sends what the secure session itself has to send.
void NodeLink::Maintain() {
  while (const std::size_t size = secure_->Poll(At(), out_)) {
    SendDatagram(std::span(out_).first(size));
  }
}

void NodeLink::SendHello() {
  std::vector<std::uint8_t> hello;
  encoder_.Encode({.session = options_.session},
                  protocol::Hello{.client = kProgram, .token = token_}, hello);
  SendDatagram(hello);
}

// The messages of a plain address carry the session of its Hello.
void NodeLink::Send(std::span<const std::uint8_t> message) {
  protocol::Envelope envelope;
  if (message.size() > protocol::kMaxUdpMessageBytes || !socket_.is_open() ||
      protocol::ReadEnvelope(message, envelope) != protocol::EnvelopeStatus::kOk) {
    return;
  }
  message_.assign(message.begin(), message.end());
  envelope.header.session = options_.session;
  protocol::WriteEnvelope(envelope, std::span(message_).first<protocol::kEnvelopeBytes>());
  const std::uint32_t id = next_message_id_++;
  const std::size_t count = protocol::NumDatagrams(message_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t before = secure_ ? secure::kPacketHeaderBytes : 0;
    const auto inner = std::span(out_).subspan(before, protocol::kMaxDatagramBytes);
    std::size_t size = protocol::WriteDatagram(message_, id, i, inner);
    if (secure_) {
      size += secure::kPacketOverheadBytes;
      if (secure_->Seal(std::span(out_).first(size), At()) != secure::SealStatus::kOk) return;
    }
    SendDatagram(std::span(out_).first(size));
  }
}

// Holds the link, because it outlives whoever closes it.
asio::awaitable<void> NodeLink::Read(std::shared_ptr<NodeLink> self) {
  while (self->socket_.is_open()) {
    const auto [error, size] =
        co_await self->socket_.async_receive(asio::buffer(self->in_), kAwaitTuple);
    if (error == asio::error::operation_aborted || !self->socket_.is_open()) co_return;
    if (error) continue;  // an earlier datagram met a closed port
    self->OnDatagram(std::span(self->in_).first(size));
  }
}

void NodeLink::OnDatagram(std::span<std::uint8_t> datagram) {
  std::span<const std::uint8_t> inner = datagram;
  if (secure_) {
    if (!secure::IsSecure(datagram)) return;  // nothing proves a plain answer
    const secure::ClientEvent event = secure_->OnDatagram(datagram, At());
    if (event.connected) connected_ = true;
    Maintain();
    if (event.refusal != secure::Refusal::kNone && !connected_) {
      refusal_ = secure::RefusalText(event.refusal);
    }
    inner = event.inner;
  }
  if (inner.empty()) return;
  std::span<const std::uint8_t> message;
  switch (reassembler_.Push({}, inner, ToMicroseconds(ReadClock()), message)) {
    case protocol::FragmentStatus::kWhole:
    case protocol::FragmentStatus::kComplete: return OnMessage(message);
    default: return;
  }
}

void NodeLink::OnMessage(std::span<const std::uint8_t> message) {
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view) != protocol::DecodeStatus::kOk) return;
  protocol::Welcome welcome;
  protocol::Ping ping;
  protocol::SkeletonReply reply;
  protocol::ErrorMessage error;
  if (protocol::Decode(view, welcome) == protocol::DecodeStatus::kOk) {
    if (connected_) return;
    token_ = welcome.token;
    if (token_ != 0) return SendHello();
    node_session_ = view.header.session;
    connected_ = true;
  } else if (protocol::Decode(view, ping) == protocol::DecodeStatus::kOk) {
    // Without an answer, the node sends nothing more.
    std::vector<std::uint8_t> pong;
    encoder_.Encode({.session = options_.session}, protocol::Pong{ping.time_us, 0}, pong);
    Send(pong);
  } else if (!secure_ && connected_ && view.header.session != node_session_) {
    return;  // not of the node
  } else if (protocol::Decode(view, reply) == protocol::DecodeStatus::kOk) {
    options_.on_answer(view.header.sequence, reply.status == protocol::SkeletonStatus::kAccepted,
                       reply.message);
  } else if (protocol::Decode(view, error) == protocol::DecodeStatus::kOk) {
    if (!connected_) refusal_ = error.message;
    failed_ = true;
    options_.on_answer(view.header.sequence, false, error.message);
  }
}

}  // namespace furrow::server
