// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <coroutine>
#include <cstddef>
#include <functional>
#include <new>
#include <string>
#include <utility>

#include "base/status.h"
#include "server/core/accept_log.h"
#include "server/core/metrics.h"
#include "server/core/network_address.h"
#include "server/core/time.h"
#include "server/machine/listen_error.h"
#include "server/machine/service_manager.h"
#include "server/net/clock.h"
#include "server/net/door/room_request.h"
#include "server/shares/fair_share.h"
#include "server/shares/lobby.h"

namespace furrow::server {

// The front door of a TCP port: listens, accepts connections, and gives each a place, shared fairly
// between hosts. A newcomer without a place waits in the lobby until a connection without use has
// given way. `Net`: AsioNet, or WebNet, because Beast brings an Asio of its own.
//
// All functions run on the thread of the loop, except address(). Destroy the door after the loop
// has stopped. The loop may destroy the door's coroutines later: their destructors do not use it.
template <class Net>
class Door {
 public:
  using Socket = typename Net::Tcp::socket;
  using Task = typename Net::template Awaitable<void>;

  struct Parts {
    std::string port;                // in the log, such as "TCP port"
    std::string limit;               // the key of the configuration that bounds the connections
    std::string flag;                // sets the port, such as "--tcp"
    std::string listener;            // the name of the socket at the service manager
    std::size_t places = 0;          // of connections
    int newcomers = Lobby::kPlaces;  // of one host that may wait for a place
    // The time after which another connection must give way to the same newcomer.
    Time again = Lobby::kAgain;
    Metrics* metrics = nullptr;  // not null; outlives the door
    // Begins a connection, which has a place of its host until the server calls FreePlace(). After
    // std::bad_alloc the door frees the place itself.
    std::function<void(Socket socket, const std::string& host)> begin;
    // Answers a connection without a place, which then closes.
    std::function<void(Socket socket)> refuse;
    // Asks that a connection gives way: one of the host, or, if `any_host`, of any host. The
    // newcomer comes in after FreePlace(), unless the request is refused.
    std::function<void(const std::string& host, bool any_host, Time now, RoomRequest* request)>
        make_room;
  };
  // `loop`: outlives the door.
  Door(typename Net::Loop& loop, Parts parts)
      : loop_(loop),
        acceptor_(loop),
        parts_(std::move(parts)),
        shares_(parts_.places),
        lobby_(parts_.newcomers),
        accept_log_(parts_.port, parts_.limit, parts_.metrics) {}
  Door(const Door&) = delete;
  Door& operator=(const Door&) = delete;

