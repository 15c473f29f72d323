// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/arrivals.h"

#include <iterator>
#include <utility>

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

// The senders of offers repeat them much sooner.
constexpr Time kOfferPatience = std::chrono::seconds(3);

}  // namespace

std::size_t Arrivals::BytesOf(const States::value_type& kept) {
  constexpr std::size_t kOfEntry = 256;
  return kOfEntry + kept.first.size() + kept.second.payload.size();
}

Arrivals::States::iterator Arrivals::Forget(States::iterator kept) {
  bytes_ -= BytesOf(*kept);
  return states_.erase(kept);
}

// A copy may be late: of the same conversation, or of an earlier one, whose numbers do not compare.
bool Arrivals::IsOlder(const protocol::SubjectState& state, const protocol::Header& header,
                       const Kept& kept) {
  if (header.session == kept.header.session) return header.sequence < kept.header.sequence;
  // The numbers of poses wrap around.
  return state.publisher_session == kept.publisher_session &&
         static_cast<std::int32_t>(state.newest_sequence - kept.newest_sequence) < 0;
}

bool Arrivals::Add(const protocol::SubjectState& state, const protocol::MessageView& view,
                   Time now) {
  Expire(now);
  if (view.payload.size() > protocol::kMaxUdpMessageBytes) return false;
  const auto known = states_.find(state.subject);
  if (known != states_.end() && IsOlder(state, view.header, known->second)) return true;
  States::value_type kept(state.subject, {.header = view.header,
                                          .payload = {view.payload.begin(), view.payload.end()},
                                          .publisher_session = state.publisher_session,
                                          .newest_sequence = state.newest_sequence,
                                          .reserved_until = now + kReserved,
                                          .until = now + kPatience});
  const std::size_t former = known == states_.end() ? 0 : BytesOf(*known);
  if (bytes_ - former + BytesOf(kept) > kMaxBytes) return false;
  if (known != states_.end()) (void)Forget(known);
  bytes_ += BytesOf(kept);
  states_.insert(std::move(kept));
  // Another sender that asked first gets no place before the publisher.
  const auto waiting = waiting_.find(state.subject);
  if (waiting != waiting_.end() && waiting->second.offer.session != state.publisher_session) {
    waiting_.erase(waiting);
  }
  return true;
}

void Arrivals::Drop(std::string_view subject) {
  if (const auto kept = states_.find(subject); kept != states_.end()) (void)Forget(kept);
}

bool Arrivals::IsReserved(std::string_view subject, std::uint64_t session, Time now) const {
  const auto kept = states_.find(subject);
  return kept != states_.end() && kept->second.publisher_session != session &&
         now < kept->second.reserved_until;
}

std::optional<Arrivals::Arrived> Arrivals::Take(std::string_view subject, Time now) {
  const auto kept = states_.find(subject);
  if (kept == states_.end()) return std::nullopt;
  Arrived arrived{kept->second.header, {}};
  const protocol::MessageView view{.header = kept->second.header,
                                   .kind = protocol::MessageKind::kSubjectState,
                                   .payload = kept->second.payload};
  const bool is_good = now < kept->second.until &&
                       protocol::Decode(view, arrived.state) == protocol::DecodeStatus::kOk;
  (void)Forget(kept);
  return is_good ? std::optional(std::move(arrived)) : std::nullopt;
}

void Arrivals::Await(const std::string& subject, PeerId peer, const protocol::Header& offer,
                     std::uint64_t skeleton_hash, Time now) {
  if (waiting_.size() >= kMaxWaiting && !waiting_.contains(subject)) return;
  waiting_.insert_or_assign(subject, Waiting{peer, offer, skeleton_hash, now + kOfferPatience});
}

void Arrivals::StopWaiting(std::string_view subject) {
  if (const auto known = waiting_.find(subject); known != waiting_.end()) waiting_.erase(known);
}

void Arrivals::Expire(Time now) {
  for (auto kept = states_.begin(); kept != states_.end();) {
    kept = now >= kept->second.until ? Forget(kept) : std::next(kept);
  }
  std::erase_if(waiting_, [now](const auto& each) { return now >= each.second.until; });
}

}  // namespace furrow::server
