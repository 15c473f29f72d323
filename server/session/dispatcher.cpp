// SPDX-License-Identifier: Apache-2.0
#include "server/session/dispatcher.h"

#include <string>

#include "protocol/messages/limits.h"
#include "server/session/peers/peer_access.h"
#include "server/session/peers/server_name.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::ErrorCode;
using protocol::MessageKind;

// The payload of a request that costs one more.
constexpr double kBytesPerRequest = 64.0;
// Captured poses may change the rig, which binds all subjects again: they cost as much as this many
// requests.
constexpr double kRequestsPerCaptures = 64.0;

}  // namespace

void Dispatcher::Dispatch(Shard& shard, Peer& peer, std::span<const std::uint8_t> bytes, Time now) {
  if (peer.token_ended) return;
  protocol::MessageView view;
  const DecodeStatus status = protocol::OpenMessage(bytes, view);
  // Anything but a pose may observe or change the session, so the poses before it come first.
  if (status != DecodeStatus::kOk || view.kind != MessageKind::kPose) {
    parts_.router->PublishGathered(shard);
  }
  // Malformed messages of strangers get the same answer, so strangers learn nothing else.
  const bool is_hello = status == DecodeStatus::kOk && view.kind == MessageKind::kHello;
  if (!peer.access.admitted() && !is_hello) {
    RefuseStranger(shard, peer, view.header, WhyNeeded(peer));
  } else if (status == DecodeStatus::kOk) {
    DispatchVerified(shard, peer, view, now);
  } else {
    RejectEnvelope(shard, peer, view, status);
  }
}

// Counts a message that is not of this protocol. UDP senders get no answer: the message may be
// forged, or damaged on its way.
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

// Decodes the payload and calls `handler` if it is valid. Otherwise counts it and, except over UDP,
// answers with an error.
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
  // The answer must not overtake the frames of earlier poses.
  parts_.router->PublishGathered(shard);
  shard.context.messages.SendError(peer, view.header, ErrorCode::kMalformed,
                                   "invalid " + std::string(MessageKindName(view.kind)) +
                                       " message: " + std::string(DecodeStatusName(status)));
  if (!peer.access.admitted()) CutOff(peer);
}

// Handles the messages that need no exclusive lock, and takes the lock for the others. Decodes into
// the shard's reused structs (Shard::Incoming), which only this thread uses, so poses allocate
// nothing.
void Dispatcher::DispatchVerified(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                  Time now) {
  const protocol::Header& header = view.header;
  Shard::Incoming& in = shard.in;
  switch (view.kind) {
    case MessageKind::kPose:
      parts_.router->Prefetch(peer, header);
      return Decode(shard, peer, view, in.pose, [&] {
        // A partial pose cannot be relayed as it came: a subscriber that lost the pose before it
        // would complete it wrongly.
        if (!in.pose.previous.empty()) RecoverPrevious(shard, peer, header, now);
        const auto payload = in.pose.partial ? std::span<const std::uint8_t>() : view.payload;
        parts_.router->AcceptPose(shard, peer, header, in.pose, payload, now);
      });
    case MessageKind::kPing:
      return Decode(shard, peer, view, in.ping, [&] {
        shard.context.messages.SendReply(peer, MessageSender::ReplyHeader(header),
                                         protocol::Pong{in.ping.time_us, ToMicroseconds(now)});
      });
    case MessageKind::kPong:
      return Decode(shard, peer, view, in.pong, [&] { peer.consent.Answered(in.pong.time_us); });
    case MessageKind::kUnsubscribe:
      // There is nothing to end, and so no reason to stop the other threads.
      if (peer.num_subscriptions == 0) return Decode(shard, peer, view, in.unsubscribe, [] {});
      [[fallthrough]];
    default: {
      if (!TakeRequest(shard, peer, view, now)) return;
      // A state is large, so it is not even read for others.
      if (view.kind == MessageKind::kSubjectState && !peer.access.Has(Role::kOperate)) {
        if (peer.transport == Transport::kUdp && !peer.consent.Holds(now)) return;
        return shard.context.messages.SendError(
            peer, header, ErrorCode::kNotPermitted,
            "not permitted to hand over subjects; " + peer.access.Text());
      }
      // `peer` and `view` stay valid while the lock changes hands: only this thread removes the
      // peer or reuses the buffer of the message. Subjects may have left, so the handlers look them
      // up again.
      const Shards::ExclusiveLock lock(*parts_.shards, shard.index);
      return DispatchExclusive(shard, peer, view, now);
    }
  }
}

