// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "client/cli/common/connection_notes.h"
#include "client/cli/common/refusal_note.h"
#include "client/cli/play/pacing_error.h"
#include "client/cli/play/play_source.h"
#include "client/cli/play/session_schedule.h"
#include "client/cpp/publisher.h"

namespace furrow::cli {

// Sends the poses of a session in real time, over streams that the daemon has accepted.
class SessionPlayer {
 public:
  struct Track {
    std::uint16_t stream = 0;            // from Publisher::AddSubject()
    const PlaySource* source = nullptr;  // not null
  };
  struct Options {
    double speed = 1.0;  // factor of the recorded speed, > 0
    bool loop = false;   // repeat until an interrupt
    bool once = false;   // a lost connection ends the playback
    protocol::PoseEncoding encoding;
    bool redundant = false;  // repeat the previous pose where there is room
  };
  // `publisher` and the sources of `tracks` must outlive the player. `tracks`: one per track of
  // `schedule`, in the order of its tracks.
  SessionPlayer(client::Publisher& publisher, std::vector<Track> tracks, SessionSchedule schedule,
                const Options& options);

  // Plays to the end, an interrupt or a closed connection. Prints a summary and returns the exit
  // code. A subject that the daemon rejects does not stop the others.
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
  std::vector<PacingError> pacing_;  // per track
  std::int64_t unsent_ = 0;          // poses without a connection
  ConnectionNotes notes_;
  bool closed_ = false;
  RefusalNote refusal_;
};

}  // namespace furrow::cli
