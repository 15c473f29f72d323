// SPDX-License-Identifier: Apache-2.0
#include "server/session/hub.h"

#include <algorithm>
#include <vector>

#include <spdlog/spdlog.h>

#include "protocol/limits.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;
using protocol::ErrorCode;
using protocol::MessageKind;

constexpr Time kUdpLease = std::chrono::microseconds(protocol::kUdpLeaseMicroseconds);
constexpr std::size_t kMaxMocapStreams = 64;
constexpr Time kMocapRetry = std::chrono::seconds(1);
constexpr char kServerName[] = "furrowd " FURROW_VERSION;

}  // namespace

Hub::Hub(Parts parts)
    : limits_(parts.limits),
      metrics_(parts.metrics),
      make_token_(std::move(parts.make_token)),
      on_weights_(std::move(parts.on_weights)),
      recording_(parts.recording),
      postman_(parts.session, parts.metrics),
      definitions_(std::move(parts.rig), parts.character,
                   static_cast<std::size_t>(parts.limits.max_skeletons),
                   std::move(parts.skeletons)),
      publishers_(limits_, &definitions_, &subjects_, &postman_, metrics_),
      subscribers_(limits_, &subjects_, parts.pictures, parts.settings,
                   recording_ != nullptr || on_weights_ != nullptr, &postman_, metrics_) {}

PeerId Hub::AddPeer(Transport transport, std::string name, Link* link, Time now) {
  const TokenBucket bucket(limits_.packets_per_second, limits_.packet_burst);
  return peers_.Add(transport, std::move(name), link, bucket, now).id;
}

void Hub::RemovePeer(PeerId id) {
  Peer* peer = peers_.Find(id);
  if (peer == nullptr) return;
  PublishGathered();
  subscribers_.RemovePeer(*peer);
  if (peer->publishes) subjects_.ForgetPeer(id);
  peers_.Remove(id);
}

void Hub::OnBytesReceived(PeerId id, std::size_t bytes, Time now) {
  if (Peer* peer = peers_.Find(id); peer != nullptr) {
    peer->credit.Received(bytes);
    peer->last_heard = now;
  }
}

void Hub::OnMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  GatherMessage(id, bytes, now);
  PublishGathered();
}

void Hub::GatherMessage(PeerId id, std::span<const std::uint8_t> bytes, Time now) {
  Peer* peer = peers_.Find(id);
  if (peer == nullptr) return;
  metrics_->Add(Counter::kMessagesReceived);
  if (!peer->bucket.Take(now)) {
    metrics_->Add(Counter::kMessagesThrottled);
    return;
  }
  peer->last_heard = now;
  protocol::MessageView view;
  const DecodeStatus status = protocol::OpenMessage(bytes, view);
  // Whatever else it asks for or changes, the poses before it come first.
  if (status != DecodeStatus::kOk || view.kind != MessageKind::kPose) PublishGathered();
  if (status == DecodeStatus::kOk) {
    Dispatch(*peer, view, now);
  } else {
    RefuseEnvelope(*peer, view, status);
  }
}

void Hub::OnBadFrame(PeerId id) {
  if (Peer* peer = peers_.Find(id); peer != nullptr) {
    postman_.Error(*peer, {}, ErrorCode::kMalformed,
                   "a frame is 32 to " + std::to_string(protocol::kMaxRequestBytes) +
                       " bytes long, after its length as u32, little-endian");
  }
}

void Hub::RefuseConnection(Link* link) {
  Peer nobody;
  nobody.link = link;
  postman_.Error(nobody, {}, ErrorCode::kLimit,
                 "at most " + std::to_string(limits_.max_connections) +
                     " connections, see limits.max_connections");
}

void Hub::RefuseEnvelope(Peer& peer, const protocol::MessageView& view, DecodeStatus status) {
  metrics_->Add(Counter::kMessagesMalformed);
  if (peer.transport == Transport::kUdp) return;
  ErrorCode code = ErrorCode::kMalformed;
  if (status == DecodeStatus::kBadVersion) code = ErrorCode::kUnsupportedVersion;
  if (status == DecodeStatus::kUnknownKind) code = ErrorCode::kUnsupported;
  postman_.Error(peer, view.header, code,
                 "not a message of this wire: " + std::string(DecodeStatusName(status)));
}

template <class Message, class Handler>
void Hub::Decoded(Peer& peer, const protocol::MessageView& view, Message& message,
                  Handler handler) {
  const DecodeStatus status = protocol::Decode(view, message);
  if (status == DecodeStatus::kOk) {
    handler();
    return;
  }
  metrics_->Add(view.kind == MessageKind::kPose ? Counter::kPosesInvalid
                                                : Counter::kMessagesMalformed);
  if (peer.transport != Transport::kUdp) {
    PublishGathered();
    postman_.Error(peer, view.header, ErrorCode::kMalformed,
                   std::string(MessageKindName(view.kind)) +
                       " cannot be read: " + std::string(DecodeStatusName(status)));
  }
}

