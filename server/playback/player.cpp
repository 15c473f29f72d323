// SPDX-License-Identifier: Apache-2.0
#include "server/playback/player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/status.h"
#include "motion/clip_file.h"
#include "protocol/codec/offer_check.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"
#include "recording/take_clip.h"
#include "recording/take_folder.h"
#include "recording/wire_pose.h"

namespace furrow::server {
namespace {

constexpr std::uint64_t kSession = 1;  // any number: the peer publishes only once
constexpr std::uint16_t kStream = 1;
constexpr std::int64_t kFirstCapture = 1;   // microseconds; 0 means "no capture time" on the wire
constexpr Time kRepeat = FromSeconds(0.1);  // of the current frame
constexpr Time kOfferAgain = FromSeconds(1.0);
constexpr std::string_view kTakeMagic("\x89MCAP0\r\n", 8);

}  // namespace

Result<std::unique_ptr<Player>> Player::Load(const std::filesystem::path& path,
                                             const motion::LoadOptions& read) {
  motion::ClipReport report;
  auto clip = recording::IsTakePath(path.string())
                  ? recording::LoadTakeClip(path.string(), 1.0f, &report)
                  : motion::LoadClip(path, read, &report);
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  FURROW_RETURN_IF_ERROR(clip);
  std::filesystem::path file;
  std::string animation;
  motion::SplitClipPath(path, &file, &animation);
  clip->name = file.stem().string();
  return Make(*std::move(clip), path.filename().string(), path.string(), "--play");
}

Result<std::unique_ptr<Player>> Player::Parse(std::string_view bytes, const std::string& name,
                                              const motion::LoadOptions& read,
                                              std::vector<std::string>* warnings) {
  motion::ClipReport report;
  const std::span take(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  auto clip = recording::IsTakePath(name) || bytes.starts_with(kTakeMagic)
                  ? recording::ParseTakeClip(take, name, &report)
                  : motion::ParseClip(bytes, name, read, &report);
  FURROW_RETURN_IF_ERROR(clip);
  *warnings = std::move(report.warnings);
  clip->name = std::filesystem::path(name).stem().string();
  return Make(*std::move(clip), name, name, "upload");
}

Player::Player(motion::Clip clip, std::string file, std::string label)
    : clip_(std::move(clip)), file_(std::move(file)), label_(std::move(label)) {
  protocol::SkeletonOffer offer = recording::OfferOf(clip_, clip_.name, 1.0f);
  offer.skeleton_hash = protocol::SkeletonHash(offer);
  pose_.skeleton_hash = offer.skeleton_hash;
  encoder_.Encode({.session = kSession, .stream = kStream}, offer, offer_);
}

// The wire's limits (names, counts) hold for a file as for any sender. Checking them here gives an
// error at the start instead of a rejected offer later.
Result<std::unique_ptr<Player>> Player::Make(motion::Clip clip, std::string file,
                                             const std::string& where, std::string label) {
  if (clip.num_frames() == 0) {
    return Status(StatusCode::kInvalidArgument, "the recording has no frames", where);
  }
  auto player = std::make_unique<Player>(std::move(clip), std::move(file), std::move(label));
  if (std::string why = protocol::FindOfferProblem(player->offer_); !why.empty()) {
    return Status(StatusCode::kInvalidArgument, "the skeleton cannot be offered: " + why, where);
  }
  return player;
}

void Player::Start(Hub* hub, Time now) {
  hub_ = hub;
  // kWeb: a peer without a socket of its own, whose messages come on the hub's thread.
  peer_ = hub->AddPeer(Transport::kWeb, label_ + " " + file_, this, now, 0, Access::Everything());
  refusal_.clear();
  Offer(now);
  MoveTo(anchor_, now);
}

void Player::Stop(Time now) {
  anchor_ = std::clamp(PositionAt(now), 0.0, clip_.duration());
  anchor_time_ = now;
  encoder_.Encode({.session = kSession, .stream = kStream}, protocol::Goodbye{}, bytes_);
  hub_->OnMessage(peer_, bytes_, now);
  hub_->RemovePeer(std::exchange(peer_, 0));
}

void Player::Offer(Time now) {
  offered_ = now;
  needed_ = false;
  hub_->OnMessage(peer_, offer_, now);
}

// The hub calls this while it holds its lock, so it only takes notes; Advance() acts on them.
void Player::SendReply(std::span<const std::uint8_t> message) {
  protocol::MessageView view;
  protocol::SkeletonReply reply;
  protocol::ErrorMessage error;
  if (protocol::OpenMessage(message, view, protocol::kMaxReplyBytes) !=
      protocol::DecodeStatus::kOk) {
    return;
  }
  if (protocol::Decode(view, error) == protocol::DecodeStatus::kOk) {
    return NoteRefusal(std::move(error.message));
  }
  if (protocol::Decode(view, reply) != protocol::DecodeStatus::kOk) return;  // a goodbye
  needed_ |= reply.status == protocol::SkeletonStatus::kNeeded;
  if (reply.status == protocol::SkeletonStatus::kAccepted) refusal_.clear();
  if (reply.status == protocol::SkeletonStatus::kRejected) NoteRefusal(std::move(reply.message));
}

void Player::NoteRefusal(std::string why) {
  if (refusal_.empty()) spdlog::warn("playback of '{}' has no effect: {}", clip_.name, why);
  refusal_ = std::move(why);
}

// Computed from the time of the last change, not added up, so rounding does not accumulate.
double Player::PositionAt(Time now) const {
  return playing_ ? anchor_ + ToSeconds(now - anchor_time_) * speed_ : anchor_;
}

// The last frame that begins at or before the position.
int Player::FrameAt(double position) const {
  // Tolerates the rounding of a frame time that was converted to a position and back.
  constexpr double kRounding = 1e-6;
  const auto next =
      std::ranges::upper_bound(clip_.times, clip_.times.front() + position + kRounding);
  return std::max(0, static_cast<int>(next - clip_.times.begin()) - 1);
}

void Player::MoveTo(double position, Time now) {
  anchor_ = position;
  anchor_time_ = now;
  SendPose(FrameAt(position), now);
}

void Player::SendPose(int frame, Time now) {
  frame_ = frame;
  sent_ = now;
  const std::uint64_t hash = pose_.skeleton_hash;
  recording::FillPose(clip_, frame, &pose_);
  pose_.skeleton_hash = hash;
  // The capture time is that of the recording, whatever the speed: the filter then sees the same
  // time steps as `furrow solve`.
  const double seconds = clip_.times[static_cast<std::size_t>(frame)] - clip_.times.front();
  encoder_.Encode({.session = kSession,
                   .stream = kStream,
                   .sequence = sequence_++,
                   .capture_time_us = kFirstCapture + std::llround(seconds * 1e6)},
                  pose_, bytes_);
  hub_->OnMessage(peer_, bytes_, now);
}

Time Player::Advance(Time now) {
  if (needed_ && now - offered_ >= kOfferAgain) Offer(now);
  double position = PositionAt(now);
  const double end = clip_.duration();
  // The last frame is shown for the average frame time.
  const double last = clip_.num_frames() > 1 ? end / (clip_.num_frames() - 1) : ToSeconds(kRepeat);
  if (playing_ && loop_ && position >= end + last) {
    // Keeps the remainder, so that a late call does not shift the loop against the clock.
    MoveTo(std::fmod(position, end + last), now);
    position = anchor_;
  } else if (playing_ && !loop_ && position >= end) {
    playing_ = false;
    MoveTo(end, now);
    position = end;
  }
  // Frames that fell between two calls are skipped, as in live capture.
  const int frame = FrameAt(position);
  if (frame != frame_ || now - sent_ >= kRepeat) SendPose(frame, now);
  if (!playing_) return sent_ + kRepeat;
  const bool is_last = frame + 1 >= clip_.num_frames();
  const double next =
      is_last ? end + last : clip_.times[static_cast<std::size_t>(frame) + 1] - clip_.times.front();
  // At least 1 ns: the remaining time may round to 0, which would spin.
  const Time left = std::max(Time{1}, FromSeconds((next - position) / speed_));
  return std::min(sent_ + kRepeat, now + left);
}

Status Player::Apply(const Change& change, Time now) {
  // Written so that NaN is refused, too.
  if (change.speed && !(*change.speed >= kMinSpeed && *change.speed <= kMaxSpeed)) {
    return Status(StatusCode::kInvalidArgument, "must be 0.05 to 8", "speed");
  }
  if (change.position && !std::isfinite(*change.position)) {
    return Status(StatusCode::kInvalidArgument, "must be a number of seconds", "position_s");
  }
  double position = std::clamp(change.position.value_or(PositionAt(now)), 0.0, clip_.duration());
  const bool starts = change.playing.value_or(playing_) && !playing_;
  // Play at the end of a recording starts it from the beginning.
  if (starts && !change.position && position >= clip_.duration()) position = 0.0;
  playing_ = change.playing.value_or(playing_);
  loop_ = change.loop.value_or(loop_);
  speed_ = change.speed.value_or(speed_);
  MoveTo(position, now);
  return {};
}

Player::State Player::state(Time now) const {
  State state;
  state.file = file_;
  state.subject = clip_.name;
  state.frames = clip_.num_frames();
  state.seconds = clip_.duration();
  state.rate_hz = state.seconds > 0.0 ? (state.frames - 1) / state.seconds : 0.0;
  state.position = std::clamp(PositionAt(now), 0.0, clip_.duration());
  state.frame = frame_;
  state.playing = playing_;
  state.loop = loop_;
  state.speed = speed_;
  return state;
}

}  // namespace furrow::server
