// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string_view>
#include <vector>

#include "recording/take_format.h"

namespace furrow::server {

// What happened, in order, with all its bytes in one piece of memory that is used again and again.
class RecordingBatch {
 public:
  enum class Event : std::uint8_t {
    kMessage,   // of `kind`
    kDatagram,  // `subject` holds the sender's bytes
    kGone,      // `subject` has left
  };
  struct Entry {
    Event event = Event::kMessage;
    recording::TakeKind kind = recording::TakeKind::kPose;
    recording::TakeStamp stamp;
    std::size_t subject_bytes = 0;
    std::size_t payload_bytes = 0;
  };

  void Add(Entry entry, std::string_view subject, std::span<const std::uint8_t> payload);
  void Clear();
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

  // Calls `use(entry, subject, payload)` for each, in order, until it returns false.
  template <class Use>
  void ForEach(const Use& use) const {
    std::size_t at = 0;
    for (const Entry& entry : entries_) {
      const std::string_view subject(reinterpret_cast<const char*>(bytes_.data()) + at,
                                     entry.subject_bytes);
      const std::span payload =
          std::span(bytes_).subspan(at + entry.subject_bytes, entry.payload_bytes);
      if (!use(entry, subject, payload)) return;
      at += entry.subject_bytes + entry.payload_bytes;
    }
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> bytes_;
};

// Between the network threads and the one that writes to disk: bounded by bytes, and whoever pushes
// never waits for the disk. Does not allocate once both batches have grown.
class RecordingQueue {
 public:
  // Beyond `max_bytes` nothing is taken but declarations (skeletons and names, without which the
  // rest means nothing) and departures, of which another `max_bytes` fit.
  explicit RecordingQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // False: full, what happened is not recorded.
  [[nodiscard]] bool Push(const RecordingBatch::Entry& entry, std::string_view subject,
                          std::span<const std::uint8_t> payload);
  // Swaps what waits with `batch`, which is cleared first: at once where much waits or the queue is
  // stopped, else after `wait`. False: stopped, and this was the last.
  [[nodiscard]] bool Take(RecordingBatch* batch, std::chrono::milliseconds wait);
  // No more is pushed; Take() ends.
  void Stop();

 private:
  const std::size_t max_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  RecordingBatch waiting_;
  bool stopped_ = false;
};

}  // namespace furrow::server
