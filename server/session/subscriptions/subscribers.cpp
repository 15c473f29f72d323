// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/subscribers.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::server {

using protocol::ErrorCode;

namespace {

// Why a reply cannot list the names; empty if it can.
std::string WhyTooLarge(const std::vector<std::string>& names, Transport transport) {
  if (names.size() > protocol::kMaxWeights) {
    return std::to_string(names.size()) + " weights, more than the " +
           std::to_string(protocol::kMaxWeights) +
           " of one subscription; use several subscriptions";
  }
  constexpr std::size_t kPerName = 12;  // offset, length, terminator and padding
  std::size_t bytes = 0;
  // An estimate from above, which saves encoding the reply twice. The reserve of 1,200 bytes covers
  // the table, the envelope and the subject's name.
  for (const std::string& name : names) bytes += name.size() + kPerName;
  if (transport != Transport::kUdp || bytes + kPerName * 100 <= protocol::kMaxUdpMessageBytes) {
    return {};
  }
  return "weights with " + std::to_string(bytes) +
         " bytes of names, more than a UDP message holds; use several subscriptions or TCP";
}

// Whether a subscription is allowed: by the name that it is bound to, that it asks for, or any.
bool MayWatch(const Subscription& subscription, const Access& access) {
  if (subscription.subject != nullptr) return access.MayWatch(subscription.subject->name);
  if (!subscription.subject_name.empty()) return access.MayWatch(subscription.subject_name);
  return access.Has(Role::kWatch);
}

std::string WhyForbidden(const Subscription& subscription, const Access& access) {
  const std::string& name = subscription.subject_name;
  return (name.empty() ? "not permitted to watch" : "not permitted to watch '" + name + "'") +
         ("; " + access.Text());
}

}  // namespace

Subscribers::Subscribers(const Limits& limits, SubjectRegistry* subjects, PictureSource* pictures,
                         const render::Settings& settings, bool all_drivers, const Places* places,
                         PublishContext* context, Metrics* metrics)
    : limits_(limits),
      subjects_(subjects),
      all_drivers_(all_drivers),
      places_(places),
      messages_(&context->messages),
      metrics_(metrics),
      table_(static_cast<std::size_t>(limits.max_all_subscriptions)),
      poses_(messages_),
      pictures_(&table_, pictures, settings, messages_, metrics),
      fan_out_(&table_, &poses_, &pictures_, context, metrics) {}

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribeWeights& request) {
  if (!CheckRequest(peer, header)) return;
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  subscription->request = WeightsRequest{.pattern = request.pattern,
                                         .format = request.format,
                                         .source = request.source,
                                         .indices = {},
                                         .names_hash = 0};
  // Over UDP frames are lost anyway, and there is no queue that could hold them.
  subscription->every = request.every && peer.transport != Transport::kUdp;
  Add(peer, header, std::move(subscription));
}

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribePictures& request) {
  // A picture may exceed protocol::kMaxUdpMessageBytes, and one lost fragment would lose it whole.
  if (peer.transport == Transport::kUdp) {
    return RefuseRequest(peer, header, ErrorCode::kNeedsTcp,
                         "pictures are available over TCP and WebSocket only");
  }
  if (!CheckRequest(peer, header)) return;
  PictureRequest pictures;
  if (auto why = MakePictures(request, &pictures)) {
    return RefuseRequest(peer, header, why->code, std::move(why->message));
  }
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  pictures.view_request = header.sequence;
  // A client that never acknowledges must not wait for its own acknowledgements.
  if (request.acknowledged) pictures.flow.emplace();
  PictureViews::BeginVideo(pictures);
  subscription->request = std::move(pictures);
  Add(peer, header, std::move(subscription));
}

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribePoses& request) {
  if (!CheckRequest(peer, header)) return;
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  subscription->request = PoseRequest();
  subscription->every = request.every && peer.transport != Transport::kUdp;
  Add(peer, header, std::move(subscription));
}

// Returns why there are no such pictures; nothing: `pictures` is set.
std::optional<protocol::ErrorMessage> Subscribers::MakePictures(
    const protocol::SubscribePictures& request, PictureRequest* pictures) {
  if (!pictures_.can_render()) {
    return protocol::ErrorMessage{
        ErrorCode::kNotRendering,
        "this daemon renders no pictures: they are off, or it has no character or no OpenGL"};
  }
  if (pictures_.is_stuck()) {
    return protocol::ErrorMessage{ErrorCode::kNotRendering,
                                  pictures_.fault() + ": pictures are off"};
  }
  Result<PictureRequest> made = pictures_.MakeRequest(request);
  if (!made.ok()) {
    return protocol::ErrorMessage{ErrorCode::kBadPicture, made.status().ToString()};
  }
  *pictures = *std::move(made);
  return std::nullopt;
}

