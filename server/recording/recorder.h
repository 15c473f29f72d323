// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/status.h"
#include "protocol/codec/codec.h"
#include "recording/take_folder.h"
#include "server/core/metrics.h"
#include "server/recording/recording_queue.h"
#include "server/session/recording_tap.h"

namespace furrow::server {

// The options of a recorder.
struct RecorderOptions {
  recording::TakeFolderOptions folder;
  bool datagrams = true;                                // also record the datagrams as received
  Time wall_offset{0};                                  // system clock minus steady clock
  std::size_t queue_bytes = std::size_t{64} << 20;      // maximum of bytes that wait for the disk
  Time retry = std::chrono::seconds(5);                 // between attempts to go on after an error
  std::uint64_t least_space = std::uint64_t{64} << 20;  // free bytes that an attempt needs
};

// Records skeletons, poses, weights and datagrams of a hub in MCAP files (docs/RECORDING.md). The
// network threads only copy bytes into a queue; a background thread writes them.
//
// - Data is flushed as a whole chunk within a second, so a killed daemon loses at most that second.
// - If the disk is too slow, messages are missing from the recording; they are counted and logged.
//   Live poses are not affected.
// - A write error, as on a full disk, pauses the recording. It goes on in a new file, complete in
//   itself, as soon as the disk has room. What it misses is counted and logged.
class Recorder : public RecordingTap {
 public:
  // Opens the folder and starts the thread. `metrics` must outlive the recorder. Errors: those of
  // TakeFolder::Open().
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> Start(RecorderOptions options, Time now,
                                                               Metrics* metrics);
  ~Recorder() override;  // writes the queue and completes the file
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Before the end of a daemon that could not start: leaves no file behind if nothing was recorded.
  void Discard() { discards_ = true; }

  // True after a write error, until the recording goes on. Thread-safe.
  [[nodiscard]] bool is_paused() const { return paused_.load(std::memory_order_relaxed); }

  void OnOffer(const Subject& subject, const protocol::SkeletonOffer& offer, Time now) override;
  void OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time now) override;
  void OnWeights(const Subject& subject, std::int64_t age_us, Time now) override;
  void OnSubjectGone(const Subject& subject) override;
  void OnRig(const wrinkle::Rig& rig, const SubjectRegistry& subjects, Time now) override;
  void OnDatagram(const recording::DatagramSender& sender, std::span<const std::uint8_t> bytes,
                  Time now) override;

 private:
  Recorder(RecorderOptions options, std::unique_ptr<recording::TakeFolder> folder,
           Metrics* metrics);
  template <class Message>
  void PushEncoded(recording::TakeKind kind, const Subject& subject, const Message& message,
                   Time now);
  void Push(recording::TakeKind kind, const Subject& subject, std::span<const std::uint8_t> payload,
            Time now);
  void PushEntry(const RecordingBatch::Entry& entry, std::string_view subject,
                 std::span<const std::uint8_t> payload);
  // What the weights of the subject mean from now on.
  void DeclareNames(const Subject& subject, Time now);
  [[nodiscard]] std::uint64_t LogTime(Time now) const;

  // On the recording thread.
  void Write();
  [[nodiscard]] Status WriteBatch(const RecordingBatch& batch);
  [[nodiscard]] Status WriteEntry(const RecordingBatch::Entry& entry, std::string_view subject,
                                  std::span<const std::uint8_t> payload);
  void Pause(const Status& status);
  void TryToGoOn(Time now);
  [[nodiscard]] Status LeaveLostFile(Time now);
  template <class Work>
  [[nodiscard]] Status Guarded(const Work& work);
  void ReportDropped(std::string_view why);

  const RecorderOptions options_;
  Metrics* const metrics_;
  std::unique_ptr<recording::TakeFolder> folder_;  // used by the recording thread
  RecordingQueue queue_;
  std::atomic<bool> paused_ = false;
  std::atomic<bool> discards_ = false;
  Time next_try_{0};  // while paused
  std::uint64_t reported_dropped_ = 0;

  // Subjects with recorded weights. Changes only under the hub's exclusive lock.
  std::map<SubjectId, std::uint64_t> names_hashes_;

  std::thread thread_;
};

}  // namespace furrow::server