// Uses the pose that the shard's pose repeats, if it is missing. Invalid ones are counted, and the
// pose itself stays valid.
void Dispatcher::RecoverPrevious(Shard& shard, const Peer& peer, const protocol::Header& header,
                                 Time now) {
  if (!parts_.router->MissesPrevious(shard, peer, header)) return;
  Shard::Incoming& in = shard.in;
  if (protocol::DecodePrevious(in.pose, in.previous) != DecodeStatus::kOk) {
    parts_.metrics->Add(Counter::kPosesInvalid);
    return;
  }
  parts_.router->AcceptPrevious(shard, peer, header, in.pose.previous_age_us, in.previous, now);
}

// Requests stop the other threads and are answered, so each peer has a budget of them; a long
// pattern costs as much as several. Offers have a budget of their own. UDP clients repeat a request
// that is not answered.
bool Dispatcher::TakeRequest(Shard& shard, Peer& peer, const protocol::MessageView& view,
                             Time now) {
  const bool is_free = view.kind == MessageKind::kFrameAck || view.kind == MessageKind::kGoodbye;
  // Offers and states are large by nature; Publishers and Arrivals limit what large ones cost.
  const bool is_large =
      view.kind == MessageKind::kSkeletonOffer || view.kind == MessageKind::kSubjectState;
  const double size = is_large ? 0.0 : static_cast<double>(view.payload.size());
  const double cost = 1.0 + size / kBytesPerRequest;
  TokenBucket& budget = view.kind == MessageKind::kSkeletonOffer ? peer.offers : peer.requests;
  if (is_free || budget.Take(now, cost)) return true;
  parts_.metrics->Add(Counter::kRequestsThrottled);
  if (peer.transport != Transport::kUdp) {
    shard.context.messages.SendError(peer, view.header, ErrorCode::kLimit,
                                     "too many requests per second; try again later");
  }
  return false;
}

// Messages of publishers and about the connection. The caller holds the exclusive lock, also for
// the functions below.
void Dispatcher::DispatchExclusive(Shard& shard, Peer& peer, const protocol::MessageView& view,
                                   Time now) {
  const protocol::Header& header = view.header;
  Shard::Incoming& in = shard.in;
  switch (view.kind) {
    case MessageKind::kSkeletonOffer:
      return Decode(shard, peer, view, in.offer,
                    [&] { (void)parts_.router->OnOffer(peer, header, in.offer, now); });
    case MessageKind::kHello:
      return Decode(shard, peer, view, in.hello, [&] { OnHello(peer, header, in.hello, now); });
    case MessageKind::kGoodbye:
      return Decode(shard, peer, view, in.goodbye, [&] {
        parts_.router->ReleaseStream(shard, {peer.id, header.session, header.stream}, now);
        parts_.publishers->OnGoodbye(peer, header, now);
      });
    case MessageKind::kUnsubscribe:
      return Decode(shard, peer, view, in.unsubscribe,
                    [&] { parts_.subscribers->Unsubscribe(peer, header.stream); });
    case MessageKind::kListSubjects:
      return Decode(shard, peer, view, in.list_subjects,
                    [&] { OnListSubjects(peer, header, in.list_subjects); });
    default:
      // A forged request must not make the daemon send much to an address. The sender repeats its
      // request, and by then it has answered the challenge of the next tick.
      if (peer.transport == Transport::kUdp && !peer.consent.Holds(now)) {
        peer.consent.Want();
        parts_.metrics->Add(Counter::kRepliesWithoutConsent);
        return;
      }
      DispatchRequest(shard, peer, view, now);
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
                    [&] { subscribers.Acknowledge(peer, header, in.frame_ack, now); });
    case MessageKind::kSubjectState:
      return Decode(shard, peer, view, in.subject_state,
                    [&] { OnSubjectState(peer, view, in.subject_state, now); });
    case MessageKind::kDrain:
      return Decode(shard, peer, view, in.drain, [&] { OnDrain(peer, header, in.drain); });
    default:
      parts_.messages->SendError(peer, header, ErrorCode::kUnsupported,
                                 "only a daemon sends " + std::string(MessageKindName(view.kind)));
  }
}