  // Listens at a numeric address. After a failure, it may be called again. Errors: kUnavailable;
  // the message names the address and the port.
  [[nodiscard]] Status Open(const HostPort& where) {
    const typename Net::Tcp::endpoint endpoint(Net::MakeAddress(where.host), where.port);
    Error error;
    acceptor_.open(endpoint.protocol(), error);
    // Allows a port in TIME_WAIT, so that a restart does not fail. A port with a listener stays an
    // error.
    if (!error) acceptor_.set_option(typename Acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(Acceptor::max_listen_connections, error);
    if (!error) address_ = {where.host, acceptor_.local_endpoint(error).port()};
    if (!error) return {};
    Error ignored;
    acceptor_.close(ignored);
    return ListenError("TCP", where, error.value(), parts_.flag);
  }
  // Listens at a socket of the service manager instead. Errors: kUnavailable.
  [[nodiscard]] Status Adopt(const ServiceManager::Listener& listener) {
    Error error;
    acceptor_.assign(listener.is_v6 ? Net::Tcp::v6() : Net::Tcp::v4(), listener.socket, error);
    if (!error) {
      const auto local = acceptor_.local_endpoint(error);
      address_ = {local.address().to_string(), local.port()};
    }
    if (!error) return {};
    return Status(StatusCode::kUnavailable, "cannot use the socket '" + parts_.listener +
                                                "' of the service manager: " + error.message());
  }
  // Where it listens. Thread-safe after Open() or Adopt().
  [[nodiscard]] const HostPort& address() const { return address_; }
  // The listening socket.
  [[nodiscard]] int socket() { return acceptor_.native_handle(); }

  // Accepts connections until Leave(), StopListening() or Close(). Lack of memory costs one
  // connection. Other exceptions propagate, and then the server accepts nobody any more.
  [[nodiscard]] Task Accept() {
    while (accepts_) {
      Error error;
      Socket socket = co_await acceptor_.async_accept(Net::Redirect(error));
      // A connection that was accepted before Leave() or StopListening() gets its place.
      if (closed_ || (error && !accepts_)) co_return;
      if (error) {
        // No descriptors are left, or the peer has gone. The pause keeps the loop from spinning.
        accept_log_.Failed(error.message());
        typename Net::Timer pause(loop_, kPause);
        co_await pause.async_wait(Net::Redirect(error));
        continue;
      }
      accept_log_.Accepted();
      try {
        LetIn(std::move(socket));
      } catch (const std::bad_alloc&) {
        parts_.metrics->Add(Counter::kAllocationsFailed);  // it costs one connection
      }
    }
  }
  // For a restart: newcomers wait in the listening socket for the next daemon.
  void Leave() {
    accepts_ = false;
    Error ignored;
    acceptor_.cancel(ignored);
  }
  // Closes the listening socket. Those who wait in the lobby may still come in.
  void StopListening() {
    accepts_ = false;
    Error ignored;
    acceptor_.close(ignored);
  }
  // Closes the listening socket, and lets nobody in any more.
  void Close() {
    closed_ = true;
    StopListening();
  }
  // True after Close(). A server asks before it begins a connection whose handshake took a while.
  [[nodiscard]] bool is_closed() const { return closed_; }

  // For connections that come another way: takes a place of the host. False: there is none.
  [[nodiscard]] bool TakePlace(const std::string& host) { return shares_.Enter(host); }
  // Gives the place of a connection back.
  void FreePlace(const std::string& host) { shares_.Leave(host); }
  // Changes the number of places. Those that are taken stay taken.
  void SetPlaces(std::size_t places) { shares_.SetPlaces(places); }

 private:
  using Acceptor = typename Net::Tcp::acceptor;
  using Error = typename Net::Error;
  static constexpr auto kPause = std::chrono::milliseconds(100);

  void LetIn(Socket socket) {
    Error error;
    const auto client = socket.remote_endpoint(error);
    std::string host = error ? std::string() : HostOf(client.address().to_string());
    const bool must_wait = lobby_.HasQueue(host) || !shares_.HasRoomFor(host);
    if (!must_wait) return Admit(std::move(socket), host);
    // Not Admit() if the lobby is full: the place that is free belongs to the queue.
    Lobby::Stay stay = lobby_.Enter(host, ReadClock());
    if (stay == nullptr) return Refuse(std::move(socket));
    // WaitForPlace() lets no std::bad_alloc out, which would be lost.
    Net::Spawn(loop_, WaitForPlace(std::move(socket), std::move(host), std::move(stay)));
  }

  // Waits until a connection without use has given way to the newcomer.
  Task WaitForPlace(Socket socket, std::string host, Lobby::Stay stay) {
    try {
      RoomRequest request;
      const Time begun = ReadClock();
      Time again = begun;
      typename Net::Timer timer(loop_);
      while (!closed_ && !(lobby_.IsFirst(host, stay) && shares_.HasRoomFor(host))) {
        const Time now = ReadClock();
        if (now - begun >= Lobby::kPatience || request.is_refused()) break;
        if (now >= again) {
          again = now + parts_.again;
          parts_.make_room(host, shares_.held(host) == 0, now, &request);
          if (request.is_refused()) break;
        }
        timer.expires_after(Lobby::kPoll);
        Error ignored;
        co_await timer.async_wait(Net::Redirect(ignored));
      }
      if (!closed_) Admit(std::move(socket), host);
    } catch (const std::bad_alloc&) {
      parts_.metrics->Add(Counter::kAllocationsFailed);
    }
  }

  // Begins the connection, or refuses it.
  void Admit(Socket socket, const std::string& host) {
    if (!shares_.Enter(host)) return Refuse(std::move(socket));
    try {
      parts_.begin(std::move(socket), host);
    } catch (const std::bad_alloc&) {
      shares_.Leave(host);
      throw;
    }
  }

  void Refuse(Socket socket) {
    parts_.metrics->Add(Counter::kConnectionsRefused);
    parts_.refuse(std::move(socket));
  }

  typename Net::Loop& loop_;
  Acceptor acceptor_;
  const Parts parts_;
  HostPort address_;
  bool accepts_ = true;
  bool closed_ = false;
  FairShare shares_;  // of the connections
  Lobby lobby_;       // of newcomers that wait for a place
  AcceptLog accept_log_;
};

}  // namespace furrow::server
