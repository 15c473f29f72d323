// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "protocol/mocap/neutral_frame.h"
#include "render/settings/settings.h"
#include "rig/skeleton_match.h"
#include "server/cluster/coordinator.h"
#include "server/core/jitter_rule.h"
#include "server/core/limits.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/stream_definition.h"
#include "server/saved/saved_state.h"
#include "server/session/access/token_gate.h"
#include "server/session/delivery/publish_context.h"
#include "server/session/departures.h"
#include "server/session/dispatcher.h"
#include "server/session/live_rig.h"
#include "server/session/mocap_streams.h"
#include "server/session/peers/address_proof.h"
#include "server/session/recording_tap.h"
#include "server/session/restart.h"
#include "server/session/shards.h"
#include "server/session/stream_router.h"
#include "server/session/subjects/arrivals.h"
#include "server/session/subjects/places.h"
#include "server/session/subjects/publishers.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"
#include "server/session/trace/pose_tracer.h"

namespace furrow::server {

// The session of a daemon: its peers, subjects and subscriptions. Messages arrive through
// OnMessage() and leave through each peer's Link. The hub has no sockets and no clock: the time is
// an argument of each call, so tests run a session without waiting.
//
// Several network threads may share a hub. Each has its own shard: a peer belongs to the shard
// whose thread reads its messages, and only that thread calls functions for the peer. Poses need
// only the lock of their shard, because one stream of one peer feeds a subject. All other changes
// (offers, subscriptions, removals, the tick, the HTTP API) need the exclusive lock. Every function
// takes the lock that it needs unless its comment says otherwise.
class Hub {
 public:
  struct Parts {
    Limits limits;
    std::vector<JitterRule> jitter;  // jitter buffers; later rules come first
    std::uint64_t session = 1;       // random, not 0
    std::shared_ptr<const wrinkle::Rig> rig;
    rig::SkeletonMatcher skeletons;   // finds the rig's joints in foreign skeletons
    rig::ShapeMatcher shape_matcher;  // finds the rig's blend shapes by other names
    StreamCharacter character;
    PictureSource* pictures = nullptr;  // null: render nothing
    render::Settings settings;          // defaults for all pictures
    Metrics* metrics = nullptr;
    std::function<std::uint64_t()> random;  // returns unpredictable numbers, never 0
    RecordingTap* recording = nullptr;      // optional; outlives the hub
    const TokenGate* gate = nullptr;        // outlives the hub; null: everybody may do everything
    std::function<Time()> clock;            // read for traced poses alone; empty: traces nothing
    Coordinator* cluster = nullptr;         // outlives the hub; null: the daemon is alone
    int shards = 1;                         // one per network thread
    // Answers Drain. Called on any shard's thread, under the exclusive lock. Empty: not possible.
    std::function<protocol::DrainState(bool begin)> drain;
    // True for the numeric addresses of this computer. Empty: it has none.
    std::function<bool(const std::string& address)> is_own_address;
  };
  explicit Hub(Parts parts);

  // What a UDP server needs to meet addresses that are not peers yet. Safe on several threads.
  [[nodiscard]] const AddressProof& address_proof() const { return address_proof_; }
  [[nodiscard]] std::uint64_t session() const { return session_; }

  // Locks the calling thread's shard. The end of the outermost lock publishes the gathered poses
  // and sends the buffered messages. Nests.
  class ShardLock : public Shards::Lock {
   public:
    ShardLock(Hub& hub, int shard) : Shards::Lock(hub.shards_, shard) {}
  };
  // Locks the whole hub. `shard`: the calling thread's. Nests, also inside a ShardLock.
  class ExclusiveLock : public Shards::ExclusiveLock {
   public:
    ExclusiveLock(Hub& hub, int shard) : Shards::ExclusiveLock(hub.shards_, shard) {}
  };

  // `sender` is flushed at the end of each lock; null: nothing to flush. Call it before the shard's
  // thread starts or after that thread has ended.
  void SetBufferedSender(int shard, BufferedSender* sender) {
    shards_.at(shard).buffered_sender = sender;
  }

  // The poses whose weights the shard's sender has got since the last call, for its Flush(), which
  // empties the list.
  [[nodiscard]] std::vector<Shard::Published>& published(int shard) {
    return shards_.at(shard).published;
  }

