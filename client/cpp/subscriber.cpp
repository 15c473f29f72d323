// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/subscriber.h"

#include <algorithm>
#include <utility>

#include "client/cpp/publisher.h"
#include "protocol/messages/error_text.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using protocol::DecodeStatus;
using protocol::MessageKind;

// Interval for repeating unanswered messages over UDP. Interval for renewing a settled lease, and
// for pinging a TCP connection.
constexpr std::int64_t kResendMicroseconds = 200'000;
constexpr std::int64_t kRenewMicroseconds = protocol::kUdpLeaseMicroseconds / 5;
// The interval for repeating messages to a daemon that has been silent for some seconds.
constexpr std::int64_t kSlowResendMicroseconds = 800'000;
// After this time without a challenge, subscriptions are requested again.
constexpr std::int64_t kUnchallengedMicroseconds = protocol::kUdpLeaseMicroseconds / 2;
// After this time without an answer the network or the daemon is considered gone.
constexpr std::int64_t kSilenceMicroseconds = 3 * protocol::kUdpLeaseMicroseconds;
// The same if there are other servers to go to.
constexpr std::int64_t kSilenceWithOthersMicroseconds = 2'000'000;

}  // namespace

Subscriber::Subscriber(std::unique_ptr<Transport> transport, std::string name)
    : transport_(std::move(transport)),
      session_(NewSession()),
      generation_(transport_->generation()),
      introduction_(transport_.get(), std::move(name), session_) {
  introduction_.SendHello();
}

// Stores the request until its subscription ends and sends it, over UDP only once the address is
// proven. Returns its number.
template <class Message>
std::uint32_t Subscriber::Ask(const Message& message) {
  Request& request = requests_.emplace_back();
  request.number = next_request_++;
  request.wait = message.wait;
  request.subject = message.subject;
  encoder_.Encode({.session = session_, .sequence = request.number}, message, request.bytes);
  if (transport_->reconnects()) {
    Message resumed = message;
    resumed.wait = true;
    encoder_.Encode({.session = session_, .sequence = request.number}, resumed, request.resumed);
  }
  if (introduction_.proven())
    (void)transport_->Send(request.bytes);  // Next() reports a closed connection
  return request.number;
}

std::uint32_t Subscriber::Subscribe(const protocol::SubscribeWeights& request) {
  return Ask(request);
}
std::uint32_t Subscriber::Subscribe(const protocol::SubscribePictures& request) {
  return Ask(request);
}

std::uint32_t Subscriber::Subscribe(const protocol::SubscribePoses& request) {
  return Ask(request);
}

void Subscriber::Unsubscribe(std::uint16_t subscription) {
  encoder_.Encode({.session = session_, .stream = subscription, .sequence = next_request_++},
                  protocol::Unsubscribe{}, bytes_);
  (void)transport_->Send(bytes_);
  std::erase_if(requests_,
                [=](const Request& request) { return request.subscription == subscription; });
}

void Subscriber::Cancel(std::uint32_t request) {
  const auto found = std::ranges::find(requests_, request, &Request::number);
  if (found == requests_.end()) return;
  if (found->subscription != 0) return Unsubscribe(found->subscription);
  requests_.erase(found);
}

std::uint32_t Subscriber::ListSubjects(bool follow) {
  const std::uint32_t number = next_request_++;
  encoder_.Encode({.session = session_, .sequence = number}, protocol::ListSubjects{follow},
                  bytes_);
  (void)transport_->Send(bytes_);
  list_.clear();
  if (follow) list_ = bytes_;
  return number;
}

void Subscriber::SendWaiting() {
  for (const Request& request : requests_) {
    if (request.waiting) (void)transport_->Send(request.bytes);
  }
}

// Makes every request wait for an answer again.
void Subscriber::ResumeAll() {
  for (Request& request : requests_) {
    request.waiting = true;
    if (request.resumed.empty()) continue;
    request.bytes = request.resumed;
    request.wait = true;
  }
}

// The daemon does not know this address, or forgot it: start over and repeat all requests.
void Subscriber::ProveAgain() {
  answered_ = false;
  introduction_.Restart();
  ResumeAll();
  introduction_.SendHello();
}