template <class Request>
void Hub::OnSubscribe(Peer& peer, const protocol::MessageView& view, Request& request) {
  Decoded(peer, view, request, [&] {
    if (RefusedWhileDraining(peer, view.header)) return;
    subscribers_.Subscribe(peer, view.header, request);
  });
}

// What publishers say, and what everybody may; the rest is of subscribers.
void Hub::Dispatch(Peer& peer, const protocol::MessageView& view, Time now) {
  const protocol::Header& header = view.header;
  Scratch& in = scratch_;
  switch (view.kind) {
    case MessageKind::kPose:
      return Decoded(peer, view, in.pose, [&] {
        const auto payload = in.pose.partial ? std::span<const std::uint8_t>() : view.payload;
        OnPose(peer, header, in.pose, payload, now);
      });
    case MessageKind::kSkeletonOffer:
      return Decoded(peer, view, in.offer, [&] { (void)OnOffer(peer, header, in.offer, now); });
    case MessageKind::kHello:
      return Decoded(peer, view, in.hello, [&] { OnHello(peer, header, in.hello); });
    case MessageKind::kPing:
      return Decoded(peer, view, in.ping, [&] {
        postman_.Reply(peer, Postman::Answering(header),
                       protocol::Pong{in.ping.time_us, ToMicroseconds(now)});
      });
    case MessageKind::kPong:
      return Decoded(peer, view, in.pong, [] {});  // heard: that is all it is for
    case MessageKind::kGoodbye:
      return Decoded(peer, view, in.goodbye, [&] { publishers_.OnGoodbye(peer, header, now); });
    default: DispatchSubscriber(peer, view, now);
  }
}

