// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recording_queue.h"

#include <utility>

namespace furrow::server {
namespace {

// This much queued data wakes the recording thread early.
constexpr std::size_t kWakeBytes = 512 * 1024;

}  // namespace

void RecordingBatch::Add(Entry entry, std::string_view subject,
                         std::span<const std::uint8_t> payload) {
  entry.subject_bytes = subject.size();
  entry.payload_bytes = payload.size();
  entries_.push_back(entry);
  // One block for all events: a pose costs two copies and, once the block has grown, no allocation.
  bytes_.insert(bytes_.end(), subject.begin(), subject.end());
  bytes_.insert(bytes_.end(), payload.begin(), payload.end());
}

void RecordingBatch::Clear() {
  entries_.clear();
  bytes_.clear();
}

bool RecordingQueue::Push(const RecordingBatch::Entry& entry, std::string_view subject,
                          std::span<const std::uint8_t> payload) {
  bool wake = false;
  {
    const std::lock_guard lock(mutex_);
    const std::size_t after = waiting_.bytes() + subject.size() + payload.size();
    if (stopped_ || after > (entry.is_declaration() ? 2 * max_bytes_ : max_bytes_)) return false;
    // Only the event that crosses the threshold wakes the thread, not each one after it.
    wake = waiting_.bytes() < kWakeBytes && after >= kWakeBytes;
    waiting_.Add(entry, subject, payload);
  }
  // After unlocking, so that the thread does not wake up only to wait for the mutex.
  if (wake) changed_.notify_one();
  return true;
}

bool RecordingQueue::Take(RecordingBatch* batch, std::chrono::milliseconds wait) {
  batch->Clear();
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [this] { return stopped_ || waiting_.bytes() >= kWakeBytes; });
  // Swapping keeps the time under the mutex short and gives the memory of the last batch back.
  std::swap(*batch, waiting_);
  // The batch that is taken after Stop() is the last one: Push() refuses from then on.
  return !stopped_;
}

void RecordingQueue::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_one();
}

}  // namespace furrow::server