std::optional<protocol::ErrorMessage> Subscribers::WhyNoPictures(
    const protocol::SubscribePictures& request, const Access& access) {
  Subscription subscription;
  subscription.subject_name = request.subject;
  subscription.wait = request.wait;
  PictureRequest unused;
  if (auto why = MakePictures(request, &unused)) return why;
  return FindAim(subscription, access).refusal;
}

Subscribers::Aim Subscribers::FindAim(const Subscription& subscription,
                                      const Access& access) const {
  const auto refuse = [](ErrorCode code, std::string why) {
    return Aim{.refusal = protocol::ErrorMessage{code, std::move(why)}};
  };
  if (!MayWatch(subscription, access)) {
    return refuse(ErrorCode::kNotPermitted, WhyForbidden(subscription, access));
  }
  const std::string& name = subscription.subject_name;
  Subject* const subject = name.empty() ? subjects_->First(access) : subjects_->Find(name);
  if (subject != nullptr) return {.subject = subject};
  if (const Place place = places_->Elsewhere(name); place.kind == Place::Kind::kElsewhere) {
    Aim aim = refuse(ErrorCode::kUnknownSubject, ElsewhereText(name, place.node));
    aim.elsewhere = place.node;
    return aim;
  }
  if (subscription.wait) return {};
  return refuse(ErrorCode::kUnknownSubject, NoSubjectText(name, access));
}

std::string Subscribers::NoSubjectText(const std::string& name, const Access& access) const {
  const std::string known = subjects_->Names(access);
  return (name.empty() ? "there is no subject" : "no subject '" + name + "'") +
         (known.empty() ? "; no subject is connected" : "; connected subjects: " + known);
}

// The checks that all kinds of request share. False: the request has been answered.
bool Subscribers::CheckRequest(Peer& peer, const protocol::Header& header) {
  // Before the limit: repeating a request whose reply was lost creates nothing.
  if (Subscription* known = table_.FindRepeated(peer, header); known != nullptr) {
    ReplyAgain(*known);
    return false;
  }
  if (peer.num_subscriptions >= limits_.max_subscriptions) {
    RefuseRequest(peer, header, ErrorCode::kLimit,
                  "at most " + std::to_string(limits_.max_subscriptions) +
                      " subscriptions per peer; see limits.max_subscriptions");
    return false;
  }
  if (!table_.HasRoomFor(peer)) {
    RefuseRequest(peer, header, ErrorCode::kLimit,
                  "one host gets at most half of the " +
                      std::to_string(limits_.max_all_subscriptions) +
                      " subscriptions; see limits.max_all_subscriptions");
    return false;
  }
  return true;
}

// A UDP client repeats its request if the reply was lost.
void Subscribers::ReplyAgain(Subscription& subscription) {
  auto* poses = std::get_if<PoseRequest>(&subscription.request);
  if (poses != nullptr && subscription.subject != nullptr) {
    BindPoses(subscription, *poses, *subscription.subject);
    return;
  }
  std::vector<std::string> names;
  if (const auto* weights = std::get_if<WeightsRequest>(&subscription.request);
      weights != nullptr && subscription.subject != nullptr) {
    const auto all = weights->Names(*subscription.subject->pipeline->stream().binding);
    for (const std::uint32_t index : weights->indices) names.push_back(all[index]);
  }
  Reply(subscription, std::move(names));
}

void Subscribers::Add(Peer& peer, const protocol::Header& header,
                      std::unique_ptr<Subscription> subscription) {
  Aim aim = FindAim(*subscription, peer.access);
  if (aim.refusal) {
    const ErrorCode code = aim.refusal->code;
    std::string& why = aim.refusal->message;
    if (aim.elsewhere) {
      return messages_->SendElsewhere(peer, header, code, std::move(why), *aim.elsewhere);
    }
    if (code == ErrorCode::kNotPermitted) metrics_->Add(Counter::kRefusedWatch);
    return RefuseRequest(peer, header, code, std::move(why));
  }
  // The subscription is in the table before Bind(), because replies carry its id. Bind() erases it
  // again if it must be refused.
  Subscription& added = table_.Add(peer, header, std::move(subscription));
  if (aim.subject == nullptr) {
    Reply(added, {});
  } else if (!Bind(added, *aim.subject)) {
    return;
  }
  metrics_->Add(Counter::kSubscriptionsAccepted);
}

