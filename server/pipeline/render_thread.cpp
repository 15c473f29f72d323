// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_thread.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "base/status.h"

namespace furrow::server {
namespace {

// One job per subject and view, so the limit concerns the number of different views only.
constexpr std::size_t kMaxWaitingJobs = 256;
constexpr int kMaxReadBacks = 2;  // the limit of render::Renderer

}  // namespace

Result<std::unique_ptr<RenderThread>> RenderThread::Start(const wrinkle::Skeleton* skeleton,
                                                          Factory make_renderer, Metrics* metrics,
                                                          Deliver deliver) {
  std::unique_ptr<RenderThread> self(
      new RenderThread(skeleton, std::move(make_renderer), metrics, std::move(deliver)));
  // EGL binds a context to the thread that makes it current, so the render thread creates the
  // renderer and reports back.
  std::promise<Status> started;
  std::future<Status> status = started.get_future();
  self->thread_ = std::thread(&RenderThread::Run, self.get(), std::move(started));
  // The thread has ended in this case; the destructor of `self` joins it.
  FURROW_RETURN_IF_ERROR(status.get());
  return self;
}

RenderThread::RenderThread(const wrinkle::Skeleton* skeleton, Factory make_renderer,
                           Metrics* metrics, Deliver deliver)
    : make_renderer_(std::move(make_renderer)),
      metrics_(metrics),
      deliver_(std::move(deliver)),
      mailbox_(kMaxWaitingJobs),
      drawn_(skeleton) {}

RenderThread::~RenderThread() {
  mailbox_.Close();
  if (thread_.joinable()) thread_.join();
}

void RenderThread::Submit(RenderJob job) {
  switch (mailbox_.Put(std::move(job))) {
    case RenderMailbox::PutResult::kQueued:
    case RenderMailbox::PutResult::kNotWanted: break;
    case RenderMailbox::PutResult::kReplaced: metrics_->Add(Counter::kSnapshotsReplaced); break;
    // Put() leaves the job alone only in this case. Its viewers must hear of it, because they wait
    // for an answer to every ticket.
    case RenderMailbox::PutResult::kFull: Fail(std::move(job)); break;
  }
}

Result<render::Camera> RenderThread::Preset(std::string_view name) const {
  std::string names;
  for (const auto& [known, camera] : presets_) {
    if (known == name) return camera;
    names += (names.empty() ? "" : ", ") + known;
  }
  return Status(StatusCode::kNotFound, "no camera '" + std::string(name) + "'", "",
                "one of: " + names);
}

Status RenderThread::CreateRenderer() {
  auto renderer = make_renderer_();
  FURROW_RETURN_IF_ERROR(renderer);
  renderer_ = *std::move(renderer);
  return {};
}

void RenderThread::Run(std::promise<Status> started) {
  const Status status = CreateRenderer();
  if (status.ok()) {
    description_ = renderer_->description();
    for (const std::string_view name : render::CameraPresetNames()) {
      // Preset() serves network threads from this copy; they must not call the renderer.
      if (auto camera = renderer_->Preset(name); camera.ok()) presets_.emplace_back(name, *camera);
    }
  }
  // Everything above happens before Start() returns and is read-only afterwards, so it needs no
  // lock.
  started.set_value(status);
  if (!status.ok()) return;
  while (!mailbox_.closed()) {
    // Fills the read-backs before it waits for the oldest, so that the GPU draws one picture while
    // this thread encodes another. Blocks in Take() only if nothing is in flight.
    while (static_cast<int>(in_flight_.size()) < kMaxReadBacks) {
      std::optional<RenderJob> job = mailbox_.Take(/*wait=*/in_flight_.empty());
      if (!job) break;
      Draw(*std::move(job));
    }
    if (!in_flight_.empty()) Collect(/*wait=*/true);
  }
  renderer_.reset();  // on this thread, which owns the context
}

void RenderThread::Draw(RenderJob job) {
  if (renderer_ == nullptr && !Revive()) return Fail(std::move(job));
  const Snapshot& snapshot = *job.snapshot;
  // Retargeting runs here, not on the network thread: only poses that are drawn pay for it.
  if (drawn_.Run({*snapshot.retarget, *snapshot.blend_shape_pose, snapshot.shape_program.get(),
                  snapshot.head_turn.get()},
                 snapshot.joints, snapshot.blend_shapes) != wrinkle::JobStatus::kOk) {
    return Fail(std::move(job));
  }
  render::FrameRequest request;
  request.model = drawn_.model();
  request.shapes = drawn_.shapes();
  request.binding = snapshot.binding.get();
  request.wrinkle_weights = snapshot.wrinkle_weights;
  request.filtered_values = snapshot.filtered_values;
  if (job.spec.settings != nullptr) request.settings = *job.spec.settings;
  request.settings.view = job.spec.view;
  // 0 leaves the number to the device; a number that the user set also holds for stills.
  if (int& samples = request.settings.anti_aliasing.samples; samples == 0 && job.IsStill()) {
    samples = kStillSamples;
  }
  request.camera = job.spec.camera;
  request.width = job.spec.width;
  request.height = job.spec.height;
  if (Status status = renderer_->Submit(request); !status.ok()) {
    Fail(std::move(job));
    // Other errors concern the job (its size, its pose), not the context.
    if (status.code() == StatusCode::kUnavailable || status.code() == StatusCode::kInternal) {
      Rebuild(status);
    }
    return;
  }
  in_flight_.push_back(std::move(job));
}

void RenderThread::Collect(bool wait) {
  Result<render::Image> image = renderer_->Poll(wait);
  if (!image.ok()) {
    Rebuild(image.status());
    return;
  }
  if (image->width == 0) return;
  // A finished picture, not a created context, proves that rendering works again.
  next_skip_ = 0;
  metrics_->Add(Counter::kPicturesRendered);
  // Read-backs finish in the order of Submit(), so the oldest job belongs to this image.
  const RenderJob job = std::move(in_flight_.front());
  in_flight_.pop_front();
  Finish(*image, job);
}

// Returns all tickets without a picture, so that the viewers' flow control does not wait forever.
void RenderThread::Fail(RenderJob job) {
  metrics_->Add(Counter::kPicturesFailed);
  deliver_({.sequence = job.snapshot->sequence, .tickets = std::move(job.tickets)});
}

void RenderThread::Finish(const render::Image& image, const RenderJob& job) {
  // Viewers with equal encodings share the bytes.
  std::vector<Encoding> done;
  for (const PictureTicket& first : job.tickets) {
    const Encoding encoding = EncodingOf(first);
    if (std::ranges::find(done, encoding) != done.end()) continue;
    done.push_back(encoding);
    auto bytes = render::EncodeImage(image, encoding.format, encoding.quality);
    metrics_->Add(bytes.ok() ? Counter::kPicturesEncoded : Counter::kPicturesFailed);
    if (!bytes.ok()) {
      spdlog::warn("cannot encode a picture: {}", bytes.status().ToString());
      // Without bytes the picture reports a failure to its viewers.
      bytes = std::vector<std::uint8_t>();
    }
    FinishedPicture picture{
        .sequence = job.snapshot->sequence,
        .capture_time_us = job.snapshot->capture_time_us,
        .age_us = job.snapshot->age_us,
        .received_us = job.snapshot->received_us,
        .width = image.width,
        .height = image.height,
        .encoding = encoding,
        .bytes = {bytes->begin(), bytes->end()},  // exact capacity: the bytes may wait in queues
        .tickets = {}};
    for (const PictureTicket& ticket : job.tickets) {
      if (EncodingOf(ticket) == encoding) picture.tickets.push_back(ticket);
    }
    deliver_(std::move(picture));
  }
}

// Drops the context with everything in flight. The next job that may try creates it again.
void RenderThread::Rebuild(const Status& reason) {
  spdlog::error("the renderer failed and will be created again: {}", reason.ToString());
  metrics_->Add(Counter::kRendererRestarts);
  for (RenderJob& job : in_flight_) Fail(std::move(job));
  in_flight_.clear();
  renderer_.reset();
  BackOff();
}

// Tries to create the renderer for the present job. False: this job is skipped.
bool RenderThread::Revive() {
  if (jobs_to_skip_ > 0) {
    --jobs_to_skip_;
    return false;
  }
  if (Status status = CreateRenderer(); !status.ok()) {
    spdlog::error("cannot create the renderer; pictures are paused: {}", status.ToString());
    BackOff();
    return false;
  }
  spdlog::info("rendering again on {}", renderer_->description());
  return true;
}

// 0, 1, 3, 7 ... jobs. Counting jobs instead of time needs no clock, and without viewers no attempt
// is made.
void RenderThread::BackOff() {
  jobs_to_skip_ = next_skip_;
  next_skip_ = std::min(2 * next_skip_ + 1, kMaxJobsSkipped);
}

}  // namespace furrow::server