void Hub::DispatchSubscriber(Peer& peer, const protocol::MessageView& view, Time now) {
  const protocol::Header& header = view.header;
  Scratch& in = scratch_;
  switch (view.kind) {
    case MessageKind::kSubscribeWeights: return OnSubscribe(peer, view, in.subscribe_weights);
    case MessageKind::kSubscribePictures: return OnSubscribe(peer, view, in.subscribe_pictures);
    case MessageKind::kSubscribePoses: return OnSubscribe(peer, view, in.subscribe_poses);
    case MessageKind::kUpdatePictures:
      return Decoded(peer, view, in.update_pictures,
                     [&] { subscribers_.Update(peer, header, in.update_pictures.pictures, now); });
    case MessageKind::kFrameAck:
      return Decoded(peer, view, in.frame_ack,
                     [&] { subscribers_.Acknowledge(peer, header, in.frame_ack.number, now); });
    case MessageKind::kUnsubscribe:
      return Decoded(peer, view, in.unsubscribe,
                     [&] { subscribers_.Unsubscribe(peer, header.stream); });
    case MessageKind::kListSubjects:
      return Decoded(peer, view, in.list_subjects,
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

// False: refused.
bool Hub::OnOffer(Peer& peer, const protocol::Header& header, const protocol::SkeletonOffer& offer,
                  Time now) {
  Subject* subject = publishers_.OnOffer(peer, header, offer, now);
  if (subject == nullptr) return false;
  subscribers_.OnSubjectReady(*subject);
  if (recording_ != nullptr) recording_->OnOffer(*subject, offer, now);
  return true;
}

// `payload`: as RecordingTap::OnPose() takes it.
void Hub::OnPose(Peer& peer, const protocol::Header& header, const protocol::PoseFrame& pose,
                 std::span<const std::uint8_t> payload, Time now) {
  Subject* subject = publishers_.Find(peer, header, pose);
  // An answer comes after the poses before it, and a subject's next pose builds on its last.
  const bool may_wait = subject != nullptr && !subject->pipeline->waits() && !gathered_.full();
  if (!may_wait) PublishGathered();
  if (subject == nullptr) {
    publishers_.OnStray(peer, header, pose.skeleton_hash, now);
  } else if (publishers_.Take(*subject, header, pose)) {
    gathered_.Add({.subject = subject, .header = header, .payload = payload, .now = now});
  }
}

void Hub::PublishGathered() {
  if (gathered_.empty()) return;
  for (const GatheredPose& pose : gathered_.Solve()) {
    if (!publishers_.OnSolved(pose)) continue;
    if (recording_ != nullptr) recording_->OnPose(*pose.subject, pose.payload, pose.now);
    Weighted(*pose.subject, pose.payload, 0, pose.now);
  }
}

void Hub::Weighted(Subject& subject, std::span<const std::uint8_t> pose, std::int64_t age_us,
                   Time now) {
  subscribers_.Publish(subject, pose, age_us, now);
  if (on_weights_) on_weights_(subject);
  if (recording_ != nullptr) recording_->OnWeights(subject, age_us, now);
}

void Hub::OnMocapFrame(PeerId id, const protocol::mocap::NeutralFrame& frame, Time now) {
  Peer* peer = peers_.Find(id);
  // Lost by its own tracker: as if nothing had come, so that it holds and decays.
  if (peer == nullptr || !frame.tracked) return;
  MocapStream* stream = FindOrAddMocap(*peer, frame.subject);
  if (stream == nullptr) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  stream->heard = now;
  const protocol::Header header{.session = id,
                                .stream = stream->stream,
                                .sequence = frame.sequence,
                                .capture_time_us = frame.capture_time_us};
  const bool is_new = stream->offered == Time{0};
  if (is_new || stream->layout != frame.layout ||
      (stream->refused && now - stream->offered >= kMocapRetry)) {
    stream->refused = !OfferMocap(*peer, header, *stream, frame, now);
  }
  if (stream->refused) {
    metrics_->Add(Counter::kMocapRefused);
    return;
  }
  protocol::mocap::MakePose(frame, stream->offer, scratch_.pose);
  OnPose(*peer, header, scratch_.pose, {}, now);
  PublishGathered();
}

Hub::MocapStream* Hub::FindOrAddMocap(const Peer& peer, const std::string& subject) {
  const auto entry = mocap_streams_.find({peer.id, subject});
  if (entry != mocap_streams_.end()) return &entry->second;
  if (mocap_streams_.size() >= kMaxMocapStreams) return nullptr;
  MocapStream& added = mocap_streams_[{peer.id, subject}];
  added.stream = next_mocap_stream_++;
  return &added;
}

// Those that were taken go with their subject; a refused one has none.
void Hub::ForgetRefusedMocap(Time now) {
  std::erase_if(mocap_streams_, [&](const auto& entry) {
    return entry.second.refused && now - entry.second.heard > FromSeconds(limits_.idle_seconds);
  });
}

bool Hub::OfferMocap(Peer& peer, const protocol::Header& header, MocapStream& stream,
                     const protocol::mocap::NeutralFrame& frame, Time now) {
  stream.layout = frame.layout;
  stream.offered = now;
  stream.offer = protocol::mocap::MakeOffer(frame);
  return OnOffer(peer, header, stream.offer, now);
}

void Hub::Tick(Time now) {
  std::vector<Subject*> gone;
  for (const auto& subject : subjects_.all()) {
    switch (publishers_.Age(*subject, now)) {
      case Publishers::Change::kNone: break;
      case Publishers::Change::kDecayed:
        Weighted(*subject, {}, ToMicroseconds(now - subject->last_pose), now);
        break;
      case Publishers::Change::kGone: gone.push_back(subject.get()); break;
    }
  }
  for (Subject* subject : gone) {
    spdlog::info("subject '{}' is gone", subject->name);
    subscribers_.OnSubjectGone(*subject);
    if (recording_ != nullptr) recording_->OnSubjectGone(*subject);
    std::erase_if(mocap_streams_,
                  [subject](const auto& entry) { return entry.first.second == subject->name; });
    subjects_.Remove(subject->id);
  }
  if (!gone.empty()) subscribers_.BindWaiting();
  ForgetRefusedMocap(now);
  peers_.ForEach([now](Peer& peer) { peer.stuck = peer.link->IsStuck(now); });
  subscribers_.PublishOwed(now);
  peers_.ForEach([&](Peer& peer) {
    if (peer.follows_list && peer.listed != subjects_.version()) SendList(peer, *peer.follows_list);
    if (peer.transport != Transport::kUdp || now - peer.last_heard < kUdpLease) return;
    if (peer.num_subscriptions > 0) {
      subscribers_.RemovePeer(peer, protocol::GoodbyeReason::kTimedOut);
    }
    peer.credit = {};  // proven for as long as it is heard
  });
}

void Hub::Drain() {
  draining_ = true;
  peers_.ForEach([&](Peer& peer) {
    if (peer.transport == Transport::kMocap) return;
    postman_.Reply(peer, {}, protocol::Goodbye{protocol::GoodbyeReason::kDraining});
  });
}

bool Hub::IsIdle(PeerId id, Time now) {
  const Peer* peer = peers_.Find(id);
  return peer == nullptr || (peer->num_subscriptions == 0 &&
                             now - peer->last_heard > FromSeconds(limits_.idle_seconds));
}

bool Hub::IsLessWorthKeeping(PeerId a, PeerId b) {
  const auto worth = [this](PeerId id) {
    const Peer* peer = peers_.Find(id);
    return std::pair(peer->publishes || peer->num_subscriptions > 0, peer->last_heard);
  };
  return worth(a) < worth(b);
}

}  // namespace furrow::server
