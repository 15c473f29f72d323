// SPDX-License-Identifier: Apache-2.0
#include "server/session/dispatcher.h"

#include <string>

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::ErrorCode;
using protocol::MessageKind;

constexpr char kServerName[] = "furrowd " FURROW_VERSION;

}  // namespace

void Dispatcher::Dispatch(Shard& shard, Peer& peer, std::span<const std::uint8_t> bytes, Time now) {
  protocol::MessageView view;
  const DecodeStatus status = protocol::OpenMessage(bytes, view);
  // Anything but a pose may observe or change the session, so the poses before it come first.
  if (status != DecodeStatus::kOk || view.kind != MessageKind::kPose) {
    parts_.router->PublishGathered(shard);
  }
  if (status == DecodeStatus::kOk) {
    DispatchVerified(shard, peer, view, now);
  } else {
    RejectEnvelope(shard, peer, view, status);
  }
}

void Dispatcher::RejectEnvelope(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                DecodeStatus status) {
  parts_.metrics->Add(Counter::kMessagesMalformed);
  if (peer.transport == Transport::kUdp) return;
  ErrorCode code = ErrorCode::kMalformed;
  if (status == DecodeStatus::kBadVersion) code = ErrorCode::kUnsupportedVersion;
  if (status == DecodeStatus::kUnknownKind) code = ErrorCode::kUnsupported;
  shard.context.messages.SendError(
      peer, view.header, code,
      "not a message of this protocol: " + std::string(DecodeStatusName(status)));
}

template <class Message, class Handler>
void Dispatcher::Decode(Shard& shard, Peer& peer, const protocol::MessageView& view,
                        Message& message, const Handler& handler) {
  const DecodeStatus status = protocol::Decode(view, message);
  if (status == DecodeStatus::kOk) {
    handler();
    return;
  }
  parts_.metrics->Add(view.kind == MessageKind::kPose ? Counter::kPosesInvalid
                                                      : Counter::kMessagesMalformed);
  if (peer.transport == Transport::kUdp) return;
  parts_.router->PublishGathered(shard);
  shard.context.messages.SendError(peer, view.header, ErrorCode::kMalformed,
                                   "invalid " + std::string(MessageKindName(view.kind)) +
                                       " message: " + std::string(DecodeStatusName(status)));
}

// The messages that need no exclusive lock.
void Dispatcher::DispatchVerified(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                  Time now) {
  const protocol::Header& header = view.header;
  Shard::Incoming& in = shard.in;
  switch (view.kind) {
    case MessageKind::kPose:
      return Decode(shard, peer, view, in.pose, [&] {
        const auto payload = in.pose.partial ? std::span<const std::uint8_t>() : view.payload;
        parts_.router->AcceptPose(shard, peer, header, in.pose, payload, now);
      });
    case MessageKind::kPing:
      return Decode(shard, peer, view, in.ping, [&] {
        shard.context.messages.SendReply(peer, MessageSender::ReplyHeader(header),
                                         protocol::Pong{in.ping.time_us, ToMicroseconds(now)});
      });
    case MessageKind::kPong:
      return Decode(shard, peer, view, in.pong, [] {});  // only proves that the peer is alive
    default: {
      const Shards::ExclusiveLock lock(*parts_.shards, shard.index);
      return DispatchExclusive(shard, peer, view, now);
    }
  }
}

void Dispatcher::DispatchExclusive(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                   Time now) {
  const protocol::Header& header = view.header;
  Shard::Incoming& in = shard.in;
  switch (view.kind) {
    case MessageKind::kSkeletonOffer:
      return Decode(shard, peer, view, in.offer,
                    [&] { (void)parts_.router->OnOffer(peer, header, in.offer, now); });
    case MessageKind::kHello:
      return Decode(shard, peer, view, in.hello, [&] { OnHello(peer, header, in.hello); });
    case MessageKind::kGoodbye:
      return Decode(shard, peer, view, in.goodbye,
                    [&] { parts_.publishers->OnGoodbye(peer, header, now); });
    default: DispatchRequest(shard, peer, view, now);
  }
}