// False: the subscription was refused and erased.
bool Subscribers::Bind(Subscription& subscription, Subject& subject) {
  if (auto* poses = std::get_if<PoseRequest>(&subscription.request); poses != nullptr) {
    return BindPoses(subscription, *poses, subject);
  }
  std::vector<std::string> names;
  if (auto* weights = std::get_if<WeightsRequest>(&subscription.request); weights != nullptr) {
    // Also remembers the indices, so that frames need no look-up by name.
    names = weights->Bind(*subject.pipeline->stream().binding);
    if (names.empty()) {
      RefuseAndErase(subscription, ErrorCode::kNoMatch,
                     "'" + weights->pattern + "' matches no weight of the rig");
      return false;
    }
    if (std::string why = WhyTooLarge(names, subscription.peer->transport); !why.empty()) {
      RefuseAndErase(subscription, ErrorCode::kLimit, "'" + weights->pattern + "' matches " + why);
      return false;
    }
  }
  Attach(subscription, subject);
  Reply(subscription, std::move(names));
  return true;
}

// Sends the reply and then the skeleton, which the subscriber needs to read the poses. False: the
// subscription was refused and erased.
bool Subscribers::BindPoses(Subscription& subscription, PoseRequest& request, Subject& subject) {
  if (!poses_.Fits(subject, subscription.peer->transport)) {
    RefuseAndErase(
        subscription, ErrorCode::kLimit,
        "the skeleton of '" + subject.name + "' does not fit into a UDP message; use TCP");
    return false;
  }
  request = {subject.run, subject.skeleton_hash};
  Attach(subscription, subject);
  Reply(subscription, {});
  poses_.SendSkeleton(subscription);
  return true;
}

void Subscribers::Attach(Subscription& subscription, Subject& subject) {
  table_.Attach(subscription, subject);
  UpdateDriverLevel(subject);
  // The next tick sends the newest pose, unless another node has sent it before the subject moved.
  subscription.owed = subject.pipeline->has_pose() && subject.stats.poses() > 0;
}

// Levels count drivers from the rig's first.
void Subscribers::UpdateDriverLevel(Subject& subject) {
  std::size_t needed = all_drivers_ || subject.needs_all_drivers ? wrinkle::kAllDrivers : 0;
  // Poses are relayed unsolved and need no drivers. Pictures need all, because a shader reads any
  // weight.
  for (const Subscription* subscription : subject.subscriptions) {
    if (const auto* weights = std::get_if<WeightsRequest>(&subscription->request)) {
      needed = std::max(needed, weights->num_drivers);
    } else if (std::holds_alternative<PictureRequest>(subscription->request)) {
      needed = wrinkle::kAllDrivers;
    }
  }
  if (subject.keeps_level) needed = std::max(needed, subject.pipeline->level());
  subject.pipeline->SetLevel(needed);
}

void Subscribers::OnLimits() {
  table_.SetPlaces(static_cast<std::size_t>(limits_.max_all_subscriptions));
}

void Subscribers::SetAllDrivers(bool all_drivers) {
  all_drivers_ = all_drivers;
  for (const auto& subject : subjects_->all()) UpdateDriverLevel(*subject);
}

void Subscribers::UpdatePictures(Peer& peer, const protocol::Header& header,
                                 const protocol::SubscribePictures& request, Time now) {
  Subscription* subscription = table_.Find(peer, header.stream);
  if (subscription == nullptr || !std::holds_alternative<PictureRequest>(subscription->request)) {
    return messages_->SendError(
        peer, header, ErrorCode::kBadPicture,
        "there is no picture subscription " + std::to_string(header.stream));
  }
  Result<PictureRequest> view = pictures_.MakeRequest(request);
  if (!view.ok()) {
    return messages_->SendError(peer, header, ErrorCode::kBadPicture, view.status().ToString());
  }
  view->view_request = header.sequence;
  subscription->gate.SetRate(request.max_rate_hz);
  pictures_.SetView(*subscription, *std::move(view), now);
  SendNow(*subscription, now);
}

void Subscribers::SetOwnSettings(const render::Settings& settings, Time now) {
  for (Subscription* changed : pictures_.SetOwnSettings(settings, now)) SendNow(*changed, now);
}

