// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/node_table.h"

#include <utility>

namespace furrow::server {

void NodeTable::Update(int subjects, bool draining, bool ready) {
  // Others learn of a change at once.
  if (draining != self_.draining || ready != self_.ready) next_ = Time{0};
  self_.subjects = subjects;
  self_.draining = draining;
  self_.ready = ready;
}

void NodeTable::BeginListing() {
  for (auto& [name, known] : nodes_) known.listed = false;
}

void NodeTable::EndListing() {
  std::erase_if(nodes_, [](const auto& each) { return !each.second.listed; });
}

void NodeTable::OnRecord(std::string_view name, std::string_view value, Revision revision,
                         Time now) {
  const auto node = ParseAnnouncement(name, value);
  auto found = nodes_.find(name);
  if (!node) {  // deleted, or not readable
    if (found != nodes_.end()) nodes_.erase(found);
    return;
  }
  if (found == nodes_.end()) {
    if (nodes_.size() >= kMaxNodes) return;
    found = nodes_.emplace(name, Known()).first;
  }
  Known& known = found->second;
  known.listed = true;
  if (known.revision == revision) return;
  known = {.node = *node, .revision = revision, .seen = now, .listed = true};
}

bool NodeTable::HasRival(Time now) const {
  const auto own = nodes_.find(self_.address.name);
  return own != nodes_.end() && own->second.node.run != self_.run &&
         now < own->second.seen + kLeaseTtl;
}

std::optional<StorePut> NodeTable::Tick(std::uint64_t id, Time now) {
  if (now < next_ || HasRival(now)) return std::nullopt;
  next_ = now + kLeaseRenewal;
  const auto own = nodes_.find(self_.address.name);
  return StorePut{.id = id,
                  .key = NodeKey(self_.address.name),
                  .value = ToText(self_),
                  .expected = own == nodes_.end() ? 0 : own->second.revision};
}

std::map<std::string, Announcement> NodeTable::Others(Time now, bool reachable) const {
  std::map<std::string, Announcement> others;
  for (const auto& [name, known] : nodes_) {
    if (name != self_.address.name && (!reachable || now < known.seen + kLeaseTtl))
      others.emplace(name, known.node);
  }
  return others;
}

}  // namespace furrow::server
