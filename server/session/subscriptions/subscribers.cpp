// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/subscribers.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::server {

using protocol::ErrorCode;

namespace {

// Why so many names cannot be answered; empty where they can.
std::string Oversize(const std::vector<std::string>& names, Transport transport) {
  if (names.size() > protocol::kMaxWeights) {
    return std::to_string(names.size()) + " weights, at most " +
           std::to_string(protocol::kMaxWeights) + " go into a subscription: take several";
  }
  constexpr std::size_t kPerName = 12;  // offset, length, end and padding
  std::size_t bytes = 0;
  for (const std::string& name : names) bytes += name.size() + kPerName;
  if (transport != Transport::kUdp || bytes + kPerName * 100 <= protocol::kMaxUdpMessageBytes) {
    return {};
  }
  return "weights whose names have " + std::to_string(bytes) +
         " bytes, more than UDP carries: take several subscriptions, or TCP";
}

}  // namespace

Subscribers::Subscribers(const Limits& limits, SubjectRegistry* subjects, PictureSource* pictures,
                         const render::Settings& settings, bool all_drivers, Desk* desk,
                         Metrics* metrics)
    : limits_(limits),
      subjects_(subjects),
      pictures_(pictures),
      settings_(settings),
      all_drivers_(all_drivers),
      desk_(desk),
      postman_(&desk->postman),
      metrics_(metrics) {}

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribeWeights& request) {
  if (!MayAdd(peer, header)) return;
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  subscription->wish = WeightsWish{.pattern = request.pattern,
                                   .format = request.format,
                                   .source = request.source,
                                   .indices = {},
                                   .names_hash = 0};
  subscription->every = request.every && peer.transport != Transport::kUdp;
  Add(peer, header, std::move(subscription));
}

void Subscribers::Subscribe(Peer& peer, const protocol::Header& header,
                            const protocol::SubscribePictures& request) {
  if (peer.transport == Transport::kUdp) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    postman_->Error(peer, header, ErrorCode::kNeedsTcp, "pictures go over TCP or a WebSocket");
    return;
  }
  if (!MayAdd(peer, header)) return;
  if (pictures_ == nullptr) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    postman_->Error(peer, header, ErrorCode::kNotRendering,
                    "this daemon draws no pictures: it has no character or no OpenGL");
    return;
  }
  Result<PicturesWish> wish = MakeWish(request);
  if (!wish.ok()) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    postman_->Error(peer, header, ErrorCode::kBadPicture, wish.status().ToString());
    return;
  }
  auto subscription = std::make_unique<Subscription>();
  subscription->subject_name = request.subject;
  subscription->wait = request.wait;
  subscription->gate = RateGate(request.max_rate_hz);
  wish->view_request = header.sequence;
  if (request.acknowledged) wish->flow.emplace();
  subscription->wish = *std::move(wish);
  Add(peer, header, std::move(subscription));
}

// Proof of address, repetition, limits: what both kinds of request share. False: already answered.
bool Subscribers::MayAdd(Peer& peer, const protocol::Header& header) {
  if (peer.transport == Transport::kUdp && !peer.credit.proven()) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    postman_->Error(peer, header, ErrorCode::kUnprovenAddress,
                    "say Hello with the token of Welcome first");
    return false;
  }
  if (Subscription* known = FindRepeated(peer, header); known != nullptr) {
    if (auto* wish = std::get_if<PosesWish>(&known->wish);
        wish != nullptr && known->subject != nullptr) {
      BindPoses(*known, *wish, *known->subject);
      return false;
    }
    std::vector<std::string> names;
    if (const auto* wish = std::get_if<WeightsWish>(&known->wish);
        wish != nullptr && known->subject != nullptr) {
      const auto all = wish->Names(*known->subject->pipeline->stream().binding);
      for (const std::uint32_t index : wish->indices) names.push_back(all[index]);
    }
    Reply(*known, std::move(names));
    return false;
  }
  if (peer.num_subscriptions >= limits_.max_subscriptions) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    postman_->Error(peer, header, ErrorCode::kLimit,
                    "at most " + std::to_string(limits_.max_subscriptions) + " subscriptions");
    return false;
  }
  return true;
}

Subscription* Subscribers::Find(const Peer& peer, std::uint16_t id) {
  for (auto& [uid, subscription] : subscriptions_) {
    if (subscription->peer == &peer && subscription->id == id) return subscription.get();
  }
  return nullptr;
}

