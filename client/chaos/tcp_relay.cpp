// SPDX-License-Identifier: Apache-2.0
#include "client/chaos/tcp_relay.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

#include <sys/socket.h>

namespace furrow::chaos {
namespace {

constexpr std::size_t kReadBytes = 64 * 1024;
// Interval for checking a stalled connection, or one with a peer that does not read.
constexpr std::int64_t kCheckUs = 1000;

}  // namespace

TcpRelay::TcpRelay(Descriptor client, Descriptor server, const Faults& up, const Faults& down,
                   std::uint64_t number, std::int64_t start_us)
    : client_(std::move(client)),
      server_(std::move(server)),
      up_{.options = up, .random = std::mt19937_64(up.seed + 2 * number), .bytes = {}},
      down_{.options = down, .random = std::mt19937_64(down.seed + 2 * number + 1), .bytes = {}},
      start_us_(start_us) {
  up_.counts.connections = 1;
  down_.counts.connections = 1;
}

void RelayCounts::Add(const RelayCounts& other) {
  connections += other.connections;
  bytes += other.bytes;
  held += other.held;
  still_us += other.still_us;
}

bool TcpRelay::Pump(std::int64_t now_us) {
  return Move(up_, client_.get(), server_.get(), now_us) &&
         Move(down_, server_.get(), client_.get(), now_us);
}

bool TcpRelay::Move(Direction& direction, int from, int to, std::int64_t now_us) {
  // A stalled direction does not even read: the sender's buffers fill, as in a real outage.
  if (StandsStill(direction, now_us)) return true;
  if (direction.bytes.empty()) {
    direction.bytes.resize(kReadBytes);
    // Reads only if all earlier bytes have left. This bounds the memory and lets TCP slow the
    // sender down.
    const ssize_t read = recv(from, direction.bytes.data(), kReadBytes, MSG_DONTWAIT);
    const bool nothing = read < 0 && (errno == EAGAIN || errno == EINTR);
    direction.bytes.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
    direction.written = 0;
    direction.drained = nothing;
    // 0 bytes or an error: one end has closed. The caller closes the other end, too.
    if (read <= 0) return nothing;
    const double share = std::uniform_real_distribution<>()(direction.random);
    direction.due_us = now_us + std::llround(direction.options.jitter_ms * 1e3 * share);
    direction.counts.held += direction.due_us > now_us ? 1 : 0;
  }
  if (now_us < direction.due_us) return true;
  const std::size_t left = direction.bytes.size() - direction.written;
  const ssize_t sent =
      send(to, direction.bytes.data() + direction.written, left, MSG_DONTWAIT | MSG_NOSIGNAL);
  // A peer that does not read: NextUs() tries again soon.
  if (sent < 0) return errno == EAGAIN || errno == EINTR;
  direction.written += static_cast<std::size_t>(sent);
  direction.counts.bytes += static_cast<std::uint64_t>(sent);
  if (direction.written == direction.bytes.size()) direction.bytes.clear();
  return true;
}

bool TcpRelay::StandsStill(Direction& direction, std::int64_t now_us) const {
  const bool still =
      InBlackHole(direction.options.black_holes, static_cast<double>(now_us - start_us_) * 1e-6);
  // Adds the time since the last call, so the total is right even if the connection ends in a
  // stall.
  if (direction.still_since_us >= 0) direction.counts.still_us += now_us - direction.still_since_us;
  direction.still_since_us = still ? now_us : -1;
  return still;
}

std::int64_t TcpRelay::next_us(std::int64_t now_us) const {
  const std::int64_t up = NextUs(up_, now_us);
  const std::int64_t down = NextUs(down_, now_us);
  // -1 means never, so the earlier of two times is their minimum only if neither is -1.
  return up < 0 || down < 0 ? std::max(up, down) : std::min(up, down);
}

std::int64_t TcpRelay::NextUs(const Direction& direction, std::int64_t now_us) {
  if (direction.still_since_us >= 0) return now_us + kCheckUs;
  // More data may wait behind a full read, and the edge-triggered poller would not report it again.
  if (direction.bytes.empty()) return direction.drained ? -1 : now_us;
  return direction.due_us > now_us ? direction.due_us : now_us + kCheckUs;
}

}  // namespace furrow::chaos