void Subscribers::Acknowledge(Peer& peer, const protocol::Header& header,
                              const protocol::FrameAck& ack, Time now) {
  Subscription* subscription = table_.Find(peer, header.stream);
  PictureRequest* viewer =
      subscription == nullptr ? nullptr : PictureViews::FlowControlled(*subscription);
  if (viewer == nullptr) return;  // the subscription ended in the meantime
  if (!viewer->flow->Acknowledge(ack.number)) {
    return messages_->SendError(peer, header, ErrorCode::kMalformed,
                                "picture " + std::to_string(ack.number) + " was never sent");
  }
  if (viewer->video) viewer->video->Acknowledge(ack, now);
  if (subscription->owed) SendNow(*subscription, now);
}

// Sends the newest pose now, or, if a limit forbids it, as soon as possible.
void Subscribers::SendNow(Subscription& subscription, Time now) {
  subscription.owed = subscription.subject != nullptr;
  if (subscription.owed && subscription.subject->pipeline->has_pose()) {
    fan_out_.SendOwed(subscription, now);
  }
}

void Subscribers::Reply(const Subscription& subscription, std::vector<std::string> names) {
  protocol::SubscribeReply reply;
  if (subscription.subject != nullptr) reply.subject = subscription.subject->name;
  if (const auto* poses = std::get_if<PoseRequest>(&subscription.request)) {
    reply.publisher_session = poses->publisher;
  }
  if (subscription.subject != nullptr) reply.epoch = subscription.subject->epoch;
  reply.names_hash = protocol::NamesHash(names);
  reply.names = std::move(names);
  messages_->SendReply(*subscription.peer,
                       {.stream = subscription.id, .sequence = subscription.request_sequence},
                       reply);
}

void Subscribers::RefuseRequest(Peer& peer, const protocol::Header& header, ErrorCode code,
                                std::string why) {
  metrics_->Add(Counter::kSubscriptionsRefused);
  messages_->SendError(peer, header, code, std::move(why));
}

void Subscribers::RefuseAndErase(Subscription& subscription, ErrorCode code, std::string why) {
  // The header of the original request, so that the client can tell which one was refused.
  RefuseRequest(*subscription.peer,
                {.stream = subscription.id, .sequence = subscription.request_sequence}, code,
                std::move(why));
  Erase(subscription);
}

void Subscribers::Erase(Subscription& subscription) {
  Subject* const subject = subscription.subject;
  pictures_.OnEnd(subscription);
  table_.Erase(subscription);
  if (subject != nullptr) UpdateDriverLevel(*subject);
}

bool Subscribers::Unsubscribe(Peer& peer, std::uint16_t id) {
  Subscription* subscription = table_.Find(peer, id);
  if (subscription == nullptr) return false;
  Erase(*subscription);
  return true;
}

void Subscribers::EndForbidden(Peer& peer) {
  for (Subscription* subscription : table_.Of(peer)) {
    if (MayWatch(*subscription, peer.access)) continue;
    metrics_->Add(Counter::kRefusedWatch);
    RefuseAndErase(*subscription, ErrorCode::kNotPermitted,
                   WhyForbidden(*subscription, peer.access));
  }
  peer.listed_version = 0;  // a peer that follows the list gets the one that it may see now
}

void Subscribers::RemovePeer(Peer& peer) {
  // Of() copies the pointers first, since Erase() changes the table.
  for (Subscription* subscription : table_.Of(peer)) Erase(*subscription);
}

void Subscribers::RemovePeer(Peer& peer, protocol::GoodbyeReason goodbye) {
  for (const Subscription* subscription : table_.Of(peer)) {
    messages_->SendReply(peer,
                         {.stream = subscription->id, .sequence = subscription->request_sequence},
                         protocol::Goodbye{goodbye});
  }
  RemovePeer(peer);
}

std::optional<std::vector<SavedSubscription>> Subscribers::Save(const Peer& peer) const {
  std::vector<SavedSubscription> saved;
  protocol::Encoder encoder;
  for (const Subscription* each : table_.Of(peer)) {
    const protocol::Header header{.session = each->request_session,
                                  .sequence = each->request_sequence};
    const auto rate = static_cast<float>(
        std::min(each->gate.max_rate(), static_cast<double>(protocol::kMaxRateHz)));
    SavedMessage request;
    if (const auto* weights = std::get_if<WeightsRequest>(&each->request)) {
      encoder.Encode(header,
                     protocol::SubscribeWeights{.subject = each->subject_name,
                                                .wait = each->wait,
                                                .pattern = weights->pattern,
                                                .max_rate_hz = rate,
                                                .format = weights->format,
                                                .source = weights->source,
                                                .every = each->every},
                     request);
    } else if (std::holds_alternative<PoseRequest>(each->request)) {
      encoder.Encode(header,
                     protocol::SubscribePoses{.subject = each->subject_name,
                                              .wait = each->wait,
                                              .max_rate_hz = rate,
                                              .every = each->every},
                     request);
    } else {
      return std::nullopt;
    }
    saved.push_back({each->id, std::move(request)});
  }
  return saved;
}

