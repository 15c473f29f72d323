// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/publisher.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>

#include "protocol/codec/offer_check.h"
#include "protocol/framing/envelope.h"
#include "protocol/messages/error_text.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

// A flood of messages must not keep Poll() from returning.
constexpr int kMostAnswers = 256;

}  // namespace

std::uint64_t NewSession() {
  std::random_device random;
  std::uint64_t session = 0;
  while (session == 0) session = (std::uint64_t{random()} << 32) | random();
  return session;
}

Publisher::Publisher(std::unique_ptr<Transport> transport, std::string name)
    : transport_(std::move(transport)),
      session_(NewSession()),
      introduction_(transport_.get(), std::move(name), session_),
      generation_(transport_->generation()) {}

std::uint16_t Publisher::AddSubject(const protocol::SkeletonOffer& offer, std::int64_t now_us) {
  const auto number = static_cast<std::uint16_t>(streams_.size());
  Stream& stream = streams_.emplace_back();
  stream.skeleton_hash = protocol::SkeletonHash(offer);
  // Encoded once and kept, because lost or unanswered offers are sent again.
  encoder_.Encode({.session = session_, .stream = number}, offer, stream.offer);
  // A daemon does not answer malformed datagrams, so check the offer here.
  stream.rejection = protocol::FindOfferProblem(stream.offer);
  if (stream.rejection.empty() && transport_->kind() == TransportKind::kUdp &&
      stream.offer.size() > protocol::kMaxUdpMessageBytes) {
    OnOversized(stream);
  }
  if (!stream.rejection.empty()) return number;
  if (introduction_.proven()) {
    SendOffer(stream, now_us);
  } else if (!introduced_us_) {
    Introduce(now_us);
  }
  return number;
}

void Publisher::OnOversized(Stream& stream) {
  stream.oversized = true;
  stream.rejection = "the skeleton offer has " + std::to_string(stream.offer.size()) +
                     " bytes, more than UDP carries; use TCP";
}

void Publisher::SendOffer(Stream& stream, std::int64_t now_us) {
  // Also after a failed send: the interval to the next attempt begins now.
  stream.offered_us = now_us;
  // Poll() repeats the offer until it is answered, so other send failures do not matter.
  if (transport_->Send(stream.offer) == IoStatus::kTooLarge) OnOversized(stream);
}

// The daemon drops offers beyond 1,000 per second, so those of many streams take turns.
void Publisher::RepeatOffers(std::int64_t now_us) {
  if (now_us - round_us_ >= protocol::kOfferResendMicroseconds) {
    round_us_ = now_us;
    offers_left_ = kOffersPerRound;
  }
  const std::size_t first = next_offer_;
  for (std::size_t i = 0; i < streams_.size() && offers_left_ > 0; ++i) {
    const std::size_t number = (first + i) % streams_.size();
    Stream& stream = streams_[number];
    const bool due = now_us - stream.offered_us >= protocol::kOfferResendMicroseconds;
    if (stream.accepted || !stream.rejection.empty() || !due) continue;
    SendOffer(stream, now_us);
    --offers_left_;
    next_offer_ = number + 1;
  }
}

IoStatus Publisher::Send(std::uint16_t number, protocol::PoseFrame& pose,
                         std::int64_t capture_time_us, const protocol::PoseEncoding& encoding,
                         bool repeat_previous) {
  Stream& stream = streams_.at(number);
  pose.skeleton_hash = stream.skeleton_hash;
  pose.previous.clear();
  const protocol::Header header{.session = session_,
                                .stream = number,
                                .sequence = stream.next_sequence++,
                                .capture_time_us = capture_time_us};
  const bool repeats = repeat_previous && transport_->kind() == TransportKind::kUdp;
  encoder_.Encode(header, pose, bytes_, repeats ? protocol::PoseEncoding::Small() : encoding);
  if (repeats) {
    RepeatPrevious(stream, header, pose);
  } else {
    stream.previous.clear();
  }
  if (!moving_since_us_) return transport_->Send(bytes_);
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back(bytes_);
  return IoStatus::kOk;
}

