// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "client/cli/play/play_source.h"
#include "client/cli/play/session_schedule.h"
#include "client/cli/play/spacing.h"
#include "client/cpp/publisher.h"

namespace furrow::cli {

// Sends what the subjects of a session did, each pose at its time, over streams that a daemon has
// accepted.
class SessionPlayer {
 public:
  struct Track {
    std::uint16_t stream = 0;
    const PlaySource* source = nullptr;
  };
  struct Options {
    double speed = 1.0;
    bool loop = false;
    protocol::PoseEncoding encoding;
  };
  // `tracks` are those of the schedule, in its order.
  SessionPlayer(client::Publisher& publisher, std::vector<Track> tracks, SessionSchedule schedule,
                const Options& options);

  // To the end, or an interrupt, or what makes going on useless. Prints how it went; returns the
  // exit code. A subject that the daemon takes no more poses of does not stop the others.
  [[nodiscard]] int Run();

 private:
  void Play();
  bool WaitUntil(std::int64_t due_us);
  void Note(client::IoStatus status);
  [[nodiscard]] int Report() const;

  client::Publisher& publisher_;
  std::vector<Track> tracks_;
  SessionSchedule schedule_;
  Options options_;
  std::vector<Spacing> spacing_;  // of each track
  std::int64_t refused_ = 0;      // over UDP: answers that nobody listens at the port
  bool closed_ = false;
};

}  // namespace furrow::cli