Subscription* Subscribers::FindRepeated(const Peer& peer, const protocol::Header& header) {
  if (peer.num_subscriptions == 0) return nullptr;
  for (auto& [uid, subscription] : subscriptions_) {
    if (subscription->peer == &peer && subscription->session == header.session &&
        subscription->request == header.sequence) {
      return subscription.get();
    }
  }
  return nullptr;
}

void Subscribers::Add(Peer& peer, const protocol::Header& header,
                      std::unique_ptr<Subscription> subscription) {
  const std::string& name = subscription->subject_name;
  Subject* subject = name.empty() ? subjects_->First() : subjects_->Find(name);
  if (subject == nullptr && !subscription->wait) {
    metrics_->Add(Counter::kSubscriptionsRefused);
    const std::string known = subjects_->Names();
    postman_->Error(peer, header, ErrorCode::kUnknownSubject,
                    (name.empty() ? "there is no subject" : "no subject '" + name + "'") +
                        (known.empty() ? "; none is here" : "; here are: " + known));
    return;
  }
  subscription->uid = next_uid_++;
  subscription->peer = &peer;
  subscription->id = NewId(peer);
  subscription->session = header.session;
  subscription->request = header.sequence;
  Subscription& added = *subscription;
  subscriptions_.emplace(added.uid, std::move(subscription));
  ++peer.num_subscriptions;
  if (subject == nullptr) {
    Reply(added, {});
  } else if (!Bind(added, *subject)) {
    return;
  }
  metrics_->Add(Counter::kSubscriptionsAccepted);
}

std::uint16_t Subscribers::NewId(Peer& peer) {
  const auto is_taken = [&](std::uint16_t id) {
    return std::ranges::any_of(subscriptions_, [&](const auto& entry) {
      return entry.second->peer == &peer && entry.second->id == id;
    });
  };
  do {
    ++peer.last_subscription;
  } while (peer.last_subscription == 0 || is_taken(peer.last_subscription));
  return peer.last_subscription;
}

void Subscribers::Reply(const Subscription& subscription, std::vector<std::string> names) {
  protocol::SubscribeReply reply;
  if (subscription.subject != nullptr) reply.subject = subscription.subject->name;
  if (const auto* poses = std::get_if<PosesWish>(&subscription.wish)) {
    reply.publisher_session = poses->publisher;
  }
  reply.names_hash = protocol::NamesHash(names);
  reply.names = std::move(names);
  postman_->Reply(*subscription.peer, {.stream = subscription.id, .sequence = subscription.request},
                  reply);
}

bool Subscribers::Bind(Subscription& subscription, Subject& subject) {
  if (auto* wish = std::get_if<PosesWish>(&subscription.wish); wish != nullptr) {
    return BindPoses(subscription, *wish, subject);
  }
  std::vector<std::string> names;
  if (auto* wish = std::get_if<WeightsWish>(&subscription.wish); wish != nullptr) {
    names = wish->Bind(*subject.pipeline->stream().binding);
    if (names.empty()) {
      Refuse(subscription, ErrorCode::kNoMatch,
             "'" + wish->pattern + "' names no weight of the rig");
      return false;
    }
    if (std::string why = Oversize(names, subscription.peer->transport); !why.empty()) {
      Refuse(subscription, ErrorCode::kLimit, "'" + wish->pattern + "' names " + why);
      return false;
    }
  }
  Attach(subscription, subject);
  Reply(subscription, std::move(names));
  return true;
}

void Subscribers::Attach(Subscription& subscription, Subject& subject) {
  if (subscription.subject != &subject) {
    subscription.subject = &subject;
    by_subject_[subject.id].push_back(&subscription);
  }
  UpdateLevel(subject);
  subscription.owed = subject.pipeline->has_pose();  // the newest pose there is, at the next tick
}

// The drivers that are needed, and no more, from the rig's first on.
void Subscribers::UpdateLevel(Subject& subject) {
  std::size_t needed = all_drivers_ || subject.in_full ? wrinkle::kAllDrivers : 0;
  for (const Subscription* subscription : by_subject_[subject.id]) {
    if (const auto* wish = std::get_if<WeightsWish>(&subscription->wish)) {
      needed = std::max(needed, wish->num_drivers);
    } else if (std::holds_alternative<PicturesWish>(subscription->wish)) {
      needed = wrinkle::kAllDrivers;
    }
  }
  subject.pipeline->SetLevel(needed);
}