// Adds the stream's last pose to the encoded `pose` if there is room, and keeps `pose` for the next
// one.
void Publisher::RepeatPrevious(Stream& stream, const protocol::Header& header,
                               protocol::PoseFrame& pose) {
  alone_.swap(bytes_);
  const std::int64_t age_us = header.capture_time_us - stream.previous_capture_us;
  const bool fits = !stream.previous.empty() && age_us >= 0 && age_us <= UINT32_MAX &&
                    alone_.size() + stream.previous.size() <= protocol::kMaxDatagramBytes;
  if (fits) {
    pose.previous = stream.previous;
    pose.previous_age_us = static_cast<std::uint32_t>(age_us);
    encoder_.Encode(header, pose, bytes_, protocol::PoseEncoding::Small());
    pose.previous.clear();
  }
  // The table around the previous pose takes some bytes, too.
  if (!fits || bytes_.size() > protocol::kMaxDatagramBytes) bytes_ = alone_;
  stream.previous.clear();
  if (!pose.partial) {
    stream.previous.assign(alone_.begin() + protocol::kEnvelopeBytes, alone_.end());
  }
  stream.previous_capture_us = header.capture_time_us;
}

// A server that is frozen, or whose computer is gone, looks like one that has nothing to say.
void Publisher::WatchServer(std::int64_t now_us) {
  constexpr std::int64_t kAskUs = 500'000;
  constexpr std::int64_t kSilenceUs = 2'000'000;
  // Without others, there is nothing to do about it. A program that did not poll has not listened.
  if (!transport_->has_others() || now_us - watched_us_ > kSilenceUs) heard_us_ = now_us;
  watched_us_ = now_us;
  if (now_us - heard_us_ > kSilenceUs) {
    heard_us_ = now_us;
    transport_->Abandon();
  } else if (transport_->has_others() && introduction_.proven() && now_us - asked_us_ >= kAskUs) {
    asked_us_ = now_us;
    encoder_.Encode({.session = session_}, protocol::Ping{.time_us = now_us}, bytes_);
    (void)transport_->Send(bytes_);
  }
}

// Over UDP, others may send as if they were the daemon. They do not know its session.
bool Publisher::IsFromServer(const protocol::Header& header) const {
  return transport_->kind() == TransportKind::kTcp || header.session == server_session_;
}

// True if the publisher goes on at another server. One with several subjects cannot: it has one
// connection for all of them.
bool Publisher::Follow(const protocol::Header& header) {
  if (!SendsElsewhere(error_) || !introduction_.proven() || streams_.size() != 1) return false;
  if (!IsFromServer(header) || header.stream != 0) return false;
  return transport_->GoTo({error_.host, error_.tcp, error_.udp});
}

// A pose that comes late is better than none, and each answer of the next server is a pose late.
std::chrono::milliseconds Publisher::MovePause() const {
  return std::chrono::milliseconds(moving_since_us_ ? 5 : 0);
}

void Publisher::EndMove() {
  if (!std::exchange(moving_since_us_, std::nullopt)) return;
  for (const std::vector<std::uint8_t>& pose : waiting_) (void)transport_->Send(pose);
  waiting_.clear();
}

IoStatus Publisher::Poll(std::int64_t now_us, std::chrono::milliseconds wait) {
  WatchServer(now_us);
  if (introduction_.proven()) {
    RepeatOffers(now_us);
  } else if (introduced_us_ && now_us - *introduced_us_ >= protocol::kOfferResendMicroseconds) {
    Introduce(now_us);
  }
  if (moving_since_us_ && now_us - *moving_since_us_ > kMovePatience) {
    moving_since_us_.reset();
    waiting_.clear();
  }
  std::span<const std::uint8_t> message;
  IoStatus status = transport_->Receive(message, std::max(wait, MovePause()));
  for (int handled = 1;; ++handled) {
    const bool starts_over = transport_->generation() != generation_;
    if (starts_over) StartOver(now_us);
    if (status == IoStatus::kOk) {
      heard_us_ = now_us;
      Handle(message, now_us);
    } else if (!starts_over || !moving_since_us_) {
      return status;
    }
    if (handled == kMostAnswers) return IoStatus::kOk;
    // Reads all waiting answers. A timeout after the first one is not a timeout of this call.
    const IoStatus more = transport_->Receive(message, MovePause());
    if (more == IoStatus::kTimeout && transport_->generation() == generation_) return status;
    status = more;
  }
}

