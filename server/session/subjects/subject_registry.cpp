// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_registry.h"

#include <algorithm>
#include <utility>

namespace furrow::server {
namespace {

constexpr std::size_t kMaxNamesShown = 8;

// The subject under a key; null if there is none.
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

Subject* SubjectRegistry::First(const Access& access) const {
  const auto found = std::ranges::find_if(
      subjects_, [&](const auto& subject) { return access.Concerns(subject->name); });
  return found == subjects_.end() ? nullptr : found->get();
}

Subject& SubjectRegistry::Add(std::string name, std::string host,
                              std::unique_ptr<SubjectPipeline> pipeline, Time now) {
  // What allocates may fail, and then a subject must have an entry in none of the three.
  subjects_.reserve(subjects_.size() + 1);
  auto subject = std::make_unique<Subject>();
  subject->id = next_id_++;
  subject->name = std::move(name);
  subject->host = std::move(host);
  subject->pipeline = std::move(pipeline);
  // A subject that never sends a pose must go idle as any other.
  subject->last_pose = subject->last_update = now;
  // The subject is on the heap, so its address and its name are stable while the list grows.
  Subject& added = *subject;
  const auto entry = by_name_.emplace(added.name, &added).first;
  try {
    (void)shares_.Enter(added.host);
  } catch (...) {
    by_name_.erase(entry);
    throw;
  }
  subjects_.push_back(std::move(subject));  // has room
  ++version_;
  return added;
}

void SubjectRegistry::SetOwner(Subject& subject, const StreamKey& key) {
  if (subject.owner == key) return;
  by_stream_[key] = &subject;  // may fail, so it comes first
  // Session 0 means that no stream feeds the subject: it is new or was released.
  if (subject.owner.session != 0) by_stream_.erase(subject.owner);
  subject.owner = key;
}

void SubjectRegistry::Release(Subject& subject) {
  by_stream_.erase(subject.owner);
  subject.owner = {};
}

void SubjectRegistry::Remove(SubjectId id) {
  ++version_;
  if (const Subject* subject = Find(id); subject != nullptr) shares_.Leave(subject->host);
  std::erase_if(by_stream_, [id](const auto& entry) { return entry.second->id == id; });
  std::erase_if(by_name_, [id](const auto& entry) { return entry.second->id == id; });
  std::erase_if(subjects_, [id](const auto& subject) { return subject->id == id; });
}

void SubjectRegistry::ForgetPeer(PeerId peer) {
  for (const auto& subject : subjects_) {
    if (subject->owner.peer == peer) subject->orphaned = true;
  }
}

std::string SubjectRegistry::Names(const Access& access) const {
  std::string names;
  std::size_t shown = 0;
  for (const auto& subject : subjects_) {
    if (!access.Concerns(subject->name)) continue;
    if (shown++ == kMaxNamesShown) return names + ", ...";
    names += (names.empty() ? "" : ", ") + subject->name;
  }
  return names;
}

}  // namespace furrow::server