template <class Request>
void Dispatcher::Subscribe(Shard& shard, Peer& peer, const protocol::MessageView& view,
                           Request& request) {
  Decode(shard, peer, view, request, [&] {
    // Only valid requests reach this point, so a draining daemon still reports a malformed one as
    // such.
    if (refuses_subscriptions_) {
      return parts_.messages->SendError(peer, view.header, ErrorCode::kDraining,
                                        "the daemon is shutting down");
    }
    parts_.subscribers->Subscribe(peer, view.header, request);
  });
}

// A UDP peer has proved its address with this Hello or an earlier one (Reception), so the answer
// has no token.
void Dispatcher::OnHello(Peer& peer, const protocol::Header& header, const protocol::Hello& hello,
                         Time now) {
  if (!OnToken(peer, header, hello.access, now)) return;
  if (peer.transport == Transport::kUdp) peer.link->SetTakesBundles(hello.bundles);
  parts_.messages->SendReply(peer, MessageSender::ReplyHeader(header),
                             protocol::Welcome{kServerName, 0, parts_.places->Others()});
}

// Over UDP, a token is not shown but used (protocol/secure). False: the peer has been refused.
bool Dispatcher::OnToken(Peer& peer, const protocol::Header& header, const std::string& token,
                         Time now) {
  Shard& shard = parts_.shards->Of(peer.id);
  const bool shown = !token.empty() && parts_.gate != nullptr && peer.transport != Transport::kUdp;
  if (shown) {
    auto access = parts_.gate->Admit(token, peer.shielded, now);
    if (!access.ok()) {
      refusals_.Note([&peer] { return peer.name; }, access.status().what(), now);
      Refuse(shard, peer, header, access.status().what());
      return false;
    }
    Permit(peer, *std::move(access), *parts_.limits);
    peer.link->OnAdmitted();
    parts_.subscribers->EndForbidden(peer);
    parts_.publishers->EndForbidden(peer, now);
    return true;
  }
  if (!peer.access.admitted()) RefuseStranger(shard, peer, header, WhyNeeded(peer));
  return peer.access.admitted();
}

const char* Dispatcher::WhyNeeded(const Peer& peer) const {
  return parts_.gate == nullptr ? kNeedsTokenText : parts_.gate->WhyNeeded(peer.shielded);
}

void Dispatcher::RefuseStranger(Peer& peer) {
  if (peer.token_ended) return;
  RefuseStranger(parts_.shards->Of(peer.id), peer, {}, WhyNeeded(peer));
}

void Dispatcher::RefuseStranger(Shard& shard, Peer& peer, const protocol::Header& header,
                                std::string why) {
  parts_.metrics->Add(Counter::kRefusedNoToken);
  Refuse(shard, peer, header, std::move(why));
}

// One clear error, then the connection ends.
void Dispatcher::Refuse(Shard& shard, Peer& peer, const protocol::Header& header, std::string why) {
  shard.context.messages.SendError(peer, header, ErrorCode::kNeedsToken, std::move(why));
  CutOff(peer);
}

