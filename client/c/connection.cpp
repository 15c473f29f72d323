// SPDX-License-Identifier: Apache-2.0
#include "client/c/connection.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "base/text.h"
#include "client/c/struct_copy.h"
#include "client/c/text_input.h"
#include "client/cpp/clock.h"
#include "client/cpp/reconnecting_transport.h"
#include "protocol/messages/limits.h"

namespace furrow::capi {
namespace {

using client::SteadyMicroseconds;
using std::chrono::milliseconds;

// The longest wait of one step. Offers and requests are repeated every 200 ms.
constexpr std::int64_t kSliceMs = 50;
// A TCP peer that takes longer to read a message is gone. Short, because an engine's frame waits.
constexpr milliseconds kSendTimeout(200);
// A flood of messages must not keep furrow_poll() from returning.
constexpr int kMostSteps = 4096;

furrow_status StatusOf(StatusCode code) {
  switch (code) {
    case StatusCode::kOk: return FURROW_OK;
    case StatusCode::kLimit: return FURROW_LIMIT;
    case StatusCode::kUnsupported: return FURROW_UNSUPPORTED;
    case StatusCode::kUnavailable: return FURROW_NO_CONNECTION;
    default: return FURROW_INVALID_ARGUMENT;
  }
}

// True while a callback runs, also if the callback throws.
class Mark {
 public:
  explicit Mark(bool* flag) : flag_(flag) { *flag_ = true; }
  ~Mark() { *flag_ = false; }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

