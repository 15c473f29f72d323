// SPDX-License-Identifier: Apache-2.0
// The part of Hub that hands messages out, and answers what is of no subject.
#include <string>

#include "protocol/messages/limits.h"
#include "server/session/hub.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::ErrorCode;
using protocol::MessageKind;

constexpr char kServerName[] = "furrowd " FURROW_VERSION;

}  // namespace

void Hub::OnBadFrame(PeerId id) {
  Lane& lane = LaneOf(id);
  const Turn turn(*this, lane.index);
  if (Peer* peer = lane.peers.Find(id); peer != nullptr) {
    lane.desk.postman.Error(*peer, {}, ErrorCode::kMalformed,
                            "a frame is 32 to " + std::to_string(protocol::kMaxRequestBytes) +
                                " bytes long, after its length as u32, little-endian");
  }
}

void Hub::RefuseConnection(Link* link) {
  const Turn turn(*this, 0);
  Peer nobody;
  nobody.link = link;
  LaneAt(0).desk.postman.Error(nobody, {}, ErrorCode::kLimit,
                               "at most " + std::to_string(limits_.max_connections) +
                                   " connections, see limits.max_connections");
}

void Hub::RefuseEnvelope(Lane& lane, Peer& peer, const protocol::MessageView& view,
                         DecodeStatus status) {
  metrics_->Add(Counter::kMessagesMalformed);
  if (peer.transport == Transport::kUdp) return;
  ErrorCode code = ErrorCode::kMalformed;
  if (status == DecodeStatus::kBadVersion) code = ErrorCode::kUnsupportedVersion;
  if (status == DecodeStatus::kUnknownKind) code = ErrorCode::kUnsupported;
  lane.desk.postman.Error(peer, view.header, code,
                          "not a message of this wire: " + std::string(DecodeStatusName(status)));
}

template <class Message, class Handler>
void Hub::Decoded(Lane& lane, Peer& peer, const protocol::MessageView& view, Message& message,
                  Handler handler) {
  const DecodeStatus status = protocol::Decode(view, message);
  if (status == DecodeStatus::kOk) {
    handler();
    return;
  }
  metrics_->Add(view.kind == MessageKind::kPose ? Counter::kPosesInvalid
                                                : Counter::kMessagesMalformed);
  if (peer.transport != Transport::kUdp) {
    PublishGathered(lane);
    lane.desk.postman.Error(peer, view.header, ErrorCode::kMalformed,
                            std::string(MessageKindName(view.kind)) +
                                " cannot be read: " + std::string(DecodeStatusName(status)));
  }
}

template <class Request>
void Hub::OnSubscribe(Lane& lane, Peer& peer, const protocol::MessageView& view, Request& request) {
  Decoded(lane, peer, view, request, [&] {
    if (RefusedWhileDraining(peer, view.header)) return;
    subscribers_.Subscribe(peer, view.header, request);
  });
}

// Poses, and what they have the time for that are at it; the rest is done alone.
void Hub::Dispatch(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now) {
  const protocol::Header& header = view.header;
  Lane::Incoming& in = lane.in;
  switch (view.kind) {
    case MessageKind::kPose:
      return Decoded(lane, peer, view, in.pose, [&] {
        const auto payload = in.pose.partial ? std::span<const std::uint8_t>() : view.payload;
        OnPose(lane, peer, header, in.pose, payload, now);
      });
    case MessageKind::kPing:
      return Decoded(lane, peer, view, in.ping, [&] {
        lane.desk.postman.Reply(peer, Postman::Answering(header),
                                protocol::Pong{in.ping.time_us, ToMicroseconds(now)});
      });
    case MessageKind::kPong:
      return Decoded(lane, peer, view, in.pong, [] {});  // heard: that is all it is for
    default: {
      const Alone alone(*this, lane.index);
      return DispatchPublisher(lane, peer, view, now);
    }
  }
}

