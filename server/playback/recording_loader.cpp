// SPDX-License-Identifier: Apache-2.0
#include "server/playback/recording_loader.h"

#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include "base/process/in_background.h"
#include "motion/clip_file.h"
#include "server/core/within_memory.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr int kNice = 10;  // 0 is the usual priority, 19 the lowest

bool IsBusy(const std::future<void>& thread) {
  return thread.valid() && thread.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

}  // namespace

Status RecordingLoader::Load(UploadedFile file, Done done) {
  const std::lock_guard lock(mutex_);
  if (reads_) {
    return Status(StatusCode::kUnavailable, "another recording is being read", {}, "try again");
  }
  // Shared, because a task must be copyable.
  const auto shared = std::make_shared<UploadedFile>(std::move(file));
  reads_ = true;
  try {
    reading_ = std::async(std::launch::async, [this, shared, done = std::move(done)]() mutable {
      (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
      Result<Loaded> loaded =
          OrOutOfMemory(parts_.metrics, "recording", [&] { return Read(*shared); });
      shared->buffer.reset();
      reads_ = false;  // whoever hears of the end may load the next file
      // Without memory for the message, the caller notices that nothing is read any more.
      WithinMemory(parts_.metrics, [&] { done(std::move(loaded)); });
    });
  } catch (const std::exception&) {  // no thread, or no memory for it
    reads_ = false;
    return Status(StatusCode::kUnavailable, "no further thread can start", {}, "try again");
  }
  return {};
}

// Everything a hostile file can cause ends here, as one error.
Result<RecordingLoader::Loaded> RecordingLoader::Read(const UploadedFile& file) const {
  try {
    if (!parts_.runs_helpers && motion::NeedsHelperProgram(file.bytes(), file.name)) {
      return Status(StatusCode::kUnsupported,
                    "a helper program reads FBX and Collada files, and a confined daemon starts "
                    "none after its start",
                    file.name,
                    "convert it with 'furrow convert " + file.name +
                        " FILE.glb', or start furrowd with --play");
    }
    Loaded loaded;
    auto player = Player::Parse(file.bytes(), file.name, parts_.read, &loaded.warnings);
    FURROW_RETURN_IF_ERROR(player);
    loaded.player = *std::move(player);
    if (loaded.warnings.size() > kMaxWarnings) loaded.warnings.resize(kMaxWarnings);
    return loaded;
  } catch (const std::bad_alloc&) {
    parts_.metrics->Add(Counter::kAllocationsFailed);
    return Status(StatusCode::kUnavailable, "not enough memory to read the recording", file.name,
                  "shorten the recording, or free memory on the daemon's computer");
  } catch (const std::exception& error) {
    return Status(StatusCode::kInternal, error.what(), file.name);
  }
}

void RecordingLoader::Release(std::unique_ptr<Player> player) {
  const std::lock_guard lock(mutex_);
  if (IsBusy(released_)) return;  // frees it here
  released_ =
      InBackground([last = std::shared_ptr<Player>(std::move(player))]() mutable { last.reset(); });
}

bool RecordingLoader::WaitUntil(Time deadline) {
  const std::lock_guard lock(mutex_);
  if (!reading_.valid()) return true;
  return reading_.wait_for(deadline - ReadClock()) == std::future_status::ready;
}

}  // namespace furrow::server
