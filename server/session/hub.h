// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/codec/codec.h"
#include "protocol/mocap/neutral_frame.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/lane.h"
#include "server/session/lane_gates.h"
#include "server/session/recording_tap.h"
#include "server/session/subjects/publishers.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscribers.h"

namespace furrow::server {

// Everything a daemon knows of a session: its peers, its subjects, its subscriptions. Messages go
// in, links carry the answers away. No sockets, no clock: `now` comes with every call, so the whole
// of a session's life is tested without waiting.
//
// Several network threads may share it, each in a lane of its own: a peer belongs to the lane whose
// thread hears it, and is spoken for by that thread alone. Poses go through a lane while others go
// through theirs, since a subject is fed by one stream of one peer, and nothing else that they
// touch is written to. Whatever else changes the session (who offers, subscribes, leaves; the tick;
// the API) is done by one thread that is Alone; all functions see to that themselves, but those
// that say otherwise.
class Hub {
 public:
  struct Parts {
    Limits limits;
    std::uint64_t session = 1;  // random, not 0
    std::shared_ptr<const wrinkle::Rig> rig;
    character::SkeletonMatcher skeletons;          // what the joints of streams are
    const wrinkle::Skeleton* character = nullptr;  // null: nothing is drawn
    PictureSource* pictures = nullptr;             // null: nothing is drawn
    render::Settings settings;                     // of pictures that do not say otherwise
    Metrics* metrics = nullptr;
    std::function<std::uint64_t()> make_token;  // unpredictable, not 0
    // Told of every new or decayed set of weights; for OSC out. May be empty.
    // On the thread of the lane, or one that is alone, then with lane 0.
    std::function<void(const Subject&, int lane)> on_weights;
    RecordingTap* recording = nullptr;  // outlives the hub; null: nothing is recorded
    int lanes = 1;
  };
  explicit Hub(Parts parts);

  // While it lives, the calling thread is in its lane: what it does in there is published and sent
  // by the end. Turns nest. May be left in between, where something has to be done alone.
  class Turn {
   public:
    Turn(Hub& hub, int lane);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Hub& hub_;
    Lane& lane_;
  };
  // While it lives, no other thread is in the hub. From the thread of `lane`, in a turn or not;
  // what waited there is published and sent before. Nests.
  class Alone {
   public:
    Alone(Hub& hub, int lane);
    ~Alone();
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;

   private:
    Hub& hub_;
    Lane& lane_;
  };

  // Flushed at the end of whatever sends; null: nothing waits anywhere. Before the lane's thread
  // begins, or when it has ended.
  void SetOutlet(int lane, Outlet* outlet) { LaneAt(lane).outlet = outlet; }

  // By the thread of `lane`, as all that follows of the peer. `link` outlives the peer. The name is
  // for the log.
  PeerId AddPeer(Transport transport, std::string name, Link* link, Time now, int lane = 0);
  void RemovePeer(PeerId id);

  // A whole message (a TCP frame, a datagram, a reassembled one). Whatever is wrong with it is
  // counted and, where the transport allows, answered.
  void OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // The same for one of many that came together: a pose may wait for the others, to be evaluated
  // with them, until the turn ends, and so long `bytes` must stay. All that goes out, and its
  // order, is what OnMessage() makes of them one by one. In a turn of the peer's lane.
  void GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // UDP: bytes that came from the peer, fragments too; what it may be sent unproven. In a turn.
  void OnBytesReceived(PeerId id, std::size_t bytes, Time now);
  // A peer that may be forgotten: nothing subscribed, silent for Limits::idle_seconds.
  [[nodiscard]] bool IsIdle(PeerId id, Time now);
  // Of two peers of a lane, the one to forget where there are too many: the one that subscribes to
  // nothing and publishes nothing, then the longest silent. In a turn.
  [[nodiscard]] bool IsLessWorthKeeping(PeerId a, PeerId b);
  // TCP: bytes that are no frame; the connection ends after the answer.
  void OnBadFrame(PeerId id);
  // TCP: a connection beyond Limits::max_connections is told so over `link`; it never was a peer.
  void RefuseConnection(Link* link);
  // A frame of a foreign wire; `peer` was added as Transport::kMocap.
  void OnMocapFrame(PeerId peer, const protocol::mocap::NeutralFrame& frame, Time now);
  // From here on: by the thread of lane 0.
  void OnPicture(const FinishedPicture& picture);

  // Loss, decay, leases, what rates held back. Call it about every 10 ms.
  void Tick(Time now);
  // SIGTERM: everybody is told goodbye, no more subscriptions are taken.
  void Drain();

