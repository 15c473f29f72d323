// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "protocol/framing/sequence.h"
#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/pipeline/subject_pipeline.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/rest_detector.h"
#include "server/session/subjects/subject_stats.h"

namespace furrow::server {

// Who publishes: a peer, the session it drew at its start, its number for the subject.
struct StreamKey {
  PeerId peer = 0;
  std::uint64_t session = 0;
  std::uint16_t stream = 0;
  friend auto operator<=>(const StreamKey&, const StreamKey&) = default;
};

// The session is random; streams of one session are apart.
struct StreamKeyHash {
  std::size_t operator()(const StreamKey& key) const {
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
    return (key.session ^ (key.peer * kOdd)) + key.stream * (kOdd >> 7 | 1);
  }
};

using SubjectId = std::uint64_t;  // never used twice in a run; 0 is nobody

// Somebody captured: a name, the stream that feeds it now, and what its poses come to.
struct Subject {
  SubjectId id = 0;
  std::string name;
  StreamKey owner;
  std::uint64_t skeleton_hash = 0;  // of the owner's offer
  // The owner's offer without its subject's name: shared by all who offer the same.
  std::shared_ptr<const protocol::SkeletonOffer> offer;
  protocol::SequenceWindow window;
  std::unique_ptr<SubjectPipeline> pipeline;
  Time last_pose{0};     // arrival
  Time last_update{0};   // arrival or decay
  bool ended = false;    // its publisher said goodbye: decays, then leaves
  bool lost = false;     // no pose for too long: holds, decays
  bool in_full = false;  // all of its weights are wanted, whoever subscribes to what
  SubjectStats stats;
  RestDetector rest;  // kept up while somebody watches with flow control
};

// All subjects of a daemon by name and by the stream that feeds them. In order of arrival: the
// first is "the subject that has been there longest".
class SubjectRegistry {
 public:
  static constexpr std::size_t kMaxRetired = 4096;

  [[nodiscard]] Subject* Find(std::string_view name);
  [[nodiscard]] Subject* Find(SubjectId id);
  [[nodiscard]] Subject* Find(const StreamKey& key);
  [[nodiscard]] Subject* First();

  // Precondition: no subject of this name.
  Subject& Add(std::string name, Time now);
  // Makes `key` the stream that feeds `subject`; the one that did is retired.
  void SetOwner(Subject& subject, const StreamKey& key);
  // A stream that fed a subject before another took over: its stragglers are not answered. The last
  // kMaxRetired are remembered.
  [[nodiscard]] bool IsRetired(const StreamKey& key) const { return retired_.contains(key); }
  // The subject is fed by nobody now.
  void Release(Subject& subject);

  void Remove(SubjectId id);
  // Forgets whatever this peer's streams retired.
  void ForgetPeer(PeerId peer);

  [[nodiscard]] std::size_t size() const { return subjects_.size(); }
  // Another number whenever somebody has come or gone; never 0.
  [[nodiscard]] std::uint64_t version() const { return version_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Subject>>& all() const { return subjects_; }
  [[nodiscard]] std::string Names() const;  // "a, b, c", for messages

 private:
  void Retire(const StreamKey& key, SubjectId subject);

  std::vector<std::unique_ptr<Subject>> subjects_;
  std::unordered_map<StreamKey, Subject*, StreamKeyHash> by_stream_;
  std::map<std::string, Subject*, std::less<>> by_name_;
  struct Retired {
    SubjectId subject = 0;
    std::uint64_t number = 0;  // of the retirements, from 1
  };
  std::map<StreamKey, Retired> retired_;
  // By number, oldest first; may name what has been forgotten or retired anew since.
  std::deque<std::pair<StreamKey, std::uint64_t>> retired_order_;
  std::uint64_t num_retired_ = 0;
  SubjectId next_id_ = 1;
  std::uint64_t version_ = 1;
};

}  // namespace furrow::server
