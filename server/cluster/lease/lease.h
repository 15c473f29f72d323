// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "server/core/time.h"

namespace furrow::server {

// The right of one node to serve one subject, as the nodes of a cluster keep it in their store. The
// holder renews it. Others take it over once it was not renewed for kLeaseTtl on their own clock.
struct Lease {
  std::string node;              // the holder; empty: released, and the epoch is still remembered
  std::uint64_t run = 0;         // a random number of the holder's process
  std::uint64_t epoch = 0;       // grows with each holder; receivers drop frames of lower ones
  std::int64_t deadline_ms = 0;  // Unix time, for people; no node compares it with its clock
  friend bool operator==(const Lease&, const Lease&) = default;
};

inline constexpr Time kLeaseTtl = std::chrono::seconds(3);
inline constexpr Time kLeaseRenewal = std::chrono::seconds(1);
// The holder stops by itself after this time without a good renewal, before anybody takes over.
inline constexpr Time kLeaseStop = std::chrono::seconds(2);
// A write without an answer for this time counts as unknown: it may have happened, or not.
inline constexpr Time kLeaseWriteTime = std::chrono::milliseconds(700);
// A node that did not run for this time cannot know what the others did.
inline constexpr Time kLeaseFreeze = std::chrono::seconds(1);
// Epochs above are refused, so that no record can end the numbers.
inline constexpr std::uint64_t kMaxEpoch = std::uint64_t{1} << 62;

// Epochs are times of the wall clock, or slightly more. Those that are farther ahead of it are not
// counted on from, so that one record cannot end the placement of all subjects. 10 years, in ms.
inline constexpr std::uint64_t kMaxEpochAhead = std::uint64_t{10} * 365 * 24 * 3600 * 1000;
// 2026-01-01 in Unix milliseconds. A clock behind it has not been set yet.
inline constexpr std::uint64_t kLeastClock = 1'767'225'600'000;

// Of a record: every write gets a higher one. 0: there is no record.
using Revision = std::uint64_t;

struct LeaseEntry {
  std::string subject;
  Lease lease;
  Revision revision = 0;
};

// Everything that the store holds. `incarnation`: another number after the store was emptied.
struct LeaseListing {
  std::uint64_t incarnation = 0;
  std::vector<LeaseEntry> entries;
};

// Asks the store to replace the record only if it has the revision `expected`.
struct LeaseWrite {
  std::uint64_t id = 0;
  std::string subject;
  Lease lease;
  Revision expected = 0;
};

enum class WriteResult : std::uint8_t {
  kDone,
  kRefused,  // the record has another revision
  kUnknown,  // it may have happened
};

}  // namespace furrow::server
