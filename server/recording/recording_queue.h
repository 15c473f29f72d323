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

// A sequence of events to record. Their bytes share one block of memory, which Clear() keeps.
class RecordingBatch {
 public:
  enum class Event : std::uint8_t {
    kMessage,   // a message of `kind`
    kDatagram,  // a datagram; `subject` holds the sender's address
    kGone,      // `subject` has left
    kRig,       // the payload is the rig of the weights that follow, as JSON
  };
  struct Entry {
    Event event = Event::kMessage;
    recording::TakeKind kind = recording::TakeKind::kPose;
    recording::TakeStamp stamp;
    std::size_t subject_bytes = 0;
    std::size_t payload_bytes = 0;

    // True for events without which the messages after them cannot be read.
    [[nodiscard]] bool is_declaration() const {
      return event == Event::kGone || event == Event::kRig ||
             (event == Event::kMessage &&
              (kind == recording::TakeKind::kSkeleton || kind == recording::TakeKind::kNames));
    }
  };

  // Appends an event with copies of its texts; sets the sizes in `entry`.
  void Add(Entry entry, std::string_view subject, std::span<const std::uint8_t> payload);
  void Clear();
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }

  // Calls `use(entry, subject, payload)` for each event in order, until it returns false.
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

// Carries events from the network threads to the recording thread. Bounded in bytes; Push() never
// waits for the disk. Does not allocate once both batches have grown. Thread-safe.
class RecordingQueue {
 public:
  // Holds `max_bytes` of all events, and another `max_bytes` of declarations.
  explicit RecordingQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // False: the queue is full or stopped; the event is lost.
  [[nodiscard]] bool Push(const RecordingBatch::Entry& entry, std::string_view subject,
                          std::span<const std::uint8_t> payload);
  // Replaces `batch` with all queued events. Returns at once if 512 KiB are queued or the queue is
  // stopped, otherwise after `wait`. False: the queue is stopped and this was the last batch.
  [[nodiscard]] bool Take(RecordingBatch* batch, std::chrono::milliseconds wait);
  // Rejects further events. Take() then returns the queued events and false.
  void Stop();

 private:
  const std::size_t max_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  RecordingBatch waiting_;
  bool stopped_ = false;
};

}  // namespace furrow::server