void Dispatcher::DispatchRequest(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                 Time now) {
  const protocol::Header& header = view.header;
  Subscribers& subscribers = *parts_.subscribers;
  Shard::Incoming& in = shard.in;
  switch (view.kind) {
    case MessageKind::kSubscribeWeights: return Subscribe(shard, peer, view, in.subscribe_weights);
    case MessageKind::kSubscribePictures:
      return Subscribe(shard, peer, view, in.subscribe_pictures);
    case MessageKind::kSubscribePoses: return Subscribe(shard, peer, view, in.subscribe_poses);
    case MessageKind::kUpdatePictures:
      return Decode(shard, peer, view, in.update_pictures, [&] {
        subscribers.UpdatePictures(peer, header, in.update_pictures.pictures, now);
      });
    case MessageKind::kFrameAck:
      return Decode(shard, peer, view, in.frame_ack,
                    [&] { subscribers.Acknowledge(peer, header, in.frame_ack.number, now); });
    case MessageKind::kUnsubscribe:
      return Decode(shard, peer, view, in.unsubscribe,
                    [&] { subscribers.Unsubscribe(peer, header.stream); });
    case MessageKind::kListSubjects:
      return Decode(shard, peer, view, in.list_subjects,
                    [&] { OnListSubjects(peer, header, in.list_subjects); });
    default:
      parts_.messages->SendError(peer, header, ErrorCode::kUnsupported,
                                 "only a daemon sends " + std::string(MessageKindName(view.kind)));
  }
}

template <class Request>
void Dispatcher::Subscribe(Shard& shard, Peer& peer, const protocol::MessageView& view,
                           Request& request) {
  Decode(shard, peer, view, request, [&] {
    if (refuses_subscriptions_) {
      return parts_.messages->SendError(peer, view.header, ErrorCode::kDraining,
                                        "the daemon is shutting down");
    }
    parts_.subscribers->Subscribe(peer, view.header, request);
  });
}

void Dispatcher::OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello) {
  protocol::Welcome welcome{kServerName, 0};
  if (peer.transport == Transport::kUdp) {
    const bool proves = hello.token != 0 && hello.token == peer.token;
    if (proves) peer.credit.Prove();
    // A forged Hello must not turn on bundles for a client that cannot read them.
    if (proves || !hello.bundles) peer.link->SetTakesBundles(hello.bundles);
    if (!peer.credit.proven()) {
      if (peer.token == 0) peer.token = parts_.make_token();
      welcome.token = peer.token;
    }
  }
  parts_.messages->SendReply(peer, MessageSender::ReplyHeader(header), welcome);
}

void Dispatcher::OnListSubjects(Peer& peer, const protocol::Header& header,
                                const protocol::ListSubjects& request) {
  if (peer.transport == Transport::kUdp) {
    return parts_.messages->SendError(peer, header, ErrorCode::kNeedsTcp,
                                      "the list of subjects is available over TCP only");
  }
  peer.list_request.reset();
  if (request.follow) peer.list_request = header;
  SendSubjectList(peer, header);
}

void Dispatcher::UpdateSubjectList(Peer& peer) {
  if (!peer.list_request || peer.listed_version == parts_.subjects->version()) return;
  SendSubjectList(peer, *peer.list_request);
}

void Dispatcher::SendSubjectList(Peer& peer, const protocol::Header& request) {
  protocol::Subjects list;
  list.total = static_cast<std::uint32_t>(parts_.subjects->size());
  for (const auto& subject : parts_.subjects->all()) {
    if (list.names.size() == protocol::kMaxListedSubjects) break;
    list.names.push_back(subject->name);
  }
  peer.listed_version = parts_.subjects->version();
  parts_.messages->SendReply(peer, {.sequence = request.sequence}, list);
}

}  // namespace furrow::server
