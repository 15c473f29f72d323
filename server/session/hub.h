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

#include "protocol/codec.h"
#include "protocol/mocap/neutral_frame.h"
#include "server/config.h"
#include "server/metrics.h"
#include "server/pipeline/picture_source.h"
#include "server/pipeline/stream_definition.h"
#include "server/session/peer_table.h"
#include "server/session/pose_batch.h"
#include "server/session/postman.h"
#include "server/session/publishers.h"
#include "server/session/recording_tap.h"
#include "server/session/subject_registry.h"
#include "server/session/subscribers.h"

namespace furrow::server {

// Everything one network thread knows: its peers, its subjects, its subscriptions. Messages go in,
// links carry the answers away. No sockets, no clock: `now` comes with every call, so the whole of
// a session's life is tested without waiting.
//
// One hub lives on one thread. Sharding by subject is a matter of several hubs, each with its own
// io_context: a stream's offer names its subject, so the acceptor hands the stream to the hub that
// hash(subject) picks, and subscriptions are posted to the hub of the subject they name. Nothing in
// here is shared but the StreamDefinition objects, which are immutable.
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
    std::function<void(const Subject&)> on_weights;
    RecordingTap* recording = nullptr;  // outlives the hub; null: nothing is recorded
  };
  explicit Hub(Parts parts);

  // `link` outlives the peer. The name is for the log.
  PeerId AddPeer(Transport transport, std::string name, Link* link, Time now);
  void RemovePeer(PeerId id);

  // A whole message (a TCP frame, a datagram, a reassembled one). Whatever is wrong with it is
  // counted and, where the transport allows, answered.
  void OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // The same for one of many that came together: a pose may wait for the others, to be evaluated
  // with them, until PublishGathered(), and so long `bytes` must stay. All that goes out, and its
  // order, is what OnMessage() makes of them one by one.
  void GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now);
  // Evaluates the poses that wait, and publishes them in the order in which they came.
  void PublishGathered();
  // UDP: bytes that came from the peer, fragments too; what it may be sent unproven.
  void OnBytesReceived(PeerId id, std::size_t bytes, Time now);
  // TCP: bytes that are no frame; the connection ends after the answer.
  void OnBadFrame(PeerId id);
  // TCP: a connection beyond Limits::max_connections is told so over `link`; it never was a peer.
  void RefuseConnection(Link* link);
  // A frame of a foreign wire; `peer` was added as Transport::kMocap.
  void OnMocapFrame(PeerId peer, const protocol::mocap::NeutralFrame& frame, Time now);
  void OnPicture(const FinishedPicture& picture) { subscribers_.OnPicture(picture); }

  // Loss, decay, leases, what rates held back. Call it about every 10 ms.
  void Tick(Time now);
  // SIGTERM: everybody is told goodbye, no more subscriptions are taken.
  void Drain();

  // A peer that may be forgotten: nothing subscribed, silent for Limits::idle_seconds.
  [[nodiscard]] bool IsIdle(PeerId id, Time now);
  // Of two peers, the one to forget where there are too many: the one that subscribes to nothing
  // and publishes nothing, then the longest silent.
  [[nodiscard]] bool IsLessWorthKeeping(PeerId a, PeerId b);

  // For whoever runs the session: what is there, and what may be changed while it runs.
  [[nodiscard]] const SubjectRegistry& subjects() const { return subjects_; }
  // Null: nobody of that name. Empty: who has been there longest. Who is looked up is evaluated in
  // full from then on, whoever subscribes to what.
  [[nodiscard]] Subject* FindSubject(std::string_view name);
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

  void Dispatch(Peer& peer, const protocol::MessageView& view, Time now);
  void DispatchSubscriber(Peer& peer, const protocol::MessageView& view, Time now);
  template <class Request>
  void OnSubscribe(Peer& peer, const protocol::MessageView& view, Request& request);
  template <class Message, class Handler>
  void Decoded(Peer& peer, const protocol::MessageView& view, Message& message, Handler handler);
  void RefuseEnvelope(Peer& peer, const protocol::MessageView& view, protocol::DecodeStatus status);
  void OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello);
  MocapStream* FindOrAddMocap(const Peer& peer, const std::string& subject);
  bool OfferMocap(Peer& peer, const protocol::Header& header, MocapStream& stream,
                  const protocol::mocap::NeutralFrame& frame, Time now);
  void ForgetRefusedMocap(Time now);
  bool OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
               Time now);
  void OnPose(Peer& peer, const protocol::Header& header, const protocol::PoseFrame& pose,
              std::span<const std::uint8_t> payload, Time now);
  void Weighted(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us,
                Time now);
  void Reweighted(Subject& subject, Time now);
  void OnListSubjects(Peer& peer, const protocol::Header& header,
                      const protocol::ListSubjects& request);
  void SendList(Peer& peer, const protocol::Header& request);
  bool RefusedWhileDraining(Peer& peer, const protocol::Header& header);

  const Limits limits_;
  Metrics* const metrics_;
  const std::function<std::uint64_t()> make_token_;
  const std::function<void(const Subject&)> on_weights_;
  RecordingTap* const recording_;
  Postman postman_;
  PeerTable peers_;
  StreamDefinitions definitions_;
  SubjectRegistry subjects_;
  Publishers publishers_;
  Subscribers subscribers_;
  PoseBatch gathered_;
  std::map<std::pair<PeerId, std::string>, MocapStream> mocap_streams_;
  std::uint16_t next_mocap_stream_ = 0;
  bool draining_ = false;

  // Decoded into again and again, so that the packet path does not allocate.
  struct Scratch {
    protocol::Hello hello;
    protocol::Ping ping;
    protocol::Pong pong;
    protocol::Goodbye goodbye;
    protocol::SkeletonOffer offer;
    protocol::PoseFrame pose;
    protocol::SubscribeWeights subscribe_weights;
    protocol::SubscribePictures subscribe_pictures;
    protocol::SubscribePoses subscribe_poses;
    protocol::UpdatePictures update_pictures;
    protocol::FrameAck frame_ack;
    protocol::Unsubscribe unsubscribe;
    protocol::ListSubjects list_subjects;
  } scratch_;
};

}  // namespace furrow::server
