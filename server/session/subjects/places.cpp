// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/places.h"

#include <algorithm>
#include <utility>

#include "protocol/messages/limits.h"

namespace furrow::server {

Place Places::Renew(std::string_view subject, Time now) {
  Place place;
  if (coordinator_ == nullptr) {
    place.kind = Place::Kind::kHere;
    place.until = kNoEnd;
    return place;
  }
  place = coordinator_->Ask(subject, now);
  // The coordinator may not have given back yet what this node has just released.
  if (closed_ && place.kind == Place::Kind::kHere) {
    place.kind = Place::Kind::kNowhere;
    place.why = "this node is draining";
  }
  return place;
}

Place Places::Ask(std::string_view subject, Time now) {
  if (coordinator_ == nullptr) return Renew(subject, now);
  Place place;
  if (asked_.size() >= most_ && !asked_.contains(subject)) {
    place.why = "too many subjects wait for their place in the cluster";
    return place;
  }
  place = Renew(subject, now);
  if (place.kind == Place::Kind::kHere || place.kind == Place::Kind::kPending) {
    asked_.insert_or_assign(std::string(subject), now);
  }
  return place;
}

Place Places::Elsewhere(std::string_view subject) const {
  return coordinator_ == nullptr || subject.empty() ? Place() : coordinator_->Elsewhere(subject);
}

Place Places::Successor(std::string_view subject, const std::set<std::string>& without) const {
  return coordinator_ == nullptr ? Place() : coordinator_->Successor(subject, without);
}

std::vector<std::string> Places::Others() const {
  std::vector<std::string> others;
  if (coordinator_ == nullptr) return others;
  for (const NodeAddress& node : coordinator_->Others()) {
    if (others.size() == protocol::kMaxOthers) break;
    std::string text = node.host + ":" + std::to_string(node.tcp) + ":" + std::to_string(node.udp);
    // The wire has no room for two nodes at one address, or for longer texts.
    if (text.size() > protocol::kMaxNameBytes ||
        std::find(others.begin(), others.end(), text) != others.end()) {
      continue;
    }
    others.push_back(std::move(text));
  }
  return others;
}

void Places::Release(std::string_view subject) {
  if (coordinator_ == nullptr) return;
  if (const auto asked = asked_.find(subject); asked != asked_.end()) asked_.erase(asked);
  coordinator_->Release(subject);
}

void Places::Expire(const std::function<bool(std::string_view subject)>& is_published, Time now) {
  for (auto it = asked_.begin(); it != asked_.end();) {
    const bool published = is_published(it->first);
    if (!published && now - it->second < kPatience) {
      ++it;
      continue;
    }
    if (!published) coordinator_->Release(it->first);
    it = asked_.erase(it);
  }
}

Place Places::Expect(std::string_view subject, Time now) {
  Place place;
  if (coordinator_ == nullptr) {
    place.why = "this daemon is in no cluster";
  } else if (asked_.size() >= most_ && !asked_.contains(subject)) {
    place.why = "too many subjects wait for their place in the cluster";
  } else {
    place = coordinator_->Expect(subject, now);
    if (place.kind == Place::Kind::kPending) asked_.insert_or_assign(std::string(subject), now);
  }
  return place;
}

void Places::HandOver(std::string_view subject, const NodeAddress& heir) {
  if (const auto asked = asked_.find(subject); asked != asked_.end()) asked_.erase(asked);
  if (coordinator_ != nullptr) coordinator_->HandOver(subject, heir);
}

void Places::Close() {
  SetDraining();
  closed_ = true;
}

void Places::SetDraining() {
  draining_ = true;
  if (coordinator_ != nullptr) coordinator_->SetDraining();
}

std::string ElsewhereText(std::string_view subject, const NodeAddress& node) {
  return "'" + std::string(subject) + "' is served by the node '" + node.name + "' at " + node.host;
}

}  // namespace furrow::server
