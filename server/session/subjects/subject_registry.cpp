// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_registry.h"

#include <algorithm>
#include <utility>

namespace furrow::server {
namespace {

constexpr std::size_t kMaxNamesShown = 8;

template <class Map, class Key>
Subject* Look(const Map& map, const Key& key) {
  const auto found = map.find(key);
  return found == map.end() ? nullptr : found->second;
}

}  // namespace

Subject* SubjectRegistry::Find(std::string_view name) { return Look(by_name_, name); }

Subject* SubjectRegistry::Find(const StreamKey& key) { return Look(by_stream_, key); }

Subject* SubjectRegistry::Find(SubjectId id) {
  const auto found = std::ranges::find(subjects_, id, [](const auto& each) { return each->id; });
  return found == subjects_.end() ? nullptr : found->get();
}

Subject* SubjectRegistry::First() { return subjects_.empty() ? nullptr : subjects_.front().get(); }

Subject& SubjectRegistry::Add(std::string name, Time now) {
  ++version_;
  auto subject = std::make_unique<Subject>();
  subject->id = next_id_++;
  subject->name = std::move(name);
  subject->last_pose = subject->last_update = now;
  Subject& added = *subject;
  by_name_.emplace(added.name, &added);
  subjects_.push_back(std::move(subject));
  return added;
}

void SubjectRegistry::SetOwner(Subject& subject, const StreamKey& key) {
  if (subject.owner == key) return;
  if (subject.owner.session != 0) {
    by_stream_.erase(subject.owner);
    Retire(subject.owner, subject.id);
  }
  retired_.erase(key);
  subject.owner = key;
  by_stream_[key] = &subject;
}

// A peer may restart a subject under new session numbers without end, so the memory is bounded.
void SubjectRegistry::Retire(const StreamKey& key, SubjectId subject) {
  retired_[key] = {subject, ++num_retired_};
  retired_order_.emplace_back(key, num_retired_);
  if (retired_order_.size() <= kMaxRetired) return;
  const auto& [oldest, number] = retired_order_.front();
  if (const auto known = retired_.find(oldest);
      known != retired_.end() && known->second.number == number) {
    retired_.erase(known);
  }
  retired_order_.pop_front();
}

void SubjectRegistry::Release(Subject& subject) {
  by_stream_.erase(subject.owner);
  subject.owner = {};
}

void SubjectRegistry::Remove(SubjectId id) {
  ++version_;
  std::erase_if(retired_, [id](const auto& entry) { return entry.second.subject == id; });
  std::erase_if(by_stream_, [id](const auto& entry) { return entry.second->id == id; });
  std::erase_if(by_name_, [id](const auto& entry) { return entry.second->id == id; });
  std::erase_if(subjects_, [id](const auto& subject) { return subject->id == id; });
}

void SubjectRegistry::ForgetPeer(PeerId peer) {
  std::erase_if(retired_, [peer](const auto& entry) { return entry.first.peer == peer; });
}

std::string SubjectRegistry::Names() const {
  std::string names;
  for (std::size_t i = 0; i < subjects_.size() && i < kMaxNamesShown; ++i) {
    names += (i == 0 ? "" : ", ") + subjects_[i]->name;
  }
  return names + (subjects_.size() > kMaxNamesShown ? ", ..." : "");
}

}  // namespace furrow::server
