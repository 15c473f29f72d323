// SPDX-License-Identifier: Apache-2.0
#include "server/session/restart.h"

#include <algorithm>
#include <utility>

#include "protocol/codec/codec.h"
#include "server/session/subjects/subject_state.h"

namespace furrow::server {
namespace {

using protocol::DecodeStatus;

SavedMessage OfferOf(const Subject& subject) {
  protocol::SkeletonOffer offer = *subject.offer;
  offer.subject = subject.name;
  SavedMessage message;
  // A subject without a stream has no session, and no message goes without one.
  protocol::Encoder().Encode({.session = std::max<std::uint64_t>(subject.owner.session, 1),
                              .stream = subject.owner.stream},
                             offer, message);
  return message;
}

SavedMessage EncodedStateOf(const Subject& subject) {
  protocol::Header header = StateHeader(subject, 0);
  header.session = 1;
  SavedMessage message;
  protocol::Encoder().Encode(header, StateOf(subject), message);
  return message;
}

template <class Message>
bool Read(const SavedMessage& bytes, protocol::MessageView& view, Message& message) {
  return protocol::OpenMessage(bytes, view) == DecodeStatus::kOk &&
         protocol::Decode(view, message) == DecodeStatus::kOk;
}

}  // namespace

bool Restart::MaySave(const Peer& peer) const {
  return peer.access.admitted() && !peer.token_ended && parts_.subscribers->Save(peer).has_value();
}

std::optional<SavedPeer> Restart::Save(Peer& peer) const {
  auto subscriptions = parts_.subscribers->Save(peer);
  if (!subscriptions || peer.token_ended || !peer.access.admitted()) return std::nullopt;
  SavedPeer saved{.id = peer.id,
                  .consent = peer.consent.answered(),
                  .last_heard = peer.last_heard,
                  .last_subscription = peer.last_subscription,
                  .follows_list = peer.list_request.has_value(),
                  .list_sequence = peer.list_request ? peer.list_request->sequence : 0,
                  .access = {},
                  .subscriptions = *std::move(subscriptions)};
  if (peer.access.by_token()) {
    saved.access = SavedAccess{peer.access.grant(), peer.access.key_id(), peer.access.expires()};
  }
  peer.goes_on_elsewhere = true;
  return saved;
}

std::vector<SavedSubject> Restart::SaveSubjects(Time now) {
  std::vector<SavedSubject> all;
  for (const auto& subject : parts_.subjects->all()) {
    // Publishers do not send the poses that wait for their time again.
    parts_.router->ReleaseStream(parts_.shards->Of(subject->owner.peer), subject->owner, now);
    all.push_back({.owner = subject->owner.peer,
                   .host = subject->host,
                   .last_pose = subject->last_pose,
                   .last_update = subject->last_update,
                   .last_no_face = subject->last_no_face,
                   .no_face = subject->no_face,
                   .ended = subject->ended,
                   .lost = subject->lost,
                   .needs_all_drivers = subject->needs_all_drivers,
                   .offer = OfferOf(*subject),
                   .state = EncodedStateOf(*subject)});
  }
  return all;
}

void Restart::Resume(const SavedSubject& saved, Peer* owner, Time away, Time now) {
  protocol::MessageView offer_view;
  protocol::MessageView state_view;
  protocol::SkeletonOffer offer;
  protocol::SubjectState state;
  if (!Read(saved.offer, offer_view, offer) || !Read(saved.state, state_view, state)) return;
  if (state.subject != offer.subject) return;
  if (!state.captures.empty()) parts_.adopt_captures(state, now);
  // Its publisher comes back, or the subject leaves like any other that is not sent.
  Peer nobody;
  nobody.name = "the former daemon";
  nobody.host = saved.host;
  nobody.access = Access::Everything();
  Subject* const subject =
      parts_.router->Resume(owner != nullptr ? *owner : nobody, offer_view.header, offer,
                            {state_view.header, state}, now);
  if (subject == nullptr) return;
  subject->last_pose = saved.last_pose + away;
  subject->last_update = saved.last_update + away;
  if (saved.last_no_face != Time{0}) subject->last_no_face = saved.last_no_face + away;
  subject->no_face = saved.no_face;
  subject->ended = saved.ended;
  subject->lost = saved.lost;
  subject->needs_all_drivers = saved.needs_all_drivers;
  if (owner == nullptr) {
    parts_.subjects->Release(*subject);
    subject->orphaned = true;
  }
  parts_.subscribers->UpdateDriverLevel(*subject);
}

void Restart::Resume(Peer& peer, const SavedPeer& saved, Time away) {
  peer.consent.Begin(saved.consent + away);
  peer.last_heard = saved.last_heard + away;
  if (saved.follows_list) peer.list_request = protocol::Header{.sequence = saved.list_sequence};
  for (const SavedSubscription& subscription : saved.subscriptions) {
    parts_.subscribers->Resume(peer, subscription);
  }
  peer.last_subscription = saved.last_subscription;
}

}  // namespace furrow::server
