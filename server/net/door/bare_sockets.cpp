// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/bare_sockets.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <iterator>
#include <new>
#include <span>

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/tls/handshake.h"
#include "server/tls/record_head.h"
#include "server/tls/stranger_patience.h"

namespace furrow::server {
namespace {

static_assert(BareSockets::kPlaceDeadline > StrangerPatience::kMostPatience);

std::uint32_t Milliseconds(Time time) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(time).count());
}

void SetLowWater(int socket, int bytes) {
  setsockopt(socket, SOL_SOCKET, SO_RCVLOWAT, &bytes, sizeof(bytes));
}

// Drops what has arrived. False: the client has closed.
bool Drop(int socket) {
  std::array<char, 4096> dropped;
  ssize_t size = 0;
  // A client that sends without end is looked at again later.
  for (int reads = 0; reads < 4; ++reads) {
    size = recv(socket, dropped.data(), dropped.size(), MSG_DONTWAIT);
    if (size <= 0) break;
  }
  return size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR));
}

}  // namespace

void BareSockets::Add(const std::string& host, int socket, Time now) {
  const auto known = hosts_.try_emplace(host).first;
  try {
    known->second.arrivals.push_back(
        {.came = Milliseconds(now), .socket = socket, .low_water = 1, .stage = Stage::kSilent});
  } catch (const std::bad_alloc&) {
    if (known->second.arrivals.empty()) hosts_.erase(known);
    throw;
  }
}

std::vector<BareSockets::Event> BareSockets::Look(Time now) {
  std::vector<pollfd> watched;
  for (const auto& [name, host] : hosts_) {
    for (const Arrival& each : host.arrivals) {
      watched.push_back({each.socket, static_cast<short>(POLLIN | POLLRDHUP), 0});
    }
  }
  poll(watched.data(), watched.size(), 0);
  std::vector<Event> events;
  auto ready = watched.begin();
  for (auto& [name, host] : hosts_) {
    for (Arrival& each : host.arrivals) {
      const Time deadline = each.stage == Stage::kReady ? kPlaceDeadline : kHandshakeDeadline;
      const bool is_late = std::chrono::milliseconds(Milliseconds(now) - each.came) >= deadline;
      Kind kind = each.stage == Stage::kReady ? Kind::kBusy : Kind::kSlow;
      const bool is_judged = (ready++)->revents != 0 && Judge(&each, &kind);
      if (!is_judged && !is_late) continue;
      // The end of a plain client does not count as slow.
      if (each.stage == Stage::kAnswered && kind == Kind::kSlow) kind = Kind::kGone;
      events.push_back({name, each.socket, kind});
    }
  }
  return events;
}

void BareSockets::Remove(const std::string& host, int socket) {
  const auto found = hosts_.find(host);
  std::erase_if(found->second.arrivals,
                [socket](const Arrival& each) { return each.socket == socket; });
  if (found->second.arrivals.empty()) hosts_.erase(found);
  close(socket);
}

bool BareSockets::Judge(Arrival* arrival, Kind* kind) {
  std::array<std::uint8_t, kRecordHeadBytes> head{};
  if (arrival->stage == Stage::kAnswered) {
    *kind = Kind::kGone;
    return !Drop(arrival->socket);
  }
  const ssize_t got = recv(arrival->socket, head.data(), head.size(), MSG_PEEK | MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  pollfd end{arrival->socket, POLLRDHUP, 0};
  const bool has_ended = poll(&end, 1, 0) > 0;
  const auto seen = std::span(head).first(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (!seen.empty() && !LooksLikeTls(seen)) {
    arrival->stage = Stage::kAnswered;
    if (arrival->low_water != 1) SetLowWater(arrival->socket, 1);
    *kind = Kind::kPlain;
    return true;
  }
  // A client that has ended cannot answer.
  if (has_ended || seen.empty()) {
    *kind = Kind::kGone;
    return true;
  }
  const auto size = static_cast<std::uint16_t>(RecordBytes(seen));
  int arrived = 0;
  ioctl(arrival->socket, FIONREAD, &arrived);
  if (arrived >= size) {
    arrival->stage = Stage::kReady;
  } else if (arrival->low_water != size) {  // poll() is silent until the rest has come
    arrival->low_water = size;
    SetLowWater(arrival->socket, size);
  }
  return false;
}

std::vector<std::string> BareSockets::HostsThatWait() const {
  std::vector<std::string> names;
  const auto add = [&names](auto first, auto end) {
    for (; first != end; ++first) {
      const bool waits = std::ranges::any_of(
          first->second.arrivals, [](const Arrival& each) { return each.stage == Stage::kReady; });
      if (waits) names.push_back(first->first);
    }
  };
  const auto next = hosts_.upper_bound(last_host_);
  add(next, hosts_.end());
  add(hosts_.begin(), next);
  return names;
}

int BareSockets::Take(const std::string& host) {
  last_host_ = host;
  const auto found = hosts_.find(host);
  std::vector<Arrival>& arrivals = found->second.arrivals;
  const auto is_ready = [](const Arrival& each) { return each.stage == Stage::kReady; };
  auto taken = std::ranges::find_if(arrivals, is_ready);
  if (found->second.takes_last) {
    taken = std::prev(std::find_if(arrivals.rbegin(), arrivals.rend(), is_ready).base());
  }
  found->second.takes_last = !found->second.takes_last;
  if (taken->low_water != 1) SetLowWater(taken->socket, 1);
  const int socket = taken->socket;
  arrivals.erase(taken);
  if (arrivals.empty()) hosts_.erase(found);
  return socket;
}

void BareSockets::CloseSocket(int socket) { close(socket); }

}  // namespace furrow::server