void Publisher::Handle(std::span<const std::uint8_t> message, std::int64_t now_us) {
  using protocol::DecodeStatus;
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) != DecodeStatus::kOk) return;
  switch (view.kind) {
    case protocol::MessageKind::kError:
      if (protocol::Decode(view, error_) == DecodeStatus::kOk) OnError(view.header, now_us);
      return;
    case protocol::MessageKind::kWelcome:
      if (protocol::Decode(view, welcome_) == DecodeStatus::kOk &&
          introduction_.OnWelcome(welcome_)) {
        server_session_ = view.header.session;
        OfferAll(now_us);
      }
      if (IsFromServer(view.header)) RememberOthers(welcome_, introduction_, *transport_);
      return;
    case protocol::MessageKind::kPing:
      if (protocol::Decode(view, ping_) == DecodeStatus::kOk) introduction_.OnPing(ping_);
      return;
    case protocol::MessageKind::kSkeletonReply:
      if (protocol::Decode(view, reply_) == DecodeStatus::kOk) OnReply(view.header, now_us);
      return;
    default: return;
  }
}

void Publisher::OnReply(const protocol::Header& header, std::int64_t now_us) {
  if (header.stream >= streams_.size()) return;
  Stream& stream = streams_[header.stream];
  // A late answer to an earlier offer of this stream number.
  if (reply_.skeleton_hash != stream.skeleton_hash) return;
  switch (reply_.status) {
    case protocol::SkeletonStatus::kAccepted:
      stream.accepted = true;
      needs_token_ = false;
      EndMove();
      break;
    case protocol::SkeletonStatus::kRejected:
      stream.rejection = reply_.message.empty() ? "the daemon gave no reason" : reply_.message;
      break;
    // The daemon has restarted or forgotten the stream.
    case protocol::SkeletonStatus::kNeeded:
      stream.accepted = false;
      SendOffer(stream, now_us);
      break;
  }
}

void Publisher::OfferAll(std::int64_t now_us) {
  for (Stream& stream : streams_) {
    stream.accepted = false;
    if (stream.rejection.empty()) SendOffer(stream, now_us);
  }
}

// Says Hello again if the daemon does not know the address, for example after a restart. Each pose
// on its way then earns this error, and only the first one counts.
void Publisher::OnError(const protocol::Header& header, std::int64_t now_us) {
  if (Follow(header)) {
    if (!moving_since_us_) moving_since_us_ = now_us;
    return;
  }
  if (error_.code != protocol::ErrorCode::kUnprovenAddress) {
    last_error_ = protocol::SentenceOf(error_);
    needs_token_ |= error_.code == protocol::ErrorCode::kNeedsToken;
  } else if (introduction_.proven() && transport_->kind() == TransportKind::kUdp) {
    introduction_.Restart();
    Introduce(now_us);
  }
}

void Publisher::Introduce(std::int64_t now_us) {
  introduced_us_ = now_us;
  introduction_.SendHello();
}

// The transport has another connection, and the daemon knows nothing of it.
void Publisher::StartOver(std::int64_t now_us) {
  generation_ = transport_->generation();
  introduction_.Restart();
  if (introduction_.proven()) {
    OfferAll(now_us);
  } else if (!streams_.empty()) {
    Introduce(now_us);
  }
}

void Publisher::SendGoodbye(std::size_t stream) {
  encoder_.Encode({.session = session_,
                   .stream = static_cast<std::uint16_t>(stream),
                   .sequence = streams_[stream].next_sequence},
                  protocol::Goodbye{}, bytes_);
  (void)transport_->Send(bytes_);  // a lost goodbye is harmless: the daemon times out
}

void Publisher::Withdraw(std::uint16_t stream, const std::string& why) {
  Stream& withdrawn = streams_.at(stream);
  if (withdrawn.rejection.empty()) SendGoodbye(stream);
  withdrawn.accepted = false;
  withdrawn.rejection = why;
}

void Publisher::Close() {
  for (std::size_t i = 0; i < streams_.size(); ++i) SendGoodbye(i);
  streams_.clear();
}

bool Publisher::accepted(std::uint16_t stream) const { return streams_.at(stream).accepted; }

bool Publisher::oversized(std::uint16_t stream) const { return streams_.at(stream).oversized; }

const std::string& Publisher::rejection(std::uint16_t stream) const {
  return streams_.at(stream).rejection;
}

}  // namespace furrow::client