// What publishers say, and what everybody may; the rest is of subscribers.
void Hub::DispatchPublisher(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now) {
  const protocol::Header& header = view.header;
  Lane::Incoming& in = lane.in;
  switch (view.kind) {
    case MessageKind::kSkeletonOffer:
      return Decoded(lane, peer, view, in.offer,
                     [&] { (void)OnOffer(peer, header, in.offer, now); });
    case MessageKind::kHello:
      return Decoded(lane, peer, view, in.hello, [&] { OnHello(peer, header, in.hello); });
    case MessageKind::kGoodbye:
      return Decoded(lane, peer, view, in.goodbye,
                     [&] { publishers_.OnGoodbye(peer, header, now); });
    default: DispatchSubscriber(lane, peer, view, now);
  }
}

void Hub::DispatchSubscriber(Lane& lane, Peer& peer, const protocol::MessageView& view, Time now) {
  const protocol::Header& header = view.header;
  Lane::Incoming& in = lane.in;
  switch (view.kind) {
    case MessageKind::kSubscribeWeights: return OnSubscribe(lane, peer, view, in.subscribe_weights);
    case MessageKind::kSubscribePictures:
      return OnSubscribe(lane, peer, view, in.subscribe_pictures);
    case MessageKind::kSubscribePoses: return OnSubscribe(lane, peer, view, in.subscribe_poses);
    case MessageKind::kUpdatePictures:
      return Decoded(lane, peer, view, in.update_pictures,
                     [&] { subscribers_.Update(peer, header, in.update_pictures.pictures, now); });
    case MessageKind::kFrameAck:
      return Decoded(lane, peer, view, in.frame_ack,
                     [&] { subscribers_.Acknowledge(peer, header, in.frame_ack.number, now); });
    case MessageKind::kUnsubscribe:
      return Decoded(lane, peer, view, in.unsubscribe,
                     [&] { subscribers_.Unsubscribe(peer, header.stream); });
    case MessageKind::kListSubjects:
      return Decoded(lane, peer, view, in.list_subjects,
                     [&] { OnListSubjects(peer, header, in.list_subjects); });
    default:
      postman_.Error(peer, header, ErrorCode::kUnsupported,
                     std::string(MessageKindName(view.kind)) + " is what a daemon sends");
  }
}

void Hub::OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello) {
  protocol::Welcome welcome{kServerName, 0};
  if (peer.transport == Transport::kUdp) {
    const bool proves = hello.token != 0 && hello.token == peer.token;
    if (proves) peer.credit.Prove();
    // Nobody else can make a peer be sent what it may not understand.
    if (proves || !hello.bundles) peer.link->TakesBundles(hello.bundles);
    if (!peer.credit.proven()) {
      if (peer.token == 0) peer.token = make_token_();
      welcome.token = peer.token;
    }
  }
  postman_.Reply(peer, Postman::Answering(header), welcome);
}

void Hub::OnListSubjects(Peer& peer, const protocol::Header& header,
                         const protocol::ListSubjects& request) {
  if (peer.transport == Transport::kUdp) {
    return postman_.Error(peer, header, ErrorCode::kNeedsTcp, "subjects are listed over TCP");
  }
  peer.follows_list.reset();
  if (request.follow) peer.follows_list = header;
  SendList(peer, header);
}

void Hub::SendList(Peer& peer, const protocol::Header& request) {
  protocol::Subjects list;
  list.total = static_cast<std::uint32_t>(subjects_.size());
  for (const auto& subject : subjects_.all()) {
    if (list.names.size() == protocol::kMaxListedSubjects) break;
    list.names.push_back(subject->name);
  }
  peer.listed = subjects_.version();
  postman_.Reply(peer, {.sequence = request.sequence}, list);
}

// A stream that ends here, or a subscription: streams are looked for first.
bool Hub::RefusedWhileDraining(Peer& peer, const protocol::Header& header) {
  if (draining_) postman_.Error(peer, header, ErrorCode::kDraining, "the daemon is shutting down");
  return draining_;
}

}  // namespace furrow::server