 private:
  bool* flag_;
};

}  // namespace

Connection::Connection(client::Address address, std::string program, client::Security security)
    : address_(std::move(address)), program_(std::move(program)), security_(std::move(security)) {}

Connection::~Connection() {
  try {
    SayGoodbye();
  } catch (const std::exception&) {  // without memory, the daemon notices after some seconds
  }
}

void Connection::SayGoodbye() {
  if (sender_) sender_->Close();
  while (receiver_ && !receiver_->feeds().empty()) {
    receiver_->Unsubscribe(*receiver_->feeds().front());
  }
}

furrow_status Connection::Fail(furrow_status status, std::string message) {
  last_error_ = std::move(message);
  return status;
}

furrow_status Connection::Fail(const Status& status) {
  return Fail(StatusOf(status.code()), status.ToString());
}

std::unique_ptr<client::Transport> Connection::OpenTransport() const {
  const auto kind = address_.transport.value_or(client::TransportKind::kUdp);
  return client::ReconnectingTransport::Create(kind, address_.host, address_.PortFor(kind),
                                               kSendTimeout, nullptr, security_);
}

furrow_status Connection::SubscribeToAddress() {
  std::vector<std::string> subjects = address_.subjects;
  if (subjects.empty()) subjects.emplace_back();
  for (std::string& subject : subjects) {
    protocol::SubscribeWeights request{
        .subject = std::move(subject), .wait = true, .max_rate_hz = address_.max_rate_hz};
    if (!address_.pattern.empty()) request.pattern = address_.pattern;
    if (const furrow_status status = Subscribe(request, false); status != FURROW_OK) return status;
  }
  return FURROW_OK;
}

furrow_status Connection::Subscribe(const furrow_subscription* subscription) {
  furrow_subscription wanted;
  if (const furrow_status status = CopyIn(subscription, &wanted); status != FURROW_OK) {
    return Fail(status, "subscription: struct_size is wrong, or an unknown field is set");
  }
  constexpr std::uint32_t kFlags =
      FURROW_SUBSCRIBE_8_BIT | FURROW_SUBSCRIBE_DRIVERS | FURROW_SUBSCRIBE_POSES;
  if ((wanted.flags & ~kFlags) != 0 || wanted.reserved != 0) {
    return Fail(FURROW_UNSUPPORTED, "subscription: unknown flags");
  }
  protocol::SubscribeWeights request{.wait = true, .max_rate_hz = wanted.max_rate_hz};
  std::string pattern;
  if (!ReadText(wanted.subject, protocol::kMaxNameBytes, &request.subject) ||
      !ReadText(wanted.pattern, protocol::kMaxPatternBytes, &pattern)) {
    return Fail(FURROW_INVALID_ARGUMENT,
                "subscription: the subject or the pattern is too long or not plain UTF-8");
  }
  if (!(wanted.max_rate_hz >= 0.0f && wanted.max_rate_hz <= protocol::kMaxRateHz)) {
    return Fail(FURROW_INVALID_ARGUMENT, "subscription: max_rate_hz is outside 0 to 1000");
  }
  if (!pattern.empty()) request.pattern = pattern;
  if ((wanted.flags & FURROW_SUBSCRIBE_8_BIT) != 0) request.format = protocol::WeightFormat::kU8;
  if ((wanted.flags & FURROW_SUBSCRIBE_DRIVERS) != 0) {
    request.source = protocol::WeightSource::kDriverValues;
  }
  return Subscribe(request, (wanted.flags & FURROW_SUBSCRIBE_POSES) != 0);
}

furrow_status Connection::Subscribe(const protocol::SubscribeWeights& request, bool poses) {
  if (!receiver_) {
    auto transport = OpenTransport();
    receiving_ = transport.get();
    receiver_.emplace(std::move(transport), program_);
  }
  if (receiver_->feeds().size() == FURROW_MAX_SUBJECTS) {
    return Fail(FURROW_LIMIT, "too many subscriptions (open another connection)");
  }
  if (receiver_->Subscribe(request, poses)) return FURROW_OK;
  return Fail(FURROW_INVALID_ARGUMENT, "the subject " + Quoted(request.subject) +
                                           " is subscribed already (unsubscribe it first)");
}

const Feed* Connection::Find(const char* subject) {
  const Feed* const feed = receiver_ ? receiver_->Find(subject) : nullptr;
  if (feed != nullptr) return feed;
  (void)Fail(FURROW_NOT_FOUND, subject == nullptr
                                   ? "there is no subscription"
                                   : "there is no subscription to the subject " + Quoted(subject));
  return nullptr;
}

furrow_status Connection::Unsubscribe(const char* subject) {
  const Feed* const feed = Find(subject);
  if (feed == nullptr) return FURROW_NOT_FOUND;
  receiver_->Unsubscribe(*feed);
  return FURROW_OK;
}

furrow_status Connection::Weights(const char* subject, float* values, std::uint32_t capacity,
                                  furrow_frame* frame) {
  const Feed* const feed = Find(subject);
  if (feed == nullptr) return FURROW_NOT_FOUND;
  const furrow_frame now = feed->Frame(SteadyMicroseconds());
  if (frame != nullptr && CopyOut(now, frame) != FURROW_OK) {
    return Fail(FURROW_INVALID_ARGUMENT, "frame: struct_size is wrong");
  }
  if (feed->status() != FURROW_OK) return feed->status();
  if (capacity < now.count) {
    return Fail(FURROW_BUFFER_TOO_SMALL, "there are " + Counted(now.count, "weight") +
                                             ", but the buffer holds " + std::to_string(capacity));
  }
  if (values == nullptr) return Fail(FURROW_INVALID_ARGUMENT, "values is null");
  std::ranges::copy(feed->values(), values);
  return FURROW_OK;
}

const PoseFeed* Connection::FindPoses(const char* subject, furrow_status* status) {
  const Feed* const feed = Find(subject);
  *status = FURROW_NOT_FOUND;
  if (feed == nullptr) return nullptr;
  if (feed->poses() == nullptr) {
    *status = Fail(FURROW_NOT_FOUND, "the subscription has no poses (use FURROW_SUBSCRIBE_POSES)");
    return nullptr;
  }
  *status = feed->poses()->skeleton_status();
  if (*status == FURROW_NO_DATA) *status = feed->obstacle();
  return *status == FURROW_OK ? feed->poses() : nullptr;
}

furrow_status Connection::LatestPose(const char* subject, furrow_pose_buffer* pose) {
  furrow_pose_buffer filled;
  if (const furrow_status status = CopyIn(pose, &filled); status != FURROW_OK) {
    return Fail(status, "pose: struct_size is wrong, or an unknown field is set");
  }
  furrow_status status = FURROW_OK;
  const PoseFeed* const poses = FindPoses(subject, &status);
  if (poses != nullptr) status = poses->status();
  if (status != FURROW_OK) return status;
  status = poses->Copy(SteadyMicroseconds(), &filled);
  (void)CopyOut(filled, pose);
  if (status == FURROW_OK) return status;
  return Fail(status, "the pose has " + Counted(filled.num_joints, "joint") + " and " +
                          Counted(filled.num_blend_shapes, "blend shape") +
                          ", more than the buffers hold");
}

furrow_status Connection::GetSkeleton(const char* subject, furrow_skeleton_info* info) {
  furrow_status status = FURROW_OK;
  const PoseFeed* const poses = FindPoses(subject, &status);
  if (poses == nullptr) return status;
  const furrow_skeleton_info now = poses->Info();
  if (CopyOut(now, info) == FURROW_OK) return FURROW_OK;
  return Fail(FURROW_INVALID_ARGUMENT, "info: struct_size is wrong");
}

furrow_status Connection::GetJoint(const char* subject, std::uint32_t index, furrow_joint* joint,
                                   std::string* name) {
  furrow_status status = FURROW_OK;
  const PoseFeed* const poses = FindPoses(subject, &status);
  if (poses == nullptr) return status;
  if (index >= poses->skeleton().joints.size()) {
    return Fail(FURROW_NOT_FOUND, "there is no joint " + std::to_string(index));
  }
  *name = poses->skeleton().joints[index].name;
  *joint = poses->Joint(index);
  return FURROW_OK;
}

furrow_status Connection::BlendShapeName(const char* subject, std::uint32_t index,
                                         std::string* name) {
  furrow_status status = FURROW_OK;
  const PoseFeed* const poses = FindPoses(subject, &status);
  if (poses == nullptr) return status;
  if (index >= poses->skeleton().blend_shape_names.size()) {
    return Fail(FURROW_NOT_FOUND, "there is no blend shape " + std::to_string(index));
  }
  *name = poses->skeleton().blend_shape_names[index];
  return FURROW_OK;
}

furrow_status Connection::SetCallbacks(const furrow_callbacks* callbacks) {
  furrow_callbacks wanted{};
  if (callbacks != nullptr) {
    if (const furrow_status status = CopyIn(callbacks, &wanted); status != FURROW_OK) {
      return Fail(status, "callbacks: struct_size is wrong, or an unknown field is set");
    }
    if (wanted.reserved != 0) return Fail(FURROW_UNSUPPORTED, "callbacks: reserved is not 0");
  }
  listener_.Set(wanted);
  return FURROW_OK;
}

furrow_status Connection::Poll(std::int32_t timeout_ms) {
  if (timeout_ms < 0 || timeout_ms > FURROW_MAX_TIMEOUT_MS) {
    return Fail(FURROW_INVALID_ARGUMENT, "timeout_ms is outside 0 to 60000");
  }
  const Mark mark(&calling_back_);
  const std::int64_t deadline_us = SteadyMicroseconds() + std::int64_t{timeout_ms} * 1000;
  bool news = false;
  for (int step = 0; step < kMostSteps && !close_later_; ++step) {
    const std::int64_t now_us = SteadyMicroseconds();
    const std::int64_t left_ms = std::max<std::int64_t>(0, (deadline_us - now_us + 999) / 1000);
    const milliseconds wait(news ? 0 : std::min(left_ms, kSliceMs));
    bool idle = false;
    news |= Step(now_us, wait, &idle);
    if (idle && (news || SteadyMicroseconds() >= deadline_us)) break;
  }
  if (close_later_) return FURROW_CLOSED;
  return news ? FURROW_OK : FURROW_TIMEOUT;
}

// Handles one message. Returns true if the program can see something new. `idle`: nothing more
// waits to be handled.
bool Connection::Step(std::int64_t now_us, milliseconds wait, bool* idle) {
  bool news = false;
  if (sender_) PollSender(now_us, receiver_ ? milliseconds(0) : wait, &news);
  if (!receiver_) {
    *idle = !news;
    if (!sender_) std::this_thread::sleep_for(wait);
    return news;
  }
  std::string error;
  switch (receiver_->Next(now_us, wait, listener_, &error)) {
    case Receiver::Step::kNothing: *idle = true; break;
    case Receiver::Step::kNoConnection:
      *idle = true;
      NoteNetworkFailure();
      NoteObstacle();
      if (state_ != FURROW_CONNECTED) break;
      SetState(FURROW_DISCONNECTED);
      return true;
    case Receiver::Step::kConnected:
      ++connects_;
      SetState(FURROW_CONNECTED);
      return true;
    case Receiver::Step::kOther: break;
    case Receiver::Step::kNews: news = true; break;
  }
  if (!error.empty()) last_error_ = error;
  NoteObstacle();
  return news;
}

void Connection::PollSender(std::int64_t now_us, milliseconds wait, bool* news) {
  const bool answered = sender_->Poll(now_us, wait);
  if (answered && !sender_->last_error().empty()) last_error_ = sender_->last_error();
  *news |= answered;
  if (receiver_) return;  // its connection determines the state
  if (answered && state_ != FURROW_CONNECTED) {
    ++connects_;
    SetState(FURROW_CONNECTED);
  } else if (!sender_->connected() && state_ == FURROW_CONNECTED) {
    SetState(FURROW_DISCONNECTED);
    *news = true;
  }
}

void Connection::NoteNetworkFailure() {
  const std::string why = receiving_->failure();
  // What the library itself says is a whole sentence.
  const bool is_whole = why.find(address_.host) != std::string::npos;
  last_error_ = is_whole ? why
                         : "no connection to " + address_.host + (why.empty() ? "" : ": " + why) +
                               " (is furrowd running there?)";
}

void Connection::NoteObstacle() {
  const std::string why = client::RefusedTokenText(receiving_->refusal());
  if (!why.empty()) last_error_ = why;
  const bool refused = !why.empty() || receiver_->needs_token();
  receiver_->SetObstacle(refused                    ? FURROW_UNAUTHENTICATED
                         : receiving_->tls_failed() ? FURROW_TLS_FAILED
                                                    : FURROW_NO_DATA);
}

void Connection::SetState(furrow_state state) {
  if (state == state_) return;
  state_ = state;
  listener_.OnState(state);
}

furrow_status Connection::Offer(const furrow_skeleton* skeleton, std::uint32_t* stream) {
  furrow_skeleton wanted;
  if (const furrow_status status = CopyIn(skeleton, &wanted); status != FURROW_OK) {
    return Fail(status, "skeleton: struct_size is wrong, or an unknown field is set");
  }
  if (!sender_) {
    auto transport = OpenTransport();
    sending_ = transport.get();
    sender_.emplace(std::move(transport));
  }
  const Status status = sender_->Offer(wanted, SteadyMicroseconds(), stream);
  return status.ok() ? FURROW_OK : Fail(status.Within("skeleton"));
}

furrow_status Connection::StreamStatus(std::uint32_t stream) {
  if (!sender_ || stream >= sender_->num_streams()) {
    return Fail(FURROW_NOT_FOUND, "there is no stream " + std::to_string(stream));
  }
  if (const std::string& why = sender_->rejection(stream); !why.empty()) {
    return Fail(FURROW_REJECTED, why);
  }
  if (sender_->accepted(stream)) return FURROW_OK;
  if (std::string why = client::RefusedTokenText(sending_->refusal()); !why.empty()) {
    return Fail(FURROW_UNAUTHENTICATED, std::move(why));
  }
  if (sender_->needs_token()) return Fail(FURROW_UNAUTHENTICATED, sender_->last_error());
  if (sending_->tls_failed()) return Fail(FURROW_TLS_FAILED, sending_->failure());
  return FURROW_NO_DATA;
}

furrow_status Connection::SendPose(std::uint32_t stream, const furrow_pose* pose) {
  furrow_pose wanted;
  if (const furrow_status status = CopyIn(pose, &wanted); status != FURROW_OK) {
    return Fail(status, "pose: struct_size is wrong, or an unknown field is set");
  }
  if ((wanted.flags & ~(FURROW_POSE_PACKED | FURROW_POSE_REDUNDANT)) != 0) {
    return Fail(FURROW_UNSUPPORTED, "pose: unknown flags");
  }
  if (const furrow_status status = StreamStatus(stream); status < FURROW_OK) return status;
  const Status status = sender_->Send(stream, wanted);
  return status.ok() ? FURROW_OK : Fail(status.Within("pose"));
}

furrow_status Connection::Withdraw(std::uint32_t stream) {
  if (!sender_ || stream >= sender_->num_streams()) {
    return Fail(FURROW_NOT_FOUND, "there is no stream " + std::to_string(stream));
  }
  sender_->Withdraw(stream);
  return FURROW_OK;
}

furrow_status Connection::GetInfo(furrow_connection_info* info) {
  furrow_connection_info now{};
  now.state = state_;
  now.connects = connects_;
  now.malformed = receiver_ ? receiver_->malformed() : 0;
  now.subjects = receiver_ ? static_cast<std::uint32_t>(receiver_->feeds().size()) : 0;
  now.streams = sender_ ? sender_->num_streams() : 0;
  if (CopyOut(now, info) == FURROW_OK) return FURROW_OK;
  return Fail(FURROW_INVALID_ARGUMENT, "info: struct_size is wrong");
}

furrow_status Connection::SubjectName(std::uint32_t index, std::string* name) {
  if (!receiver_ || index >= receiver_->feeds().size()) {
    return Fail(FURROW_NOT_FOUND, "there is no subscription " + std::to_string(index));
  }
  *name = receiver_->feeds()[index]->subject();
  return FURROW_OK;
}

}  // namespace furrow::capi
