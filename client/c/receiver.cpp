// SPDX-License-Identifier: Apache-2.0
#include "client/c/receiver.h"

#include <algorithm>

namespace furrow::capi {
namespace {

using client::Event;

// A rejected subscription is requested again, because the daemon's rig may change.
constexpr std::int64_t kRetryUs = 2'000'000;

furrow_status StatusOf(protocol::ErrorCode code) {
  switch (code) {
    case protocol::ErrorCode::kNoMatch: return FURROW_NO_MATCH;
    case protocol::ErrorCode::kLimit: return FURROW_LIMIT;
    case protocol::ErrorCode::kNeedsToken: return FURROW_UNAUTHENTICATED;
    case protocol::ErrorCode::kNotPermitted: return FURROW_FORBIDDEN;
    case protocol::ErrorCode::kUnsupported:
    case protocol::ErrorCode::kUnsupportedVersion: return FURROW_UNSUPPORTED;
    default: return FURROW_REJECTED;
  }
}

}  // namespace

bool Receiver::Subscribe(const protocol::SubscribeWeights& request, bool poses) {
  const bool known = std::ranges::any_of(
      feeds_, [&](const auto& feed) { return feed->request().subject == request.subject; });
  if (known) return false;
  Feed& feed = *feeds_.emplace_back(std::make_unique<Feed>(request));
  feed.SetRequest(subscriber_.Subscribe(request));
  if (poses) feed.AddPoses();
  AskForPoses(feed);
  return true;
}

void Receiver::AskForPoses(Feed& feed) {
  if (feed.poses() == nullptr) return;
  const protocol::SubscribePoses request{
      .subject = feed.request().subject, .wait = true, .max_rate_hz = feed.request().max_rate_hz};
  feed.poses()->SetRequest(subscriber_.Subscribe(request));
}

PoseFeed* Receiver::FindPoses(std::uint32_t request, std::uint16_t subscription) {
  for (const auto& feed : feeds_) {
    PoseFeed* const poses = feed->poses();
    if (poses == nullptr) continue;
    if (request != 0 && poses->request_number() == request) return poses;
    if (subscription != 0 && poses->subscription() == subscription) return poses;
  }
  return nullptr;
}

void Receiver::Unsubscribe(const Feed& feed) {
  subscriber_.Cancel(feed.request_number());
  if (feed.poses() != nullptr) subscriber_.Cancel(feed.poses()->request_number());
  std::erase_if(feeds_, [&](const auto& each) { return each.get() == &feed; });
}

const Feed* Receiver::Find(const char* subject) const {
  if (subject == nullptr) return feeds_.empty() ? nullptr : feeds_.front().get();
  const std::string_view name(subject);
  for (const auto& feed : feeds_) {
    if (feed->request().subject == name) return feed.get();
  }
  for (const auto& feed : feeds_) {
    if (feed->subject() == name) return feed.get();
  }
  return nullptr;
}

Feed* Receiver::FindRequest(std::uint32_t number) {
  for (const auto& feed : feeds_) {
    if (feed->request_number() == number) return feed.get();
  }
  return nullptr;
}

Feed* Receiver::FindSubscription(std::uint16_t subscription) {
  for (const auto& feed : feeds_) {
    if (subscription != 0 && feed->subscription() == subscription) return feed.get();
  }
  return nullptr;
}

void Receiver::AskAgain(std::int64_t now_us) {
  for (const auto& feed : feeds_) {
    if (feed->TakeRetry(now_us)) feed->SetRequest(subscriber_.Subscribe(feed->request()));
    if (feed->poses() != nullptr && feed->poses()->TakeRetry(now_us)) AskForPoses(*feed);
  }
}

Receiver::Step Receiver::Next(std::int64_t now_us, std::chrono::milliseconds wait,
                              const Listener& listener, std::string* error) {
  AskAgain(now_us);
  const Event event = subscriber_.Next(now_us, wait);
  switch (event.kind) {
    case Event::Kind::kTimeout: return Step::kNothing;
    case Event::Kind::kNoConnection:
    case Event::Kind::kClosed: return Step::kNoConnection;
    case Event::Kind::kConnected:
      // Numbers of subscriptions belong to a connection; the replies bring new ones.
      for (const auto& feed : feeds_) feed->Forget();
      return Step::kConnected;
    case Event::Kind::kReply: return OnReply(event, listener);
    case Event::Kind::kWeights: return OnWeights(event, now_us, listener);
    case Event::Kind::kSkeleton:
    case Event::Kind::kPose: return OnPoses(event, now_us);
    case Event::Kind::kError: return OnError(event, now_us, error);
    case Event::Kind::kGoodbye: return OnGoodbye(event, now_us, listener);
    default: return Step::kOther;
  }
}

void Receiver::SetObstacle(furrow_status obstacle) {
  for (const auto& feed : feeds_) feed->SetObstacle(obstacle);
}

Receiver::Step Receiver::OnReply(const Event& event, const Listener& listener) {
  needs_token_ = false;
  if (PoseFeed* const poses = FindPoses(event.header.sequence, 0)) {
    poses->SetSubscription(event.header.stream);
    return Step::kOther;
  }
  Feed* const feed = FindRequest(event.header.sequence);
  if (feed == nullptr) {
    // The subscription was ended before its reply arrived.
    subscriber_.Unsubscribe(event.header.stream);
    return Step::kOther;
  }
  if (!feed->OnReply(subscriber_.reply(), event.header.stream)) return Step::kOther;
  listener.OnLayout(*feed);
  return Step::kNews;
}

Receiver::Step Receiver::OnWeights(const Event& event, std::int64_t now_us,
                                   const Listener& listener) {
  Feed* const feed = FindSubscription(event.header.stream);
  if (feed == nullptr) return Step::kOther;
  if (feed->OnFrame(event.header, subscriber_.weights(), now_us) != Feed::Arrival::kNew) {
    return Step::kOther;
  }
  listener.OnWeights(*feed, feed->Frame(now_us));
  return Step::kNews;
}

Receiver::Step Receiver::OnPoses(const Event& event, std::int64_t now_us) {
  PoseFeed* const poses = FindPoses(0, event.header.stream);
  if (poses == nullptr) return Step::kOther;
  if (event.kind == Event::Kind::kSkeleton) {
    poses->OnSkeleton(subscriber_.skeleton());
    return Step::kNews;
  }
  return poses->OnPose(event.header, subscriber_.pose(), now_us) ? Step::kNews : Step::kOther;
}

Receiver::Step Receiver::OnError(const Event& event, std::int64_t now_us, std::string* error) {
  *error = subscriber_.error().message;
  if (subscriber_.error().code == protocol::ErrorCode::kNeedsToken) {
    needs_token_ = true;
    return Step::kNews;
  }
  if (PoseFeed* const poses = FindPoses(event.header.sequence, 0)) {
    poses->OnError(StatusOf(subscriber_.error().code), now_us + kRetryUs);
    return Step::kNews;
  }
  Feed* const feed = FindRequest(event.header.sequence);
  if (feed == nullptr) return Step::kOther;
  feed->OnError(StatusOf(subscriber_.error().code), now_us + kRetryUs);
  return Step::kNews;
}

Receiver::Step Receiver::OnGoodbye(const Event& event, std::int64_t now_us,
                                   const Listener& listener) {
  // The daemon has ended a subscription that says kDone, so it needs another request.
  if (PoseFeed* const poses = FindPoses(0, event.header.stream)) {
    if (subscriber_.goodbye().reason != protocol::GoodbyeReason::kDone) return Step::kOther;
    poses->OnError(FURROW_REJECTED, now_us + kRetryUs);
    return Step::kNews;
  }
  Feed* const feed = FindSubscription(event.header.stream);
  if (feed == nullptr) return Step::kOther;
  switch (subscriber_.goodbye().reason) {
    case protocol::GoodbyeReason::kSubjectGone: break;
    case protocol::GoodbyeReason::kDone:
      feed->OnError(FURROW_REJECTED, now_us + kRetryUs);
      return Step::kNews;
    default: return Step::kOther;  // the subscriber asks again by itself
  }
  feed->OnSubjectGone();
  listener.OnSubjectGone(*feed);
  return Step::kNews;
}

}  // namespace furrow::capi
