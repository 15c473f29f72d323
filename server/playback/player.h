// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion/clip/clip.h"
#include "protocol/codec/codec.h"
#include "server/session/hub.h"

namespace furrow::server {

// Plays a recording inside the daemon (furrowd --play, or an uploaded file): a peer of the hub that
// publishes one subject, with a timeline for pause, seek, loop and speed.
//
// Poses carry the capture times of the recording, so from its start and at any speed the weights
// equal those of `furrow solve`. Going back restarts the filter. While paused, the player repeats
// the current frame, so that the subject does not count as lost. If another sender takes over the
// subject, playback continues without effect, which is logged once, and regains the subject when
// that sender leaves. All functions run on the thread of shard 0.
class Player : public Link {
 public:
  struct State {
    std::string file;
    std::string subject;
    int frames = 0;
    double seconds = 0.0;  // from the first frame to the last
    double rate_hz = 0.0;
    double position = 0.0;  // seconds from the first frame
    int frame = 0;          // the last frame sent
    bool playing = true;
    bool loop = true;
    double speed = 1.0;
  };
  // A change of the timeline. An absent member leaves its value unchanged.
  struct Change {
    std::optional<bool> playing;
    std::optional<bool> loop;
    std::optional<double> speed;     // [kMinSpeed, kMaxSpeed]
    std::optional<double> position;  // seconds from the first frame; clamped to the recording
  };
  static constexpr double kMinSpeed = 0.05;
  static constexpr double kMaxSpeed = 8.0;

  // Reads a recording. The subject gets the name of the file. Errors: those of the readers;
  // kInvalidArgument for a recording without frames or one that the wire cannot carry (too many
  // blend shapes, names that are not UTF-8).
  [[nodiscard]] static Result<std::unique_ptr<Player>> Load(const std::filesystem::path& path,
                                                            const motion::LoadOptions& read = {});
  // The same for the bytes of an uploaded file, of which `name` is the name without folders. No
  // file is opened. `warnings`: what the reader tolerated, one sentence each; not null.
  [[nodiscard]] static Result<std::unique_ptr<Player>> Parse(std::string_view bytes,
                                                             const std::string& name,
                                                             const motion::LoadOptions& read,
                                                             std::vector<std::string>* warnings);
  // `file`: name of the recording, for State. `label`: of the peer, for people.
  explicit Player(motion::Clip clip, std::string file, std::string label = "--play");

  // Offers the subject and sends its first frame, or goes on after Stop(). `hub` must outlive the
  // player.
  void Start(Hub* hub, Time now);
  // Ends the subject, which decays to neutral and leaves, and keeps the position. Call it only
  // after Start().
  void Stop(Time now);
  // Sends a frame if one is due. Returns when to call it next.
  Time Advance(Time now);
  // Changes the timeline. Errors: kInvalidArgument, with the field as `where`; nothing has changed
  // then.
  [[nodiscard]] Status Apply(const Change& change, Time now);
  // The state of the timeline at `now`.
  [[nodiscard]] State state(Time now) const;
  // The name of the subject.
  [[nodiscard]] const std::string& subject() const { return clip_.name; }
  // Why the hub does not let this player publish its subject; empty: it does, or it has not decided
  // yet.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  // Link: receives the replies to a publisher.
  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
    return 0;
  }
  void DropFrames(std::uint64_t) override {}

 private:
  // Checks what a reader has read. `where`: for errors.
  [[nodiscard]] static Result<std::unique_ptr<Player>> Make(motion::Clip clip, std::string file,
                                                            const std::string& where,
                                                            std::string label);
  void NoteRefusal(std::string why);
  [[nodiscard]] double PositionAt(Time now) const;
  [[nodiscard]] int FrameAt(double position) const;
  void MoveTo(double position, Time now);
  void Offer(Time now);
  void SendPose(int frame, Time now);

  const motion::Clip clip_;
  const std::string file_;
  const std::string label_;
  Hub* hub_ = nullptr;
  PeerId peer_ = 0;
  bool playing_ = true;
  bool loop_ = true;
  double speed_ = 1.0;
  double anchor_ = 0.0;  // the position at anchor_time_
  Time anchor_time_{0};
  int frame_ = -1;
  Time sent_{0};
  std::vector<std::uint8_t> offer_;  // encoded
  Time offered_{0};
  bool needed_ = false;  // the hub has asked for the offer again
  std::string refusal_;  // of the last offer, which has been logged
  std::uint32_t sequence_ = 0;
  protocol::Encoder encoder_;
  protocol::PoseFrame pose_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace furrow::server