  // Called by the shard's thread, like all functions with a PeerId. `link` outlives the peer.
  // A UDP peer must have proved its address (Reception), or its token by a secure session.
  // `access`: what the peer may do; none: what those may do who have shown nothing
  // (TokenGate::Stranger()), or everything for parts of the daemon itself (Transport::kMocap).
  PeerId AddPeer(Transport transport, PeerLabel name, Link* link, Time now, int shard = 0,
                 std::optional<Access> access = {});
  // The peer has shown a newer token. Subscriptions that it does not allow end, and so do subjects.
  // Requires the shard's lock.
  void SetAccess(PeerId id, const Access& access);
  // Ends the peer's subscriptions and forgets the peer. Subjects that it publishes are not removed
  // at once: without poses they decay, then leave.
  void RemovePeer(PeerId id);

  // Handles one whole message: a TCP frame, a datagram or a reassembled message. Errors are counted
  // and, if the transport allows it, answered.
  void OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // Handles one message of a batch. Unlike OnMessage(), it may delay a pose until the shard lock
  // ends, so that many poses are solved together; `bytes` must stay valid until then. The output
  // and its order are those of OnMessage(). Requires the shard's lock.
  void GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // The same for a peer that the caller has looked up with FindPeer().
  void GatherMessage(Peer& peer, std::span<const std::uint8_t> bytes, Time now);
  // The peer, which only the thread of its shard may use, until RemovePeer(). Null: it is not
  // there.
  [[nodiscard]] Peer* FindPeer(PeerId id) { return shards_.FindPeer(id); }
  // UDP: the consent of a peer, for the program that uses its address next. Require the shard's
  // lock.
  [[nodiscard]] std::optional<Consent> ConsentOf(PeerId id);
  void SetConsent(PeerId id, const Consent& consent);
  // UDP: records that a part of a message arrived. Requires the shard's lock.
  void OnFragment(PeerId id, Time now);
  // True if the peer may be forgotten: no subscriptions, and silent for Limits::idle_seconds, or
  // for kStrangerPatience if it must show a token and has not; or its token has ended.
  [[nodiscard]] bool IsIdle(PeerId id, Time now);
  static constexpr Time kStrangerPatience = std::chrono::seconds(5);
  // True if peers may do nothing before they have shown a token.
  [[nodiscard]] bool RequiresToken() const { return gate_ != nullptr && gate_->required(); }
  // TCP: answers a frame with an invalid length. The caller closes the connection afterwards.
  void OnBadFrame(PeerId id);
  // TCP: answers a connection that never becomes a peer.
  void RefuseConnection(Link* link, protocol::ErrorCode code, const std::string& why);
  // TCP and web: ends the connection that has had no use for longest, so that a newcomer finds a
  // place: one of `host`, or, if `any_host`, of any host. It gets an error first. Those that have
  // shown no token to a daemon that requires one go first. False: all are in use. Connections have
  // no use while they wait for absent subjects, or if they neither watched nor published anything
  // for kUnusedPatience. Only the thread of shard 0 calls it.
  [[nodiscard]] bool MakeRoom(Transport transport, const std::string& host, bool any_host,
                              Time now);
  static constexpr Time kUnusedPatience = std::chrono::seconds(2);
  // Handles a frame of a foreign motion-capture protocol. The peer was added to shard 0 as
  // Transport::kMocap.
  void OnMocapFrame(PeerId id, const protocol::mocap::NeutralFrame& frame, Time now);

  // True if subjects may have jitter buffers. The thread of each shard must then call ReleaseHeld()
  // every few milliseconds, which publishes the poses that have waited long enough.
  [[nodiscard]] bool HoldsPoses() const { return holds_poses_; }
  void ReleaseHeld(int shard, Time now);
  // When the thread of the shard must call ReleaseHeld() next because a pose waits for an earlier
  // one; nothing if none waits. Only datagrams make poses wait. Requires the shard's lock.
  [[nodiscard]] std::optional<Time> NextAhead(int shard) {
    return shards_.at(shard).held.NextAhead();
  }

  // Only the thread of shard 0 calls the functions from here on.

