// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "server/cluster/store/records.h"
#include "server/cluster/store/store.h"

namespace furrow::server {

// The nodes of a cluster, as they announce themselves, and the announcements of this one. Without
// I/O and clocks, like LeaseKeeper. Not thread-safe.
class NodeTable {
 public:
  explicit NodeTable(Announcement self) : self_(std::move(self)) {}

  // What this node announces next.
  void Update(int subjects, bool draining, bool ready);

  // All records were read again: those that are not among the calls of OnRecord() that follow have
  // gone.
  void BeginListing();
  void OnRecord(std::string_view name, std::string_view value, Revision revision, Time now);
  void EndListing();

  // The announcement that must be written now, at most every kLeaseRenewal; nothing if another
  // process uses this name.
  [[nodiscard]] std::optional<StorePut> Tick(std::uint64_t id, Time now);
  // True if another live process announces itself by the name of this node.
  [[nodiscard]] bool HasRival(Time now) const;

  // The live nodes except this one. `reachable`: the store is; without it, nobody knows better than
  // what was announced last.
  [[nodiscard]] std::map<std::string, Announcement> Others(Time now, bool reachable) const;
  [[nodiscard]] const Announcement& self() const { return self_; }

 private:
  struct Known {
    Announcement node;
    Revision revision = 0;
    Time seen{0};
    bool listed = true;
  };
  static constexpr std::size_t kMaxNodes = 1024;

  Announcement self_;
  std::map<std::string, Known, std::less<>> nodes_;  // this one among them
  Time next_{0};
};

}  // namespace furrow::server