  // For whoever runs the session: what is there, and what may be changed while it runs. All by a
  // thread that is Alone, and stays so while it uses what it was given.
  [[nodiscard]] const SubjectRegistry& subjects() const { return subjects_; }
  // Looks somebody up by name (empty: who has been there longest; null: nobody), of whom all is
  // evaluated from then on, whoever subscribes to what.
  [[nodiscard]] Subject* EvaluateInFull(std::string_view name);
  // Who sends it: a peer's name, for people.
  [[nodiscard]] std::string_view SourceOf(const Subject& subject);
  [[nodiscard]] const render::Settings& own_settings() const { return subscribers_.own_settings(); }
  void SetOwnSettings(const render::Settings& settings, Time now) {
    subscribers_.SetOwnSettings(settings, now);
  }
  [[nodiscard]] const wrinkle::Rig& rig() const { return definitions_.rig(); }
  // For every subject, from now on: their poses and their subscribers stay. Errors: those of
  // RigBinding::Create for the skeleton of a subject (`where` is its name); then all stays as it
  // was.
  [[nodiscard]] Status SetRig(std::shared_ptr<const wrinkle::Rig> rig, Time now);
  // The pose that the subject's weights are measured from instead of its rest pose; none: that. One
  // that does not fit its stream changes nothing.
  void SetNeutral(Subject& subject, std::optional<wrinkle::LocalPose> neutral, Time now);
  [[nodiscard]] bool draining() const { return draining_; }

  [[nodiscard]] std::size_t num_subjects() const { return subjects_.size(); }
  [[nodiscard]] std::size_t num_subscriptions() const { return subscribers_.size(); }

 private:
  struct MocapStream {
    std::uint16_t stream = 0;
    bool refused = false;  // offered again after a while: what stood against it may be gone
    Time offered{0};
    Time heard{0};
    std::uint32_t layout = 0;
    protocol::SkeletonOffer offer;
  };

  [[nodiscard]] Lane& LaneAt(int lane) { return *lanes_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] Lane& LaneOf(PeerId id) { return *lanes_[PeerTable::TableOf(id, lanes_.size())]; }
  template <class Function>
  void ForEachPeer(const Function& function) {
    for (const auto& lane : lanes_) lane->peers.ForEach(function);
  }
  static void Flush(Lane& lane);

  void Dispatch(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now);
  void DispatchPublisher(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now);
  void DispatchSubscriber(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now);
  template <class Request>
  void OnSubscribe(Lane& lane, Peer& peer, const protocol::MessageView& view, Request& request);
  template <class Message, class Handler>
  void Decoded(Lane& lane, Peer& peer, const protocol::MessageView& view, Message& message,
               Handler handler);
  void RefuseEnvelope(Lane& lane, Peer& peer, const protocol::MessageView& view,
                      protocol::DecodeStatus status);
  void OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello);
  MocapStream* FindOrAddMocap(const Peer& peer, const std::string& subject);
  bool OfferMocap(Peer& peer, const protocol::Header& header, MocapStream& stream,
                  const protocol::mocap::NeutralFrame& frame, Time now);
  void ForgetRefusedMocap(Time now);
  bool OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
               Time now);
  void OnPose(Lane& lane, Peer& peer, const protocol::Header& header,
              const protocol::PoseFrame& pose, std::span<const std::uint8_t> payload, Time now);
  // Evaluates the poses that wait, and publishes them in the order in which they came.
  void PublishGathered(Lane& lane);
  void Weighted(Lane& lane, Subject& subject, std::span<const std::uint8_t> pose,
                std::int64_t age_us, Time now);
  void RemoveGone(Time now);
  void Reweighted(Subject& subject, Time now);
  void OnListSubjects(Peer& peer, const protocol::Header& header,
                      const protocol::ListSubjects& request);
  void SendList(Peer& peer, const protocol::Header& request);
  bool RefusedWhileDraining(Peer& peer, const protocol::Header& header);

  const Limits limits_;
  Metrics* const metrics_;
  const std::function<std::uint64_t()> make_token_;
  const std::function<void(const Subject&, int)> on_weights_;
  RecordingTap* const recording_;
  LaneGates gates_;
  const std::vector<std::unique_ptr<Lane>> lanes_;
  Desk desk_;  // of whoever is alone
  Postman& postman_;
  StreamDefinitions definitions_;
  SubjectRegistry subjects_;
  Publishers publishers_;
  Subscribers subscribers_;
  std::map<std::pair<PeerId, std::string>, MocapStream> mocap_streams_;
  std::uint16_t next_mocap_stream_ = 0;
  bool draining_ = false;
};

}  // namespace furrow::server