// The transport has another connection, and the daemon knows nothing of it.
void Subscriber::StartOver() {
  generation_ = transport_->generation();
  unanswered_since_us_.reset();
  // Numbers of subscriptions belong to a connection.
  for (Request& request : requests_) request.subscription = 0;
  ProveAgain();
  if (!introduction_.proven()) return;
  SendWaiting();
  if (!list_.empty()) (void)transport_->Send(list_);
}

// Over UDP a closed port may belong to another daemon when it opens. Maintain() sends the Hello,
// because each one to a closed port is answered with a failure at once.
void Subscriber::OnNoConnection() {
  answered_ = false;
  if (!transport_->reconnects() || transport_->kind() != TransportKind::kUdp) return;
  introduction_.Restart();
  ResumeAll();
}

void Subscriber::NoticeRestart(std::uint64_t server_session) {
  const bool restarted = server_session_ != 0 && server_session != server_session_;
  server_session_ = server_session;
  // Over TCP a restart also closes the connection, so there is nothing to repeat on it.
  if (restarted && introduction_.proven() && transport_->kind() == TransportKind::kUdp) {
    ProveAgain();
  }
}

void Subscriber::Maintain(std::int64_t now_us) {
  // The first call only learns the time: the constructor, which sent the Hello, has no clock.
  now_us_ = now_us;
  if (!started_) {
    started_ = true;
    last_sent_us_ = last_challenge_us_ = now_us;
    return;
  }
  const bool udp = transport_->kind() == TransportKind::kUdp;
  // The program did not call for a while, as in a debugger, so the daemon has forgotten it. Its
  // goodbye may have been lost with everything else that did not fit into the socket's buffer.
  const bool slept = now_us - last_sent_us_ > protocol::kUdpLeaseMicroseconds;
  if (udp && slept && transport_->reconnects()) {
    last_sent_us_ = now_us;
    return ProveAgain();
  }
  // The daemon challenges an address with subscriptions several times per second. If it does not,
  // the subscriptions have ended while the network was away, and the goodbye was lost. Repeating a
  // request is harmless.
  if (udp && introduction_.proven() && now_us - last_challenge_us_ > kUnchallengedMicroseconds) {
    last_challenge_us_ = now_us;
    for (Request& request : requests_) request.waiting = true;
  }
  // TCP does not lose requests, so only UDP repeats them, unless the daemon has sent them away.
  const bool asking = (udp || sent_away_) && std::ranges::any_of(requests_, &Request::waiting);
  const bool unsettled = !introduction_.proven() || asking;
  const bool silent =
      unanswered_since_us_ && now_us - *unanswered_since_us_ > protocol::kUdpLeaseMicroseconds;
  const std::int64_t resend = silent || sent_away_ ? kSlowResendMicroseconds : kResendMicroseconds;
  if (now_us - last_sent_us_ < (unsettled ? resend : kRenewMicroseconds)) return;
  last_sent_us_ = now_us;
  // Silence counts from the first unanswered send. A daemon that has nothing to say is not gone.
  if (!unanswered_since_us_) unanswered_since_us_ = now_us;
  if (!introduction_.proven()) {
    introduction_.SendHello();
  } else if (asking) {
    SendWaiting();
  } else {
    // The pong shows that the daemon is alive.
    encoder_.Encode({.session = session_}, protocol::Ping{.time_us = now_us}, bytes_);
    (void)transport_->Send(bytes_);
  }
}

Event Subscriber::Next(std::int64_t now_us, std::chrono::milliseconds wait) {
  Maintain(now_us);
  Event event;
  std::span<const std::uint8_t> message;
  for (;;) {
    const IoStatus status = transport_->Receive(message, wait);
    if (transport_->generation() != generation_) StartOver();
    switch (status) {
      case IoStatus::kOk: unanswered_since_us_.reset(); break;
      case IoStatus::kNoConnection:
        OnNoConnection();
        event.kind = Event::Kind::kNoConnection;
        return event;
      case IoStatus::kClosed:
      case IoStatus::kMalformed: event.kind = Event::Kind::kClosed; return event;
      default: event.kind = OnTimeout(now_us); return event;
    }
    if (Handle(message, event)) return event;
    // That message (a pong or a welcome) is not for the caller. Look at what else has arrived, but
    // do not wait again, because only the caller knows the time.
    wait = std::chrono::milliseconds(0);
  }
}