void Subscribers::Resume(Peer& peer, const SavedSubscription& saved) {
  protocol::MessageView view;
  if (protocol::OpenMessage(saved.request, view) != protocol::DecodeStatus::kOk) return;
  // The table gives the next number.
  peer.last_subscription = static_cast<std::uint16_t>(saved.id - 1);
  if (view.kind == protocol::MessageKind::kSubscribeWeights) {
    protocol::SubscribeWeights request;
    if (Decode(view, request) == protocol::DecodeStatus::kOk) {
      Subscribe(peer, view.header, request);
    }
  } else if (view.kind == protocol::MessageKind::kSubscribePoses) {
    protocol::SubscribePoses request;
    if (Decode(view, request) == protocol::DecodeStatus::kOk) {
      Subscribe(peer, view.header, request);
    }
  }
}

void Subscribers::OnSubjectReady(Subject& subject) {
  const auto needs_reply = [&subject](Subscription& subscription) {
    // A waiting subscription: it accepts this subject by name, or any.
    if (subscription.subject == nullptr) {
      return (subscription.subject_name.empty() || subscription.subject_name == subject.name) &&
             subscription.peer->access.MayWatch(subject.name);
    }
    if (subscription.subject != &subject) return false;
    if (const auto* poses = std::get_if<PoseRequest>(&subscription.request)) {
      return !PoseRelay::IsCurrent(*poses, subject);
    }
    auto* weights = std::get_if<WeightsRequest>(&subscription.request);
    if (weights == nullptr) return false;
    // A restart with the same skeleton keeps the names. Then the client needs no new reply.
    const std::uint64_t before = weights->names_hash;
    weights->Bind(*subject.pipeline->stream().binding);  // the indices may change, too
    return weights->names_hash != before;
  };
  // In the order of their requests, and so are their frames later: a recorder that subscribes to
  // poses before weights receives each pose before its weights.
  for (Subscription* subscription : table_.Select(needs_reply)) Bind(*subscription, subject);
  UpdateDriverLevel(subject);
}

void Subscribers::OnSubjectGone(Subject& subject) {
  for (Subscription* subscription : table_.DetachAll(subject)) {
    messages_->SendReply(*subscription->peer,
                         {.stream = subscription->id, .sequence = subscription->request_sequence},
                         protocol::Goodbye{protocol::GoodbyeReason::kSubjectGone});
    // The subject is about to be freed. The subscription waits again, or ends.
    subscription->owed = false;
    if (auto* poses = std::get_if<PoseRequest>(&subscription->request)) *poses = {};
    if (!subscription->wait) Erase(*subscription);
  }
}

void Subscribers::SendElsewhere(Subscription& subscription, const NodeAddress& node) {
  const std::string name =
      subscription.subject != nullptr ? subscription.subject->name : subscription.subject_name;
  messages_->SendElsewhere(*subscription.peer,
                           {.stream = subscription.id, .sequence = subscription.request_sequence},
                           ErrorCode::kUnknownSubject, ElsewhereText(name, node), node);
}

void Subscribers::OnSubjectMoved(Subject& subject, const NodeAddress& node) {
  const std::vector<Subscription*> subscriptions = subject.subscriptions;
  for (Subscription* subscription : subscriptions) {
    // One for the oldest subject finds another one here.
    if (subscription->subject_name.empty()) continue;
    SendElsewhere(*subscription, node);
    Erase(*subscription);
  }
}

void Subscribers::SendWaitingElsewhere() {
  const auto waits = [](const Subscription& each) {
    return each.subject == nullptr && !each.subject_name.empty();
  };
  for (Subscription* subscription : table_.Select(waits)) {
    const Place place = places_->Elsewhere(subscription->subject_name);
    if (place.kind != Place::Kind::kElsewhere) continue;
    SendElsewhere(*subscription, place.node);
    Erase(*subscription);
  }
}

void Subscribers::OnEpoch(Subject& subject) {
  for (Subscription* subscription : subject.subscriptions) ReplyAgain(*subscription);
}

void Subscribers::BindWaiting() {
  const auto waits_for_any = [](const Subscription& each) {
    return each.subject == nullptr && each.subject_name.empty();
  };
  for (Subscription* subscription : table_.Select(waits_for_any)) {
    Subject* const oldest = subjects_->First(subscription->peer->access);
    if (oldest != nullptr) Bind(*subscription, *oldest);
  }
}

}  // namespace furrow::server
