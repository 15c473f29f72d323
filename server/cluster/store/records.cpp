// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/records.h"

#include <charconv>
#include <cstddef>
#include <limits>

#include <spdlog/fmt/fmt.h>

#include "base/text.h"
#include "protocol/messages/limits.h"
#include "protocol/messages/text.h"
#include "server/cluster/node/node_address.h"

namespace furrow::server {
namespace {

constexpr std::string_view kLeasePrefix = "lease.";
constexpr std::string_view kNodePrefix = "node.";
constexpr std::string_view kNobody = "-";

// Takes the next word as a number of at most `most`. A sign, a blank or anything else is refused.
template <class Number>
bool Take(std::string_view* text, int base, Number most, Number* number) {
  const std::string_view word = TakeToken(text);
  const char* const end = word.data() + word.size();
  const auto [parsed, error] = std::from_chars(word.data(), end, *number, base);
  return !word.empty() && error == std::errc() && parsed == end && *number >= Number{0} &&
         *number <= most;
}

bool TakeFlag(std::string_view* text, bool* flag) {
  int number = 0;
  if (!Take(text, 10, 1, &number)) return false;
  *flag = number == 1;
  return true;
}

bool TakePort(std::string_view* text, std::uint16_t* port) {
  return Take(text, 10, std::numeric_limits<std::uint16_t>::max(), port);
}

bool TakeHost(std::string_view* text, std::string* host) {
  const std::string_view word = TakeToken(text);
  *host = word;
  return IsHost(word);
}

}  // namespace

std::string LeaseKey(std::string_view subject) {
  std::string key(kLeasePrefix);
  for (const char c : subject) key += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return key;
}

std::string NodeKey(std::string_view node) { return std::string(kNodePrefix).append(node); }

std::optional<std::string> SubjectOfKey(std::string_view key) {
  if (!key.starts_with(kLeasePrefix)) return std::nullopt;
  const std::string_view digits = key.substr(kLeasePrefix.size());
  if (digits.size() > 2 * protocol::kMaxNameBytes) return std::nullopt;
  std::string subject;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    unsigned char byte = 0;
    (void)std::from_chars(digits.data() + i, digits.data() + i + 2, byte, 16);
    subject += static_cast<char>(byte);
  }
  // One form only, so that two keys never mean one subject.
  if (LeaseKey(subject) != key || subject.empty() || !protocol::IsPlainText(subject))
    return std::nullopt;
  return subject;
}

std::optional<std::string> NodeOfKey(std::string_view key) {
  if (!key.starts_with(kNodePrefix)) return std::nullopt;
  const std::string_view name = key.substr(kNodePrefix.size());
  if (!IsNodeName(name)) return std::nullopt;
  return std::string(name);
}

std::string ToText(const Lease& lease) {
  const std::string_view node = lease.node.empty() ? kNobody : std::string_view(lease.node);
  return fmt::format("1 {} {:x} {} {}", node, lease.run, lease.epoch, lease.deadline_ms);
}

std::optional<Lease> ParseLease(std::string_view text) {
  if (text.size() > kMaxRecordBytes || TakeToken(&text) != "1") return std::nullopt;
  Lease lease;
  const std::string_view node = TakeToken(&text);
  if (node != kNobody) {
    if (!IsNodeName(node)) return std::nullopt;
    lease.node = node;
  }
  if (!Take(&text, 16, std::numeric_limits<std::uint64_t>::max(), &lease.run) ||
      !Take(&text, 10, kMaxEpoch, &lease.epoch) ||
      !Take(&text, 10, std::numeric_limits<std::int64_t>::max(), &lease.deadline_ms) ||
      !TakeToken(&text).empty()) {
    return std::nullopt;
  }
  return lease;
}

std::string ToText(const Announcement& node) {
  return fmt::format("1 {:x} {} {} {} {} {} {} {} {} {}", node.run, node.address.host,
                     node.address.tcp, node.address.udp, node.address.http, node.capacity,
                     node.subjects, node.draining ? 1 : 0, node.ready ? 1 : 0,
                     node.address.https ? 1 : 0);
}

std::optional<Announcement> ParseAnnouncement(std::string_view name, std::string_view text) {
  if (text.size() > kMaxRecordBytes || TakeToken(&text) != "1") return std::nullopt;
  Announcement node;
  node.address.name = name;
  constexpr int kMost = 1'000'000;
  if (!Take(&text, 16, std::numeric_limits<std::uint64_t>::max(), &node.run) ||
      !TakeHost(&text, &node.address.host) || !TakePort(&text, &node.address.tcp) ||
      !TakePort(&text, &node.address.udp) || !TakePort(&text, &node.address.http) ||
      !Take(&text, 10, kMost, &node.capacity) || !Take(&text, 10, kMost, &node.subjects) ||
      !TakeFlag(&text, &node.draining) || !TakeFlag(&text, &node.ready) || node.address.tcp == 0 ||
      node.address.udp == 0) {
    return std::nullopt;
  }
  // Nodes of an older version do not write `https`, and those of a newer one may write more.
  std::string_view rest = text;
  if (TakeToken(&rest).empty() || TakeFlag(&text, &node.address.https)) return node;
  return std::nullopt;
}

}  // namespace furrow::server
