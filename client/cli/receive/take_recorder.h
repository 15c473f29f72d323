// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/status.h"
#include "client/cpp/subscriber.h"
#include "recording/take_folder.h"

namespace furrow::cli {

// Writes the skeletons, poses, weight names and weights of subjects to a take, with unchanged
// payloads.
//
// The file is created at the daemon's first answer, so that no file remains if there was nothing to
// record. Data is flushed about twice per second.
class TakeRecorder {
 public:
  // `wall_offset_us`: system clock minus the clock of `now_us`.
  TakeRecorder(recording::TakeFolderOptions options, std::int64_t wall_offset_us)
      : options_(std::move(options)), wall_offset_us_(wall_offset_us) {}

  // Subscribes to poses and weights of `subject`; empty: the oldest live subject. `wait`: wait for
  // the subject if it is not connected yet.
  void Subscribe(client::Subscriber& subscriber, const std::string& subject, bool wait);
  // Subscribes to all present and future subjects.
  void SubscribeToAll(client::Subscriber& subscriber);

  // Records one event. `subscriber`: as passed to Subscribe(). `now_us`: monotonic clock. Errors:
  // those of TakeFolder.
  [[nodiscard]] Status OnEvent(const client::Event& event, client::Subscriber& subscriber,
                               std::int64_t now_us);
  // Call this when the daemon answers again after a loss: its subjects need a moment to return.
  void OnReturn();
  // Flushes buffered data if the flush interval has passed. Call it several times per second.
  [[nodiscard]] Status Flush(std::int64_t now_us);
  // Completes the file, if there is one. Errors: those of TakeFolder.
  [[nodiscard]] Status Close();

  [[nodiscard]] std::uint64_t num_poses() const { return num_poses_; }
  [[nodiscard]] std::uint64_t num_weights() const { return num_weights_; }
  // Number of frames that the daemon dropped because this program or the network was too slow.
  [[nodiscard]] std::uint64_t num_dropped() const;
  // After SubscribeToAll(): the daemon's number of subjects; nothing before its first answer, and
  // after a loss until a subject has returned.
  [[nodiscard]] std::optional<std::uint32_t> num_present() const { return num_present_; }
  // Names of the recorded subjects: "ada, bob".
  [[nodiscard]] std::string SubjectNames() const;
  // The files being written; null before the daemon's first answer.
  [[nodiscard]] const recording::TakeFolder* folder() const { return folder_.get(); }

 private:
  struct Source {
    std::string subject;
    std::uint64_t session = 0;            // of the publisher
    std::vector<std::uint8_t> names;      // payload of the last reply about weights
    std::vector<std::uint32_t> requests;  // for poses, then for weights
  };
  [[nodiscard]] Status Begin(std::int64_t now_us);
  [[nodiscard]] Status OnReply(const client::Event& event, const client::Subscriber& subscriber,
                               std::int64_t now_us);
  [[nodiscard]] Status Write(recording::TakeKind kind, const Source& source,
                             const protocol::Header& header, std::span<const std::uint8_t> payload,
                             std::int64_t now_us);

  recording::TakeFolderOptions options_;
  std::int64_t wall_offset_us_;
  std::unique_ptr<recording::TakeFolder> folder_;
  std::vector<Source> sources_;
  std::set<std::string> subscribed_;
  std::optional<std::uint32_t> num_present_;
  std::map<std::uint16_t, std::size_t> source_of_;  // by subscription
  std::map<std::uint16_t, std::uint64_t> dropped_;  // by subscription of this connection
  std::uint64_t dropped_before_ = 0;                // on earlier connections
  bool returning_ = false;                          // no subject has returned after a loss
  std::int64_t flushed_us_ = 0;
  std::uint64_t num_poses_ = 0;
  std::uint64_t num_weights_ = 0;
};

}  // namespace furrow::cli
