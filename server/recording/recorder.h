// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
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

struct RecorderOptions {
  recording::TakeFolderOptions folder;
  bool datagrams = true;                            // record them as they came, too
  Time wall_offset{0};                              // system clock less steady clock
  std::size_t queue_bytes = std::size_t{64} << 20;  // that may wait for the disk
};

// Records what the tap tells, on a thread of its own: the network threads only copy bytes.
//
// - What happened is on the way to the disk within a second, as a whole chunk: a killed daemon
//   loses no more.
// - A disk that is too slow costs messages of the recording, counted and logged, never a pose. A
//   write that fails ends the recording with one line in the log, and the daemon goes on.
class Recorder : public RecordingTap {
 public:
  // Errors: TakeFolder::Open()'s.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> Start(RecorderOptions options, Time now,
                                                               Metrics* metrics);
  ~Recorder() override;  // writes what waits and completes the file
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void OnOffer(const Subject& subject, const protocol::SkeletonOffer& offer, Time now) override;
  void OnPose(const Subject& subject, std::span<const std::uint8_t> payload, Time now) override;
  void OnWeights(const Subject& subject, std::int64_t age_us, Time now) override;
  void OnSubjectGone(const Subject& subject) override;
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
  [[nodiscard]] std::uint64_t LogTime(Time now) const;

  // On the recording thread.
  void Write();
  [[nodiscard]] Status WriteBatch(const RecordingBatch& batch);
  void ReportDropped();

  const RecorderOptions options_;
  Metrics* const metrics_;
  std::unique_ptr<recording::TakeFolder> folder_;  // the recording thread's
  RecordingQueue queue_;
  std::atomic<bool> failed_ = false;
  std::uint64_t reported_dropped_ = 0;

  // Of those whose weights are recorded; changes only while one thread is alone in the hub.
  std::map<SubjectId, std::uint64_t> names_hashes_;

  std::thread thread_;
};

}  // namespace furrow::server
