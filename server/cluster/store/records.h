// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/cluster/lease/lease.h"
#include "server/cluster/place.h"

// The records of a cluster's store: keys and values as text. Whoever may write to the store may
// write anything, so the readers check all of it.
namespace furrow::server {

// What a node announces of itself, once per second.
struct Announcement {
  NodeAddress address;
  std::uint64_t run = 0;  // a random number of its process
  int capacity = 0;       // subjects
  int subjects = 0;
  bool draining = false;
  bool ready = false;  // it may take subjects
  friend bool operator==(const Announcement&, const Announcement&) = default;
};

// Largest value that is read.
inline constexpr std::size_t kMaxRecordBytes = 512;

// "lease." and the subject in hexadecimal; "node." and the name.
[[nodiscard]] std::string LeaseKey(std::string_view subject);
[[nodiscard]] std::string NodeKey(std::string_view node);
// The subject or the node of a key; nothing if it is another key, or not as this program writes it.
[[nodiscard]] std::optional<std::string> SubjectOfKey(std::string_view key);
[[nodiscard]] std::optional<std::string> NodeOfKey(std::string_view key);

[[nodiscard]] std::string ToText(const Lease& lease);
[[nodiscard]] std::string ToText(const Announcement& node);
[[nodiscard]] std::optional<Lease> ParseLease(std::string_view text);
// `name`: of the key; the value does not repeat it.
[[nodiscard]] std::optional<Announcement> ParseAnnouncement(std::string_view name,
                                                            std::string_view text);

}  // namespace furrow::server