void Subscribers::Refuse(Subscription& subscription, ErrorCode code, std::string why) {
  metrics_->Add(Counter::kSubscriptionsRefused);
  postman_->Error(*subscription.peer, {.stream = subscription.id, .sequence = subscription.request},
                  code, std::move(why));
  Erase(subscription);
}

void Subscribers::Erase(Subscription& subscription) {
  if (subscription.subject != nullptr) {
    std::erase(by_subject_[subscription.subject->id], &subscription);
    UpdateLevel(*subscription.subject);
  }
  subscription.peer->link->DropFrames(subscription.uid);
  --subscription.peer->num_subscriptions;
  subscriptions_.erase(subscription.uid);
}

bool Subscribers::Unsubscribe(Peer& peer, std::uint16_t id) {
  Subscription* subscription = Find(peer, id);
  if (subscription == nullptr) return false;
  Erase(*subscription);
  return true;
}

void Subscribers::RemovePeer(Peer& peer) {
  // The way of every forged address that is evicted: it costs nothing.
  if (peer.num_subscriptions == 0) return;
  std::vector<Subscription*> ending;
  for (auto& [uid, subscription] : subscriptions_) {
    if (subscription->peer == &peer) ending.push_back(subscription.get());
  }
  for (Subscription* subscription : ending) Erase(*subscription);
}

void Subscribers::RemovePeer(Peer& peer, protocol::GoodbyeReason goodbye) {
  for (auto& [uid, subscription] : subscriptions_) {
    if (subscription->peer != &peer) continue;
    postman_->Reply(peer, {.stream = subscription->id, .sequence = subscription->request},
                    protocol::Goodbye{goodbye});
  }
  RemovePeer(peer);
}

void Subscribers::OnSubjectReady(Subject& subject) {
  std::vector<Subscription*> to_bind;
  for (auto& [uid, subscription] : subscriptions_) {
    const bool waits =
        subscription->subject == nullptr &&
        (subscription->subject_name.empty() || subscription->subject_name == subject.name);
    if (waits) to_bind.push_back(subscription.get());
  }
  for (Subscription* subscription : by_subject_[subject.id]) {
    if (const auto* poses = std::get_if<PosesWish>(&subscription->wish)) {
      const bool is_told = poses->publisher == subject.owner.session &&
                           poses->skeleton_hash == subject.skeleton_hash;
      if (!is_told) to_bind.push_back(subscription);
      continue;
    }
    auto* wish = std::get_if<WeightsWish>(&subscription->wish);
    if (wish == nullptr) continue;
    const std::uint64_t before = wish->names_hash;
    wish->Bind(*subject.pipeline->stream().binding);
    if (wish->names_hash != before) to_bind.push_back(subscription);
  }
  // In the order in which they were asked for, and so are their frames: a recorder that asks for
  // poses before weights has each pose before what was made of it.
  std::ranges::sort(to_bind, {}, &Subscription::uid);
  for (Subscription* subscription : to_bind) Bind(*subscription, subject);
  UpdateLevel(subject);
}

void Subscribers::OnSubjectGone(Subject& subject) {
  const std::vector<Subscription*> watching = std::move(by_subject_[subject.id]);
  by_subject_.erase(subject.id);
  for (Subscription* subscription : watching) {
    postman_->Reply(*subscription->peer,
                    {.stream = subscription->id, .sequence = subscription->request},
                    protocol::Goodbye{protocol::GoodbyeReason::kSubjectGone});
    subscription->subject = nullptr;
    subscription->owed = false;
    if (auto* poses = std::get_if<PosesWish>(&subscription->wish)) *poses = {};
    if (!subscription->wait) Erase(*subscription);
  }
}

void Subscribers::BindWaiting() {
  Subject* first = subjects_->First();
  if (first == nullptr) return;
  std::vector<Subscription*> waiting;
  for (auto& [uid, subscription] : subscriptions_) {
    const bool for_anybody = subscription->subject == nullptr && subscription->subject_name.empty();
    if (for_anybody) waiting.push_back(subscription.get());
  }
  std::ranges::sort(waiting, {}, &Subscription::uid);
  for (Subscription* subscription : waiting) Bind(*subscription, *first);
}

}  // namespace furrow::server
