// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/time/timecode.h"
#include "protocol/framing/sequence.h"
#include "protocol/messages/messages.h"
#include "server/core/capture_clock.h"
#include "server/core/time.h"
#include "server/pipeline/subject_pipeline.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/rest_detector.h"
#include "server/session/subjects/subject_stats.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// Identifies a stream: the peer, the random session number of its current run, and its number for
// the subject.
struct StreamKey {
  PeerId peer = 0;
  std::uint64_t session = 0;
  std::uint16_t stream = 0;
  friend auto operator<=>(const StreamKey&, const StreamKey&) = default;
};

// The session number is random, so mixing in the other two needs little care.
struct StreamKeyHash {
  std::size_t operator()(const StreamKey& key) const {
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
    return (key.session ^ (key.peer * kOdd)) + key.stream * (kOdd >> 7 | 1);
  }
};

struct Subscription;

using SubjectId = std::uint64_t;  // unique for the life of the daemon; 0: no subject

// A captured performer: a name, the stream that feeds it now, and its pipeline to wrinkle weights.
struct Subject {
  SubjectId id = 0;
  std::string name;
  StreamKey owner;
  std::string host;                 // PeerLabel::host of the first owner, whose share it counts to
  std::uint64_t run = 0;            // an unpredictable number for each session that feeds it
  std::uint64_t skeleton_hash = 0;  // of the owner's offer
  // The owner's offer without the subject name, shared by all subjects with an equal offer.
  std::shared_ptr<const protocol::SkeletonOffer> offer;
  protocol::SequenceWindow window;
  std::unique_ptr<SubjectPipeline> pipeline;  // not null
  // Those that are bound to it, in the order in which they came (SubscriptionTable).
  std::vector<Subscription*> subscriptions;
  Time served_until{Time::max()};    // in a cluster: the end of this node's right to serve it
  std::uint64_t epoch = 0;           // of that right; 0 without a cluster
  Time hold{0};                      // delay of its jitter buffer; 0: none
  Time last_pose{0};                 // arrival, or release from the jitter buffer
  Time last_update{0};               // arrival or decay
  Time last_no_face{0};              // arrival of the last frame without a face
  Time skipped_at{0};                // when a pose was used before an earlier one
  Time reorders_until{0};            // until then, poses wait for earlier ones
  bool reorders = false;             // its transport may deliver poses in another order
  bool no_face = false;              // the publisher sends, but its tracker sees no face
  bool ended = false;                // the publisher said goodbye: the subject decays, then leaves
  bool lost = false;                 // no pose for Limits::loss_seconds: the subject decays
  bool can_move = false;             // the owner's session number is a secret that proves who it is
  bool orphaned = false;             // its publisher's connection has closed
  Time level_kept_until{0};          // after a move: when keeps_level ends
  bool keeps_level = false;          // no driver is switched off
  bool needs_all_drivers = false;    // evaluate all drivers, not only subscribed ones
  std::set<std::string> captures;    // reference poses of the rig that were captured from it
  std::optional<Timecode> timecode;  // of the last solved pose; absent: it had none
  SubjectStats stats;
  CaptureClock capture_clock;  // for the lateness of its poses
  RestDetector rest;           // updated only while a viewer uses flow control
};

// All subjects of a daemon, by name and by the stream that feeds them, in order of arrival.
class SubjectRegistry {
 public:
  explicit SubjectRegistry(std::size_t max_subjects) : shares_(max_subjects) {}

  // The subject with this name, id or stream; null if there is none. Its address is stable until
  // Remove().
  [[nodiscard]] Subject* Find(std::string_view name);
  [[nodiscard]] Subject* Find(SubjectId id);
  [[nodiscard]] Subject* Find(const StreamKey& key);
  // The oldest subject that `access` is for; null if there is none.
  [[nodiscard]] Subject* First(const Access& access) const;

  // Subjects that are there stay, even if they are more.
  void SetMaxSubjects(std::size_t max_subjects) { shares_.SetPlaces(max_subjects); }
  // True if Add() may be called for the host (FairShare).
  [[nodiscard]] bool HasRoomFor(const std::string& host) const { return shares_.HasRoomFor(host); }
  // Preconditions: there is no subject of this name, HasRoomFor(host), and `pipeline` is not null.
  // Without memory, throws std::bad_alloc and changes nothing.
  Subject& Add(std::string name, std::string host, std::unique_ptr<SubjectPipeline> pipeline,
               Time now);
  // Makes `key` the stream that feeds `subject`. Without memory, throws std::bad_alloc and changes
  // nothing.
  void SetOwner(Subject& subject, const StreamKey& key);
  // Detaches the subject from its stream; the subject stays.
  void Release(Subject& subject);

  void Remove(SubjectId id);
  // Marks the subjects of a peer that has left as orphaned.
  void ForgetPeer(PeerId peer);

  [[nodiscard]] std::size_t size() const { return subjects_.size(); }
  // Changes whenever a subject is added or removed; never 0.
  [[nodiscard]] std::uint64_t version() const { return version_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Subject>>& all() const { return subjects_; }
  // The first few that `access` is for, for messages: "ann, bob".
  [[nodiscard]] std::string Names(const Access& access) const;

 private:
  FairShare shares_;
  std::vector<std::unique_ptr<Subject>> subjects_;
  std::unordered_map<StreamKey, Subject*, StreamKeyHash> by_stream_;
  std::map<std::string, Subject*, std::less<>> by_name_;
  SubjectId next_id_ = 1;
  std::uint64_t version_ = 1;
};

}  // namespace furrow::server