// The event of a receive timeout.
Event::Kind Subscriber::OnTimeout(std::int64_t now_us) {
  const std::int64_t patience_us =
      transport_->has_others() ? kSilenceWithOthersMicroseconds : kSilenceMicroseconds;
  const bool lost = unanswered_since_us_ && now_us - *unanswered_since_us_ > patience_us;
  if (!lost) return Event::Kind::kTimeout;
  if (transport_->reconnects()) {
    // The peer may be gone without a word, as after a power failure.
    unanswered_since_us_.reset();
    transport_->Abandon();
    OnNoConnection();
    return Event::Kind::kNoConnection;
  }
  return transport_->kind() == TransportKind::kTcp ? Event::Kind::kClosed
                                                   : Event::Kind::kNoConnection;
}

bool Subscriber::Handle(std::span<const std::uint8_t> message, Event& event) {
  protocol::MessageView view;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) != DecodeStatus::kOk) {
    ++malformed_;
    return false;
  }
  // Every message carries the daemon's session number, so any message shows a restart.
  NoticeRestart(view.header.session);
  const bool is_frame = view.kind == MessageKind::kWeights || view.kind == MessageKind::kPose ||
                        view.kind == MessageKind::kSkeletonOffer ||
                        view.kind == MessageKind::kImage;
  if (is_frame && IsFenced(view.header.stream)) return false;
  event.header = view.header;
  payload_ = view.payload;
  if (view.kind == MessageKind::kWelcome) return HandleWelcome(view, event);
  if (view.kind == MessageKind::kPing) {
    HandlePing(view);
    return false;
  }
  const std::optional<DecodeStatus> status = Read(view, event.kind);
  if (!status) return false;
  if (*status == DecodeStatus::kOk) return TakeIn(view.header, event.kind);
  ++malformed_;
  return false;
}

// Decodes a message for the caller. Pongs, and messages of a newer protocol, are not for the
// caller.
std::optional<DecodeStatus> Subscriber::Read(const protocol::MessageView& view, Event::Kind& kind) {
  const auto read = [&](Event::Kind event, auto& message) {
    kind = event;
    return protocol::Decode(view, message);
  };
  switch (view.kind) {
    case MessageKind::kWeights: return read(Event::Kind::kWeights, weights_);
    case MessageKind::kSkeletonOffer: return read(Event::Kind::kSkeleton, skeleton_);
    case MessageKind::kPose: return read(Event::Kind::kPose, pose_);
    case MessageKind::kDropped: return read(Event::Kind::kDropped, dropped_);
    case MessageKind::kSubjects: return read(Event::Kind::kSubjects, subjects_);
    case MessageKind::kImage: return read(Event::Kind::kPicture, picture_);
    case MessageKind::kSubscribeReply: return read(Event::Kind::kReply, reply_);
    case MessageKind::kError: return read(Event::Kind::kError, error_);
    case MessageKind::kGoodbye: return read(Event::Kind::kGoodbye, goodbye_);
    default: return std::nullopt;
  }
}

// What a message that was read means for the requests. Returns whether the caller receives it.
bool Subscriber::TakeIn(const protocol::Header& header, Event::Kind kind) {
  switch (kind) {
    case Event::Kind::kWeights: OnFrame(header.stream, weights_.names_hash); return true;
    case Event::Kind::kSkeleton: OnSkeleton(header.stream); return true;
    case Event::Kind::kPose: OnFrame(header.stream, pose_.skeleton_hash); return true;
    case Event::Kind::kReply: return OnReply(header);
    case Event::Kind::kError: return OnError(header);
    case Event::Kind::kGoodbye: return OnGoodbye(header.stream);
    default: return true;
  }
}

bool Subscriber::HandleWelcome(const protocol::MessageView& view, Event& event) {
  protocol::Welcome welcome;
  if (protocol::Decode(view, welcome) != DecodeStatus::kOk) {
    ++malformed_;
    return false;
  }
  if (introduction_.OnWelcome(welcome)) SendWaiting();
  RememberOthers(welcome, introduction_, *transport_);
  if (!introduction_.proven() || answered_ || !transport_->reconnects()) return false;
  answered_ = true;
  event.kind = Event::Kind::kConnected;
  return true;
}

