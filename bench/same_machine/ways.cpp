// SPDX-License-Identifier: Apache-2.0
#include "bench/same_machine/ways.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bench/same_machine/ring.h"
#include "client/cpp/transports.h"
#include "server/net/udp/udp_sender.h"

namespace furrow::bench {
namespace {

using asio::ip::udp;

[[noreturn]] void Fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

class Udp : public Way {
 public:
  explicit Udp(bool bare) : bare_(bare) { socket_.non_blocking(true); }

  void StartReader() override {
    const std::uint16_t port = socket_.local_endpoint().port();
    if (bare_) {
      bare_socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      const udp::endpoint to(asio::ip::address_v4::loopback(), port);
      if (connect(bare_socket_, to.data(), static_cast<socklen_t>(to.size())) != 0) Fail("connect");
      if (send(bare_socket_, "here", 4, 0) != 4) Fail("send");
      return;
    }
    auto opened = client::OpenTransport(client::TransportKind::kUdp, "127.0.0.1", port,
                                        std::chrono::seconds(1));
    if (!opened.ok()) Fail("open");
    transport_ = std::move(opened).value();
    (void)transport_->Send(std::array<std::uint8_t, 4>{});
  }
  void StartWriter() override {
    pollfd wait{socket_.native_handle(), POLLIN, 0};
    if (poll(&wait, 1, 5000) != 1) Fail("the reader did not start");
    std::array<char, 16> hello{};
    socket_.receive_from(asio::buffer(hello), reader_);
    sender_.Open(socket_.native_handle());
  }
  void Send(std::span<const std::uint8_t> message) override {
    std::ranges::copy(message, sender_.Prepare().begin());
    sender_.Commit(1, reader_, message.size(), server::Packing::kBundled);
    sender_.Flush();
  }
  std::span<const std::uint8_t> Receive(int timeout_ms) override {
    if (!bare_) {
      std::span<const std::uint8_t> message;
      const auto status = transport_->Receive(message, std::chrono::milliseconds(timeout_ms));
      return status == client::IoStatus::kOk ? message : std::span<const std::uint8_t>();
    }
    // A waiting reader sleeps in recv() itself: one system call per message.
    if (timeout_ms > 0 && !has_timeout_) {
      const timeval timeout{timeout_ms / 1000, (timeout_ms % 1000) * 1000L};
      setsockopt(bare_socket_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
      has_timeout_ = true;
    }
    const ssize_t size =
        recv(bare_socket_, buffer_.data(), buffer_.size(), timeout_ms > 0 ? 0 : MSG_DONTWAIT);
    return std::span(buffer_).first(size > 0 ? static_cast<std::size_t>(size) : 0);
  }

 private:
  bool bare_;
  bool has_timeout_ = false;
  asio::io_context io_;
  udp::socket socket_{io_, udp::endpoint(asio::ip::address_v4::loopback(), 0)};
  udp::endpoint reader_;
  server::UdpSender sender_;
  std::unique_ptr<client::Transport> transport_;
  int bare_socket_ = -1;
  std::array<std::uint8_t, 2048> buffer_{};
};

class InRing : public Way {
 public:
  explicit InRing(Wake wake) : wake_(wake) {
    const int memory = memfd_create("furrow-bench-ring", MFD_CLOEXEC);
    if (memory < 0 || ftruncate(memory, sizeof(Ring)) != 0) Fail("memfd");
    void* const bytes = mmap(nullptr, sizeof(Ring), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
    // The reader's mapping is read-only, as it would be in a client.
    void* const view = mmap(nullptr, sizeof(Ring), PROT_READ, MAP_SHARED, memory, 0);
    close(memory);
    if (bytes == MAP_FAILED || view == MAP_FAILED) Fail("mmap");
    ring_ = new (bytes) Ring{};
    view_ = static_cast<const Ring*>(view);
    if (wake == Wake::kEventfd) {
      event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
      other_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    }
  }
  ~InRing() override {
    munmap(ring_, sizeof(Ring));
    munmap(const_cast<Ring*>(view_), sizeof(Ring));
    for (const int handle : {event_, other_}) {
      if (handle >= 0) close(handle);
    }
  }
  InRing(const InRing&) = delete;
  InRing& operator=(const InRing&) = delete;

  void Send(std::span<const std::uint8_t> message) override {
    ring_->Write(message);
    if (wake_ == Wake::kFutex) WakeReaders(*ring_);
    if (wake_ == Wake::kEventfd) {
      const std::uint64_t one = 1;
      if (write(event_, &one, sizeof(one)) != sizeof(one)) Fail("eventfd");
    }
  }
  std::span<const std::uint8_t> Receive(int timeout_ms) override {
    // An eventfd may also report a message that was read before its wake-up.
    while (timeout_ms > 0 && !HasNews() && Wait(timeout_ms)) {
    }
    while (HasNews()) {
      const std::size_t size = view_->Read(read_++, buffer_);
      if (size > 0) return std::span(buffer_).first(size);
    }
    return {};
  }
  bool SkipToNewest() override {
    const std::uint32_t written = view_->written.load(std::memory_order_acquire);
    if (written != read_) read_ = written - 1;
    return true;
  }

 private:
  [[nodiscard]] bool HasNews() const {
    return view_->written.load(std::memory_order_acquire) != read_;
  }
  // Returns false after a timeout.
  bool Wait(int timeout_ms) {
    if (wake_ != Wake::kEventfd) return WaitForNews(*view_, read_, timeout_ms);
    std::array<pollfd, 2> waits{{{event_, POLLIN, 0}, {other_, POLLIN, 0}}};
    if (poll(waits.data(), waits.size(), timeout_ms) < 1) return false;
    std::uint64_t count = 0;
    return read(event_, &count, sizeof(count)) == sizeof(count);
  }

  Wake wake_;
  Ring* ring_ = nullptr;
  const Ring* view_ = nullptr;
  int event_ = -1;
  int other_ = -1;  // stands for the client's connection to the daemon
  std::uint32_t read_ = 0;
  std::array<std::uint8_t, Ring::kMaxBytes> buffer_{};
};

class NoWay : public Way {
 public:
  void Send(std::span<const std::uint8_t>) override {}
  std::span<const std::uint8_t> Receive(int) override { return {}; }
};

}  // namespace

std::unique_ptr<Way> UdpLibrary() { return std::make_unique<Udp>(false); }
std::unique_ptr<Way> UdpBare() { return std::make_unique<Udp>(true); }
std::unique_ptr<Way> SharedRing(Wake wake) { return std::make_unique<InRing>(wake); }
std::unique_ptr<Way> Nothing() { return std::make_unique<NoWay>(); }

}  // namespace furrow::bench
