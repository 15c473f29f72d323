// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "motion/clip/clip.h"
#include "protocol/codec/codec.h"
#include "server/session/hub.h"

namespace furrow::server {

// A recording that plays inside the daemon (furrowd --play): a peer of the hub that sends one
// subject, with a timeline that may be paused, moved, looped and played at another speed.
//
// Capture times are the recording's own, so that its weights are those of `furrow solve` while it
// plays on from its start, whatever the speed; where it goes back, the filter begins anew. While it
// is paused the frame is sent again now and then, so that the subject is not taken for lost. Where
// another sender takes the subject over, the recording goes on unseen, which is said once in the
// log, and has its subject back when that one has gone.
class Player : public Link {
 public:
  struct State {
    std::string file;
    std::string subject;
    int frames = 0;
    double seconds = 0.0;  // from the first frame to the last
    double rate_hz = 0.0;
    double position = 0.0;  // seconds from the first frame
    int frame = 0;          // what was sent last
    bool playing = true;
    bool loop = true;
    double speed = 1.0;
  };
  // What is set is changed; the rest stays.
  struct Change {
    std::optional<bool> playing;
    std::optional<bool> loop;
    std::optional<double> speed;     // [kMinSpeed, kMaxSpeed]
    std::optional<double> position;  // clamped to the recording
  };
  static constexpr double kMinSpeed = 0.05;
  static constexpr double kMaxSpeed = 8.0;

  // The subject is called as the file is. Errors: the readers'; kInvalidArgument: no frames, or
  // what the wire cannot carry, such as more blend shapes or names that are not UTF-8.
  [[nodiscard]] static Result<std::unique_ptr<Player>> Load(const std::filesystem::path& path);
  explicit Player(motion::Clip clip, std::string file);

  // Offers the subject and sends its first frame. The hub outlives this.
  void Start(Hub* hub, Time now);
  // Sends the frame that is due, if any; when to call it next.
  Time Advance(Time now);
  // Errors: kInvalidArgument, `where` is the field; then nothing has changed.
  [[nodiscard]] Status Apply(const Change& change, Time now);
  [[nodiscard]] State state(Time now) const;

  // Link: the answers to a publisher.
  void SendReply(std::span<const std::uint8_t> message) override;
  int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
    return 0;
  }
  void DropFrames(std::uint64_t) override {}

 private:
  [[nodiscard]] double PositionAt(Time now) const;
  [[nodiscard]] int FrameAt(double position) const;
  void MoveTo(double position, Time now);
  void Offer(Time now);
  void SendPose(int frame, Time now);

  const motion::Clip clip_;
  const std::string file_;
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
  bool needed_ = false;   // the daemon has asked for the offer again
  bool refused_ = false;  // what it said last, and the log was told
  std::uint32_t sequence_ = 0;
  protocol::Encoder encoder_;
  protocol::PoseFrame pose_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace furrow::server