void Subscriber::HandlePing(const protocol::MessageView& view) {
  protocol::Ping ping;
  if (protocol::Decode(view, ping) == DecodeStatus::kOk) {
    last_challenge_us_ = now_us_;
    introduction_.OnPing(ping);
  } else {
    ++malformed_;
  }
}

// Returns false if the daemon serves the subject in a lower epoch than another one did. It will
// notice that it no longer may.
bool Subscriber::OnReply(const protocol::Header& header) {
  const auto found = std::ranges::find(requests_, header.sequence, &Request::number);
  if (found == requests_.end()) return true;
  sent_away_ = false;
  found->waiting = false;
  found->subscription = header.stream;
  // Epochs of different subjects do not compare. A reply without one says that the request waits.
  if (!reply_.subject.empty() && reply_.subject != found->served) {
    found->served = reply_.subject;
    found->epoch = 0;
  }
  found->fenced = reply_.epoch != 0 && reply_.epoch < found->epoch;
  if (found->fenced) return false;
  found->epoch = std::max(found->epoch, reply_.epoch);
  // Frames carry this hash. OnFrame() compares them.
  found->names_hash = reply_.names_hash;
  return true;
}

bool Subscriber::IsFenced(std::uint16_t subscription) const {
  const auto found = std::ranges::find(requests_, subscription, &Request::subscription);
  return found != requests_.end() && found->fenced;
}

// True if the subscriber goes on at another server. One with several subjects cannot: it has one
// connection for all of them.
bool Subscriber::Follow(const protocol::Header& header) {
  if (!SendsElsewhere(error_) || !introduction_.proven()) return false;
  // Only the answer to a request counts. NoticeRestart() has checked the session.
  const bool asked = std::ranges::any_of(
      requests_, [&header](const Request& request) { return request.number == header.sequence; });
  if (!asked) return false;
  const std::string& subject = requests_.front().subject;
  const bool same = std::ranges::all_of(
      requests_, [&subject](const Request& request) { return request.subject == subject; });
  if (!same || !transport_->GoTo({error_.host, error_.tcp, error_.udp})) return false;
  // If it stays for now, the daemon may know more in a moment.
  sent_away_ = true;
  ResumeAll();
  return true;
}

void Subscriber::OnSkeleton(std::uint16_t subscription) {
  const auto found = std::ranges::find(requests_, subscription, &Request::subscription);
  if (found != requests_.end()) found->names_hash = skeleton_.skeleton_hash;
}

// Weights whose names, or poses whose skeleton, never arrived: the reply was lost, so ask again.
void Subscriber::OnFrame(std::uint16_t subscription, std::uint64_t hash) {
  const auto found = std::ranges::find(requests_, subscription, &Request::subscription);
  if (found != requests_.end() && found->names_hash != hash) found->waiting = true;
}

// Returns false if the error is handled here and not passed to the caller.
bool Subscriber::OnError(const protocol::Header& header) {
  error_.message = protocol::SentenceOf(error_);
  if (Follow(header)) return false;
  if (error_.code == protocol::ErrorCode::kUnprovenAddress &&
      transport_->kind() == TransportKind::kUdp) {
    if (introduction_.proven()) ProveAgain();
    return false;
  }
  // The daemon is shutting down. The next one will be asked again.
  if (error_.code == protocol::ErrorCode::kDraining && transport_->reconnects()) return false;
  std::erase_if(requests_,
                [&](const Request& request) { return request.number == header.sequence; });
  return true;
}

// Returns false if the goodbye is handled here and not passed to the caller. A subscription with
// `wait` outlives its subject. Every other reason ends the subscription.
bool Subscriber::OnGoodbye(std::uint16_t subscription) {
  // The daemon has had no answer to its challenges for too long, but this program is still there.
  if (goodbye_.reason == protocol::GoodbyeReason::kTimedOut) {
    for (Request& request : requests_) request.waiting |= request.subscription == subscription;
    return false;
  }
  const bool may_return = goodbye_.reason == protocol::GoodbyeReason::kSubjectGone;
  // The daemon is shutting down. The next one will be asked again.
  if (transport_->reconnects() && goodbye_.reason == protocol::GoodbyeReason::kDraining) {
    return true;
  }
  std::erase_if(requests_, [=](const Request& request) {
    return request.subscription == subscription && !(request.wait && may_return);
  });
  return true;
}

}  // namespace furrow::client
