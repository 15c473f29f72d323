// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "render/renderer.h"
#include "render/video/video_codec.h"
#include "server/core/time.h"
#include "server/pipeline/snapshot.h"
#include "server/shares/fair_order.h"
#include "server/shares/work_budget.h"

namespace furrow::server {

// What a picture shows, apart from the pose. Equal specs of one subject are rendered once.
struct PictureSpec {
  render::View view = render::View::kFinal;
  render::Camera camera;
  int width = 640;  // pixels
  int height = 640;
  // All settings except the view; null: the renderer's defaults. Compared by address, because
  // ViewSettings shares equal settings.
  std::shared_ptr<const render::Settings> settings;

  [[nodiscard]] bool operator==(const PictureSpec& other) const;
  // Writes everything but the subject.
  void Describe(render::FrameRequest* request) const;
};

// How a picture is encoded. Equal encodings of one picture are made once.
struct Encoding {
  render::ImageFormat format = render::ImageFormat::kJpeg;
  int quality = 85;  // JPEG: [1, 100]

  [[nodiscard]] bool operator==(const Encoding&) const = default;
};

// One recipient of a picture.
struct PictureTicket {
  std::uint64_t subscription = 0;  // Subscription::uid
  Encoding encoding;               // while the subject moves; see EncodingOf()
  std::uint32_t view_request = 0;  // sequence of the request that set the view
  std::uint8_t tier = 0;           // ViewerFlow::tier() that chose the encoding
  bool still = false;              // the refined picture of a pose at rest
  bool acknowledges = false;       // flow control: the viewer gets a still when the pose rests
  std::uint64_t viewer = 0;        // Peer::id
  std::uint64_t host = 0;          // HostKey() of the viewer's host
  // Set: the viewer has a video encoder (PictureSource::OpenVideo()). A still is a file all the
  // same, and so is a picture that the encoder does not take.
  std::optional<render::VideoTarget> video;
};

// A number for a host, by which tickets name it.
[[nodiscard]] inline std::uint64_t HostKey(const std::string& host) {
  return std::hash<std::string>()(host);
}

// The encoding to use for a ticket: for a still JPEG, quality 92 without chroma subsampling.
[[nodiscard]] Encoding EncodingOf(const PictureTicket& ticket);

// A picture of one subject to render, with all its recipients. A job without tickets only refreshes
// the snapshot of an equal job that still waits.
struct RenderJob {
  std::uint64_t subject = 0;
  PictureSpec spec;
  std::shared_ptr<const Snapshot> snapshot;
  std::vector<PictureTicket> tickets;
  Time moved_at{0};   // when the subject last moved; set if a viewer uses flow control
  Time submitted{0};  // to the renderer
  Time taken{0};      // by the render thread
  Time drawn{0};      // by the renderer
  // Of PictureStreams; 0: none. Set by the render thread, unless the job prepares.
  std::uint64_t stream = 0;
  bool prepares = false;   // nobody sees the picture: it compiles what later pictures need
  FairOrder::Entry entry;  // set by the mailbox, as is was_held
  bool was_held = false;   // it waited for the budget of its hosts

  // True if at least one ticket wants a still, which is rendered with more samples.
  [[nodiscard]] bool IsStill() const;
  // True if nobody gets the picture as it was drawn: all tickets are for JPEG or video of a subject
  // that moves.
  [[nodiscard]] bool IsLossy() const;
  // True if all its viewers get the next picture at once and a better one soon, so that a draft of
  // the character serves them: moving pictures of viewers with flow control.
  [[nodiscard]] bool TakesDraft() const;
  // What drawing it costs (render::PictureCost::work).
  [[nodiscard]] double Work() const;
};

// The samples per pixel of a still if the settings leave the number to the device.
inline constexpr int kStillSamples = 4;

// Carries jobs from the network threads to the render thread. At most one job per subject and spec
// waits, with the newest snapshot, and at most `capacity` jobs in total, of which one host gets at
// most half of what the others have left. A subscription has at most one waiting ticket, for the
// spec that it requested last. Thread-safe; Put() never waits for rendering.
//
// The order is fair (FairOrder) between hosts, and between the viewers of a host. Large pictures
// are more work, so a viewer gets fewer of them. A budget (WorkBudget) may limit the work of each
// host and of all together.
class RenderMailbox {
 public:
  using Clock = Time (*)();
  explicit RenderMailbox(std::size_t capacity) : capacity_(capacity) {}

