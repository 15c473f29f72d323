// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/status.h"
#include "motion/clip/clip.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/playback/player.h"
#include "server/playback/uploaded_file.h"

namespace furrow::server {

// Reads uploaded recordings on a thread of its own, one at a time, because a large one takes
// seconds. The thread has a low priority, so that weights and pictures go on. Thread-safe.
class RecordingLoader {
 public:
  struct Parts {
    motion::LoadOptions read;
    bool runs_helpers = false;   // this process may start helper programs
    Metrics* metrics = nullptr;  // not null; outlives the loader
  };
  explicit RecordingLoader(Parts parts) : parts_(std::move(parts)) {}
  RecordingLoader(const RecordingLoader&) = delete;
  RecordingLoader& operator=(const RecordingLoader&) = delete;
  // Waits for the thread.
  ~RecordingLoader() = default;

  struct Loaded {
    std::unique_ptr<Player> player;
    std::vector<std::string> warnings;  // at most kMaxWarnings
  };
  static constexpr std::size_t kMaxWarnings = 8;
  // Called on the loader's thread. Errors: those of Player::Parse(); kUnsupported for a format that
  // needs a helper program where none may run; kUnavailable if memory is short.
  using Done = std::function<void(Result<Loaded>)>;
  // Reads the file. Error: kUnavailable, if another one is being read, or no thread can start;
  // `done` is not called then.
  [[nodiscard]] Status Load(UploadedFile file, Done done);
  // True from a successful Load() until the file has been read.
  [[nodiscard]] bool is_reading() const { return reads_; }
  // Frees a recording on another thread.
  void Release(std::unique_ptr<Player> player);
  // Waits until nothing is being read, at most until `deadline`. False: it still is.
  [[nodiscard]] bool WaitUntil(Time deadline);

 private:
  [[nodiscard]] Result<Loaded> Read(const UploadedFile& file) const;

  const Parts parts_;
  std::mutex mutex_;
  std::future<void> released_;  // destroying a future waits for its thread
  std::future<void> reading_;
  std::atomic<bool> reads_ = false;  // a file is being read
};

}  // namespace furrow::server
