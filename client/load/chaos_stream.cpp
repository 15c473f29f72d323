// SPDX-License-Identifier: Apache-2.0
#include "client/load/chaos_stream.h"

#include <cerrno>
#include <cmath>
#include <utility>

#include <sys/socket.h>

namespace furrow::load {
namespace {

constexpr std::size_t kReadBytes = 64 * 1024;

}  // namespace

ChaosStream::ChaosStream(Descriptor client, Descriptor server, const ChaosOptions& up,
                         const ChaosOptions& down, std::uint64_t number, std::int64_t start_us)
    : client_(std::move(client)),
      server_(std::move(server)),
      up_{.options = up, .random = std::mt19937_64(up.seed + 2 * number), .bytes = {}},
      down_{.options = down, .random = std::mt19937_64(down.seed + 2 * number + 1), .bytes = {}},
      start_us_(start_us) {}

bool ChaosStream::Pump(std::int64_t now_us) {
  return Move(up_, client_.get(), server_.get(), now_us) &&
         Move(down_, server_.get(), client_.get(), now_us);
}

bool ChaosStream::Move(Direction& direction, int from, int to, std::int64_t now_us) {
  if (InBlackHole(direction.options.black_holes, static_cast<double>(now_us - start_us_) * 1e-6))
    return true;
  if (direction.bytes.empty()) {
    direction.bytes.resize(kReadBytes);
    const ssize_t read = recv(from, direction.bytes.data(), kReadBytes, MSG_DONTWAIT);
    const bool nothing = read < 0 && (errno == EAGAIN || errno == EINTR);
    direction.bytes.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
    direction.written = 0;
    if (read <= 0) return nothing;
    const double share = std::uniform_real_distribution<>()(direction.random);
    direction.due_us = now_us + std::llround(direction.options.jitter_ms * 1e3 * share);
  }
  if (now_us < direction.due_us) return true;
  const std::size_t left = direction.bytes.size() - direction.written;
  const ssize_t sent =
      send(to, direction.bytes.data() + direction.written, left, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0) return errno == EAGAIN || errno == EINTR;
  direction.written += static_cast<std::size_t>(sent);
  if (direction.written == direction.bytes.size()) direction.bytes.clear();
  return true;
}

}  // namespace furrow::load