  // From now on, jobs of a host that has used up its budget wait until it may be served again.
  // `limits`: in RenderJob::Work() per second.
  void SetBudget(const WorkBudget::Limits& limits, Clock clock);

  // How many jobs of moving subjects may pass a waiting still, so that stills are not starved.
  static constexpr int kMaxPassedOver = 8;

  enum class PutResult { kQueued, kReplaced, kFull, kNotWanted };
  // Adds a job. Waiting tickets of the same subscriptions for other pictures are removed, and so
  // are jobs without tickets.
  // - kQueued: a new job waits.
  // - kReplaced: the job replaced one of the same subject and spec and took over its tickets.
  //   If the subject has moved, tickets for stills become normal ones.
  // - kNotWanted: the job has no tickets and there was no job to refresh.
  // - kFull: `capacity` jobs wait, the host has its share of them, or the mailbox is closed. Only
  //   in this case is `job` unchanged.
  PutResult Put(RenderJob&& job);

  // Adds a job that prepares later pictures (RenderJob::prepares), before the others of its kind
  // with `first`. It waits until nothing else does.
  void PutPreparation(RenderJob job, bool first = false);

  // Removes and returns the next job. Moving subjects go before stills, but at most kMaxPassedOver
  // jobs pass a still; preparations come last. With `wait`, blocks until there is a job or Close()
  // was called. Every job with tickets must be given back by Complete().
  // With `drafts`, takes only jobs that a draft may serve (RenderJob::TakesDraft()).
  [[nodiscard]] std::optional<RenderJob> Take(bool wait, bool drafts = false);
  // Take() returns without a job: the one that waits, or else the next one.
  void Wake();
  // False: drawing a job of Take() may stop, because all its tickets were withdrawn, because a
  // picture waits that is more urgent than a preparation, or because the mailbox is closed.
  [[nodiscard]] bool IsWanted(const RenderJob& job) const;
  // Call it once for each job of Take(), before its picture is encoded or it fails. Removes the
  // tickets that were withdrawn in the meantime and returns how many these are.
  std::size_t Complete(RenderJob* job);

  // Cancels a still that waits or is being drawn. False: there is none.
  bool WithdrawStill(std::uint64_t subscription);
  // Cancels whatever the subscription waits for, because it has ended: jobs that nobody else wants
  // are not drawn, and if drawing has begun, not encoded. Returns how many jobs that saves.
  std::size_t Withdraw(std::uint64_t subscription);

  // Removes and returns all jobs that wait; Complete() is not called for these.
  [[nodiscard]] std::vector<RenderJob> TakeWaiting();

  // Both at once, so that no job is lost between them.
  [[nodiscard]] std::vector<RenderJob> CloseAndTake();
  // Drops all jobs. Take() no longer blocks.
  void Close();
  [[nodiscard]] bool closed() const;

 private:
  using Jobs = std::deque<RenderJob>;
  // The tickets being drawn: their subscriptions, and whether they are stills.
  using Taken = std::unordered_multimap<std::uint64_t, bool>;
  [[nodiscard]] std::vector<RenderJob> TakeLocked();
  void CloseLocked();
  void DropOlderTickets(const RenderJob& job);
  [[nodiscard]] bool HasRoomFor(const RenderJob& job) const;
  [[nodiscard]] Jobs::iterator Next(bool still, bool drafts, Time now);
  [[nodiscard]] bool HasJob(bool drafts) const { return ReadyAt(drafts) <= Now(); }
  [[nodiscard]] Time ReadyAt(const RenderJob& job) const;
  [[nodiscard]] Time ReadyAt(bool drafts) const;
  [[nodiscard]] Time Now() const { return clock_ == nullptr ? Time(0) : clock_(); }
  [[nodiscard]] Taken::const_iterator FindTaken(std::uint64_t subscription, bool still) const;
  void WaitForJob(std::unique_lock<std::mutex>* lock, bool drafts);
  void MarkHeld(Time now);
  [[nodiscard]] std::pair<std::size_t, std::size_t> CountWaiting(std::uint64_t host) const;

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Jobs jobs_;
  std::deque<RenderJob> preparations_;
  Taken taken_;
  FairOrder order_;
  WorkBudget budget_;
  Clock clock_ = nullptr;  // null: there is no budget
  int passed_over_ = 0;    // consecutive jobs that passed a still
  bool woken_ = false;
  bool closed_ = false;
};

}  // namespace furrow::server