  // Sends a finished picture to its viewers.
  void OnPicture(const FinishedPicture& picture, Time now);
  // Handles lost and decaying subjects, leases, and frames held back by rates. Call it about every
  // 10 ms. `late`: how long after its time the call comes. From kStall on, the daemon did not run,
  // and that time does not count as silence of subjects and peers.
  void Tick(Time now, Time late = Time{0});
  static constexpr Time kStall = std::chrono::milliseconds(100);
  // Says goodbye to all peers and refuses new subscriptions. Call it on SIGTERM. In a cluster,
  // sends publishers and subscribers to other nodes first.
  void Drain(Time now);

  // The functions of a move to another node. Each takes the exclusive lock.

  // Takes no new subject from now on. Those that are here stay until they are handed over or leave.
  void TakeNothingNew();
  // The names of the subjects that are here.
  [[nodiscard]] std::vector<std::string> SubjectNames();
  // The node that should get the subject, but none of `without`; kNowhere with the reason: none
  // can, or the subject must stay.
  [[nodiscard]] Place SuccessorOf(std::string_view subject, Time now,
                                  const std::set<std::string>& without = {});
  // Writes the subject's state as a message (SubjectState) to `message`. `number`: which the answer
  // repeats. False: there is no such subject.
  [[nodiscard]] bool WriteState(std::string_view subject, std::uint32_t number,
                                std::vector<std::uint8_t>& message);
  // The node goes on with the subject: sends its publisher and its subscribers there and forgets
  // it. Writes the last state, as WriteState() does. Errors: kNotFound, there is no such subject;
  // kUnavailable, it must stay for now.
  [[nodiscard]] Status HandOver(std::string_view subject, const NodeAddress& node,
                                std::uint32_t number, std::vector<std::uint8_t>& message, Time now);

  // The functions of a restart (server/saved). Each takes the exclusive lock.

  // False: the peer cannot go to the next daemon, because it watches pictures or was not admitted.
  [[nodiscard]] bool MaySavePeer(PeerId id);
  // Saves a peer for the next daemon; Drain() says no goodbye to it then. Nothing: it cannot go
  // there.
  [[nodiscard]] std::optional<SavedPeer> SavePeer(PeerId id);
  // Takes back all peers that were saved: Drain() says goodbye to them.
  void KeepPeers();
  // Saves all subjects for the next daemon. Poses that wait for their time are used before.
  [[nodiscard]] std::vector<SavedSubject> SaveSubjects(Time now);
  // Peers of the former daemon that are here: their present numbers, and what was saved of them,
  // by the numbers that they had there.
  struct ResumedPeer {
    PeerId id = 0;
    const SavedPeer* saved = nullptr;
  };
  using ResumedPeers = std::map<std::uint64_t, ResumedPeer>;
  // Goes on with what the former daemon has saved. `away`: the time since then.
  void Resume(const std::vector<SavedSubject>& subjects, const ResumedPeers& peers, Time away,
              Time now);

  // The functions below require the exclusive lock, and so does every use of the objects that they
  // return.

