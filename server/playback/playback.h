// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "base/status.h"
#include "server/core/time.h"
#include "server/playback/player.h"
#include "server/session/hub.h"

namespace furrow::server {

// Decides which recording the daemon plays: that of --play, or an uploaded one while there is one.
// The recording of --play then stands still without a subject, and goes on where it was when the
// uploaded one is closed. All functions run on the thread of shard 0.
class Playback {
 public:
  // Takes the recording of --play. Call it before Start().
  void SetConfigured(std::unique_ptr<Player> player) { configured_ = std::move(player); }
  // Begins to play. `hub` must outlive this object, or end before anything else is called.
  // `on_change`: called when another recording plays, so that Advance() is due; may be empty.
  // `release`: takes the recordings that are not needed any more. Freeing one takes long, so it
  // should not be done on this thread.
  void Start(Hub* hub, Time now, std::function<void()> on_change,
             std::function<void(std::unique_ptr<Player>)> release);

  // What plays; null: nothing.
  [[nodiscard]] Player* player() const {
    return uploaded_ != nullptr ? uploaded_.get() : configured_.get();
  }
  [[nodiscard]] bool is_uploaded() const { return uploaded_ != nullptr; }

  // Plays `player` from now on, instead of what plays now. Error: kUnavailable, with the reason of
  // the hub, such as another sender of the subject; what played before then goes on.
  [[nodiscard]] Status Play(std::unique_ptr<Player> player, Time now);
  // Ends the uploaded recording. False: there is none.
  bool Close(Time now);
  // Sends a frame if one is due. Returns when to call it next: kNever if nothing plays.
  Time Advance(Time now);
  static constexpr Time kNever = Time::max();

 private:
  Hub* hub_ = nullptr;
  std::function<void()> on_change_;
  std::function<void(std::unique_ptr<Player>)> release_;
  std::unique_ptr<Player> configured_;
  std::unique_ptr<Player> uploaded_;
};

}  // namespace furrow::server