void Dispatcher::CutOff(Peer& peer, bool soon) {
  peer.token_ended = true;
  // A WebSocket closes after a goodbye to stream 0.
  if (peer.transport == Transport::kWeb) {
    parts_.shards->Of(peer.id).context.messages.SendReply(
        peer, {}, protocol::Goodbye{protocol::GoodbyeReason::kTimedOut});
  }
  soon ? peer.link->FinishSoon() : peer.link->Finish();
}

// Another node of the cluster, or whoever may operate this one, hands a subject over.
void Dispatcher::OnSubjectState(Peer& peer, const protocol::MessageView& view,
                                const protocol::SubjectState& state, Time now) {
  if (!peer.access.Concerns(state.subject)) {
    return parts_.messages->SendError(
        peer, view.header, ErrorCode::kNotPermitted,
        "not permitted to hand over '" + state.subject + "'; " + peer.access.Text());
  }
  std::string why;
  const bool has_captures = !state.captures.empty();
  // A state that arrives after its subject is an old copy.
  if (parts_.subjects->Find(state.subject) == nullptr) {
    if (has_captures && !peer.requests.Take(now, kRequestsPerCaptures)) {
      parts_.metrics->Add(Counter::kRequestsThrottled);
      why = "too many captured poses at once";
    } else if (!parts_.arrivals->Add(state, view, now)) {
      why = "too many subjects are on their way to this node";
    } else if (const Place place = parts_.places->Expect(state.subject, now);
               place.kind != Place::Kind::kPending) {
      why = place.why;
      parts_.arrivals->Drop(state.subject);
    } else if (has_captures) {
      parts_.adopt_captures(state, now);
    }
  }
  const auto status =
      why.empty() ? protocol::SkeletonStatus::kAccepted : protocol::SkeletonStatus::kRejected;
  parts_.messages->SendReply(
      peer, MessageSender::ReplyHeader(view.header),
      protocol::SkeletonReply{state.skeleton_hash, status, MessageSender::Truncate(why)});
}

// Empty: the peer may. Draining ends the daemon and concerns all of its subjects.
std::string Dispatcher::WhyNoDrain(const Peer& peer) const {
  if (peer.access.by_token()) {
    if (peer.access.Has(Role::kOperate) && peer.access.ConcernsAll()) return {};
    return "a token with the role operate for all subjects is needed; " + peer.access.Text();
  }
  // Nobody has shown who it is.
  const bool is_here =
      !peer.address.empty() && parts_.is_own_address && parts_.is_own_address(peer.address);
  return is_here ? ""
                 : "without tokens, only programs on the daemon's own computer may; end the daemon "
                   "with SIGTERM there, or start it with --security required";
}

void Dispatcher::OnDrain(Peer& peer, const protocol::Header& header,
                         const protocol::Drain& request) {
  if (const std::string why = parts_.places->WhyNothingMoves(); !why.empty() || !parts_.drain) {
    return parts_.messages->SendError(peer, header, ErrorCode::kUnsupported,
                                      why + "; end the daemon with SIGTERM");
  }
  if (const std::string why = WhyNoDrain(peer); !why.empty()) {
    return parts_.messages->SendError(peer, header, ErrorCode::kNotPermitted,
                                      "not permitted to drain the daemon: " + why);
  }
  protocol::DrainState state = parts_.drain(request.begin);
  state.left = static_cast<std::uint32_t>(parts_.subjects->size());
  for (const auto& subject : parts_.subjects->all()) {
    if (state.names.size() == protocol::kMaxLeftNames) break;
    state.names.push_back(subject->name);
  }
  parts_.messages->SendReply(peer, MessageSender::ReplyHeader(header), state);
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
  for (const auto& subject : parts_.subjects->all()) {
    if (!peer.access.MayWatch(subject->name)) continue;
    // `total` tells the client that the list is cut.
    ++list.total;
    if (list.names.size() < protocol::kMaxListedSubjects) list.names.push_back(subject->name);
  }
  // The version counts additions and removals, so following a list costs one comparison per tick.
  peer.listed_version = parts_.subjects->version();
  parts_.messages->SendReply(peer, {.sequence = request.sequence}, list);
}

}  // namespace furrow::server