  [[nodiscard]] const SubjectRegistry& subjects() const { return subjects_; }
  // Null: no such subject.
  [[nodiscard]] Subject* FindSubject(std::string_view name) { return subjects_.Find(name); }
  // Finds a subject by name (empty: the oldest) that `access` is for, and evaluates all of
  // its drivers from now on. Null: no such subject.
  [[nodiscard]] Subject* RequireAllDrivers(std::string_view name,
                                           const Access& access = Access::Everything());
  // Follows the next pose of a subject, found as by RequireAllDrivers(). Replaces the trace before.
  // Null: no such subject.
  const Subject* Trace(std::string_view name, const Access& access = Access::Everything());
  // The last trace that was asked for; null: the hub has no clock.
  [[nodiscard]] const PoseTracer* tracer() const { return tracer_.get(); }
  // The name of the peer that publishes the subject, for people; empty if the peer has left.
  [[nodiscard]] std::string_view SourceOf(const Subject& subject);
  // Why a request for pictures of a client with this access would be refused; nothing: it would
  // not, unless the client has too many subscriptions.
  [[nodiscard]] std::optional<protocol::ErrorMessage> WhyNoPictures(
      const protocol::SubscribePictures& request, const Access& access) {
    if (!draining_) return subscribers_.WhyNoPictures(request, access);
    return protocol::ErrorMessage{protocol::ErrorCode::kDraining, "the daemon is shutting down"};
  }
  [[nodiscard]] const render::Settings& own_settings() const { return subscribers_.own_settings(); }
  // Replaces the daemon's settings for pictures and sends every changed view again.
  void SetOwnSettings(const render::Settings& settings, Time now) {
    subscribers_.SetOwnSettings(settings, now);
  }
  [[nodiscard]] const wrinkle::Rig& rig() const { return definitions_.rig(); }
  // Replaces the rig for all subjects. Poses and subscriptions stay. Errors: those of
  // RigBinding::Create() for a subject's skeleton, with the subject's name as `where`; the old rig
  // then stays in use.
  [[nodiscard]] Status SetRig(std::shared_ptr<const wrinkle::Rig> rig, Time now) {
    return live_rig_.Set(std::move(rig), now);
  }
  // The same, and replaces the maps that find the rig's joints and blend shapes.
  [[nodiscard]] Status SetRigAndMaps(std::shared_ptr<const wrinkle::Rig> rig, StreamMaps maps,
                                     Time now) {
    return live_rig_.SetWithMaps(std::move(rig), std::move(maps), now);
  }
  [[nodiscard]] const std::shared_ptr<const wrinkle::Rig>& shared_rig() const {
    return definitions_.shared_rig();
  }
  // At most this many reference poses come to the rig by captures, here or on the way here: every
  // solve of every subject evaluates them.
  static constexpr int kMaxAddedPoses = 32;
  [[nodiscard]] int num_added_poses() const { return live_rig_.num_added_poses(); }
  void AddToAddedPoses(int number) { live_rig_.AddToAddedPoses(number); }
  // How often the rig changed other than by SetRig(): by SetRigAndMaps(), which also removes the
  // captured poses, or by captures of subjects that came from other nodes.
  [[nodiscard]] std::uint64_t num_rig_replacements() const { return live_rig_.num_replacements(); }
  // True if the rig is not the one of the daemon's files.
  [[nodiscard]] bool has_captured_rig() const { return live_rig_.has_captures(); }
  // Replaces the limits. Whatever exceeds them already stays. The rate of messages counts for peers
  // that come from now on; max_udp_peers is not the hub's.
  void SetLimits(const Limits& limits);
  // Measures the subject's weights from this pose instead of the rest pose; nullopt: from the rest
  // pose. A pose with other joint or blend-shape counts is ignored.
  void SetNeutral(Subject& subject, std::optional<wrinkle::LocalPose> neutral, Time now) {
    live_rig_.SetNeutral(subject, std::move(neutral), now);
  }
  // Calls `on_weights` with each subject's new weights, for OSC output; empty: calls nobody, as at
  // first. With a function, all drivers of all subjects are evaluated. Requires the exclusive lock.
  void SetOnWeights(OnWeights on_weights);

  [[nodiscard]] bool draining() const { return draining_; }
  [[nodiscard]] std::size_t num_subjects() const { return subjects_.size(); }
  [[nodiscard]] std::size_t num_subscriptions() const { return subscribers_.size(); }

 private:
  [[nodiscard]] static bool HasNoUse(const Peer& peer, Time now);
  void OnStall(Time now, Time length);
  void AgeSubjects(Time now);
  void RemoveSubject(Subject& subject);
  [[nodiscard]] Subject* FindFor(std::string_view name, const Access& access);
  void RefreshPlaces(Time now);
  void FreeLevels(Time now);
  void RenewConsent(Peer& peer, Time now);
  void EndIfTokenEnded(Peer& peer, Time now);

  Limits limits_;  // the parts refer to it; changes under the exclusive lock
  const std::uint64_t session_;
  Metrics* const metrics_;
  const std::function<std::uint64_t()> random_;
  const AddressProof address_proof_;
  RecordingTap* const recording_;
  const TokenGate* const gate_;
  const std::unique_ptr<PoseTracer> tracer_;  // null: traces nothing
  PublishContext exclusive_context_;
  StreamDefinitions definitions_;
  SubjectRegistry subjects_;
  Places places_;
  Arrivals arrivals_;
  Time places_refreshed_{0};
  Publishers publishers_;
  Subscribers subscribers_;
  StreamRouter router_;
  Shards shards_;
  Dispatcher dispatcher_;
  MocapStreams mocap_;
  LiveRig live_rig_;
  Departures departures_;
  Restart restart_;
  const bool holds_poses_;
  bool draining_ = false;
};

}  // namespace furrow::server
