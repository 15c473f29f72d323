// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "render/renderer.h"
#include "server/core/time.h"
#include "server/pipeline/snapshot.h"

namespace furrow::server {

// What a picture shows, apart from the pose: equal ones of one subject are drawn once.
struct PictureSpec {
  render::View view = render::View::kFinal;
  render::Camera camera;
  int width = 640;
  int height = 640;
  // Of everything but the view; null: the renderer's defaults. Equal ones are one object
  // (ViewSettings).
  std::shared_ptr<const render::Settings> settings;

  [[nodiscard]] bool operator==(const PictureSpec& other) const;
};

// How a drawn picture is packed: equal ones are encoded once.
struct Encoding {
  render::ImageFormat format = render::ImageFormat::kJpeg;
  int quality = 85;  // JPEG: [1, 100]

  [[nodiscard]] bool operator==(const Encoding&) const = default;
};

// Who gets a picture, and packed how.
struct PictureTicket {
  std::uint64_t subscription = 0;  // Subscription::uid
  Encoding encoding;               // of a subject that moves
  std::uint32_t view_request = 0;  // the request whose view it is
  std::uint8_t tier = 0;           // what `encoding` stands for: ViewerFlow::tier()
  bool still = false;              // the refined picture of a pose at rest
};

// How a ticket's picture is packed: a still as JPEG of quality 92, without subsampling.
[[nodiscard]] Encoding EncodingOf(const PictureTicket& ticket);

// A picture to be drawn of one subject, for everybody who waits for this very one. Without tickets:
// a newer snapshot for a job that still waits, and nothing where there is none.
struct RenderJob {
  std::uint64_t subject = 0;
  PictureSpec spec;
  std::shared_ptr<const Snapshot> snapshot;
  std::vector<PictureTicket> tickets;
  Time moved_at{0};  // when the subject last moved, where somebody watches with flow control

  // Drawn with more care: it is a still for one of those who wait, at least.
  [[nodiscard]] bool IsStill() const;
};

// The way from the network threads to the render thread: at most one job a (subject, spec) waits,
// the newest snapshot wins, and no put ever blocks on drawing. Bounded by `capacity` keys; a
// subscription has one ticket, of the spec that it asked for last.
class RenderMailbox {
 public:
  explicit RenderMailbox(std::size_t capacity) : capacity_(capacity) {}

  static constexpr int kMaxPassedOver = 8;

  enum class PutResult { kQueued, kReplaced, kFull, kNotWanted };
  // kReplaced: an older snapshot of the same subject and spec was dropped; its tickets join the new
  // job's, one a subscription, and are stills no more where the subject moved. kNotWanted: a job
  // without tickets found none to refresh. kFull: the job is as it was; else it is moved from.
  // Tickets of the job's subscriptions that wait for another picture go, and with the last of its
  // tickets a job.
  PutResult Put(RenderJob&& job);

  // The longest waiting job, those that move before stills (unless kMaxPassedOver of them went
  // before the oldest job already). With `wait`, blocks until there is one or Close() was called.
  [[nodiscard]] std::optional<RenderJob> Take(bool wait);

  // Takes back a still that waits. False: none does, or it is being drawn.
  bool WithdrawStill(std::uint64_t subscription);

  // Take() no longer blocks, and what waits is dropped.
  void Close();
  [[nodiscard]] bool closed() const;

 private:
  void DropOlderTickets(const RenderJob& job);

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RenderJob> jobs_;
  int passed_over_ = 0;  // jobs taken since the oldest was at the front
  bool closed_ = false;
};

}  // namespace furrow::server
