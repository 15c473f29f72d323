// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/render_thread.h"

#include <algorithm>

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "base/process/in_background.h"
#include "base/status.h"
#include "render/temporal/shot.h"
#include "server/core/within_memory.h"

namespace furrow::server {
namespace {

// One job per subject and view, so the limit concerns the number of different views only.
constexpr std::size_t kMaxWaitingJobs = 256;
constexpr int kMaxReadBacks = 2;  // the limit of render::Renderer
// While a picture of this much work is drawn (more than 1920 x 1080 pixels), no other is begun, so
// that a newcomer with a small picture waits for one large picture, not for two.
constexpr double kLargeWork = 2.5e6;

// Counts the steps of the renderer for Watch(): odd within a step.
class Step {
 public:
  explicit Step(std::atomic<std::uint64_t>* steps) : steps_(steps) { ++*steps_; }
  ~Step() { ++*steps_; }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 private:
  std::atomic<std::uint64_t>* steps_;
};

}  // namespace

Result<std::unique_ptr<RenderThread>> RenderThread::Start(const wrinkle::Skeleton* skeleton,
                                                          Factory make_renderer, Metrics* metrics,
                                                          Clock clock, OnPicture deliver,
                                                          VideoEncoders* video) {
  // EGL binds a context to the thread that makes it current, so the render thread creates the
  // renderer and reports back.
  std::promise<Status> started;
  std::future<Status> status = started.get_future();
  auto self =
      StartLater(skeleton, std::move(make_renderer), metrics, clock, std::move(deliver), video,
                 {.presets = {}, .draft = nullptr, .on_started = [&started](const Status& done) {
                    started.set_value(done);
                  }});
  // The thread has ended in this case; the destructor of `self` joins it.
  FURROW_RETURN_IF_ERROR(status.get());
  return self;
}

std::unique_ptr<RenderThread> RenderThread::StartLater(const wrinkle::Skeleton* skeleton,
                                                       Factory make_renderer, Metrics* metrics,
                                                       Clock clock, OnPicture deliver,
                                                       VideoEncoders* video, Later later) {
  std::unique_ptr<RenderThread> self(new RenderThread(skeleton, std::move(make_renderer), metrics,
                                                      clock, std::move(deliver), video));
  self->presets_ = std::move(later.presets);
  self->thread_ =
      std::thread([thread = self.get(), later = std::move(later)] { thread->Run(later); });
  return self;
}

RenderThread::RenderThread(const wrinkle::Skeleton* skeleton, Factory make_renderer,
                           Metrics* metrics, Clock clock, OnPicture deliver, VideoEncoders* video)
    : make_renderer_(std::move(make_renderer)),
      metrics_(metrics),
      clock_(clock),
      deliver_(std::move(deliver)),
      video_(video),
      mailbox_(kMaxWaitingJobs),
      progress_(&mailbox_, &steps_),
      drawn_(skeleton),
      encoder_(metrics, clock, &deliver_, video) {}

RenderThread::~RenderThread() {
  mailbox_.Close();
  if (thread_.joinable()) thread_.join();
}

void RenderThread::Progress::Begin(const RenderJob* job) {
  job_ = job;
  abandoned_ = false;
  done_ = 0;
}

void RenderThread::Progress::End() {
  job_ = nullptr;
  passes_ = 0;
}

bool RenderThread::Progress::Continues() {
  abandoned_ = job_ != nullptr && !mailbox_->IsWanted(*job_);
  return !abandoned_;
}

std::optional<PictureSource::Drawing> RenderThread::Progress::drawing() const {
  const int passes = passes_;
  if (passes == 0) return std::nullopt;
  return Drawing{std::min<int>(done_, passes), passes};
}

void RenderThread::Prepare(std::vector<RenderJob> jobs) {
  for (RenderJob& job : jobs) {
    job.prepares = true;
    mailbox_.PutPreparation(std::move(job));
  }
}

void RenderThread::Submit(RenderJob job) {
  if (is_stuck()) return Refuse(std::move(job));
  job.submitted = clock_();
  switch (mailbox_.Put(std::move(job))) {
    case RenderMailbox::PutResult::kQueued:
    case RenderMailbox::PutResult::kNotWanted: break;
    case RenderMailbox::PutResult::kReplaced: metrics_->Add(Counter::kSnapshotsReplaced); break;
    // Put() leaves the job alone only in this case. Its viewers must hear of it, because they wait
    // for an answer to every ticket.
    case RenderMailbox::PutResult::kFull:
      metrics_->Add(Counter::kPicturesCrowded);
      Refuse(std::move(job));
      break;
  }
}

void RenderThread::Withdraw(std::uint64_t subscription) {
  metrics_->Add(Counter::kPicturesWithdrawn, mailbox_.Withdraw(subscription));
  CloseVideo(subscription);
}

std::string RenderThread::fault() const {
  return failed_ ? "the renderer could not start" : PictureSource::fault();
}

Result<render::Camera> RenderThread::Preset(std::string_view name) const {
  if (failed_) return Status(StatusCode::kInternal, fault());
  std::string names;
  for (const auto& [known, camera] : presets_) {
    if (known == name) return camera;
    names += (names.empty() ? "" : ", ") + known;
  }
  return Status(StatusCode::kNotFound, "no camera '" + std::string(name) + "'", "",
                "one of: " + names);
}

Status RenderThread::CreateRenderer() {
  auto renderer = OrOutOfMemory(metrics_, "renderer", make_renderer_);
  FURROW_RETURN_IF_ERROR(renderer);
  Use(*std::move(renderer));
  return {};
}

void RenderThread::Use(std::unique_ptr<render::Renderer> renderer) {
  renderer_ = std::move(renderer);
  renderer_->SetObserver(&progress_);
  if (started_) return;
  description_ = renderer_->description();
  is_software_ = renderer_->is_software();
  if (presets_.empty()) {
    for (const std::string_view name : render::CameraPresetNames()) {
      // Preset() serves network threads from this copy; they must not call the renderer.
      if (auto camera = renderer_->Preset(name); camera.ok()) presets_.emplace_back(name, *camera);
    }
  }
  started_ = true;  // everything above is read-only from here on, so it needs no lock
}

void RenderThread::Run(const Later& later) {
  // Of this thread alone, and of those that start from it.
  (void)setpriority(PRIO_PROCESS, 0, kNiceness);
  const Status status = StartRenderer(later);
  if (!status.ok()) {
    failed_ = true;
    WithinMemory(metrics_, [this] {
      for (RenderJob& job : mailbox_.CloseAndTake()) Refuse(std::move(job));
    });
  }
  later.on_started(status);
  if (status.ok()) DrawUntilClosed();
  make_renderer_ = nullptr;
  ended_ = true;
}

// Returns when the renderer of the whole character is there. Until then, draws drafts.
Status RenderThread::StartRenderer(const Later& later) {
  if (!later.draft) return CreateRenderer();
  std::atomic<bool> is_whole_ready = false;
  auto whole = InBackground([this, &is_whole_ready] {
    auto renderer = OrOutOfMemory(metrics_, "renderer", make_renderer_);
    if (renderer.ok()) (*renderer)->Release();
    is_whole_ready = true;
    mailbox_.Wake();
    return renderer;
  });
  drafts_ = true;
  StartDraft(later.draft);
  // A draft that is lost is not made again.
  while (renderer_ != nullptr && !is_whole_ready && !mailbox_.closed()) {
    WithinMemory(metrics_, [this] { DrawAndCollect(); });
  }
  while (renderer_ != nullptr && !in_flight_.empty()) {
    WithinMemory(metrics_, [this] { Collect(/*wait=*/true); });
  }
  renderer_.reset();
  auto renderer = whole.get();
  drafts_ = false;
  FURROW_RETURN_IF_ERROR(renderer);
  Use(*std::move(renderer));
  return {};
}

// Without a draft, jobs wait. A GPU has the whole character in less time than it takes a person to
// see the difference.
void RenderThread::StartDraft(const Factory& make) {
  auto draft = OrOutOfMemory(metrics_, "renderer", make);
  if (!draft.ok() || !(*draft)->is_software()) return;
  Use(*std::move(draft));
}

void RenderThread::DrawUntilClosed() {
  while (!mailbox_.closed()) {
    // What could not be reported; see Deliver().
    WithinMemory(metrics_, [this] { DrawAndCollect(); });
  }
  renderer_.reset();  // on this thread, which owns the context
}

void RenderThread::DrawAndCollect() {
  // Fills the read-backs before it waits for the oldest, so that the GPU draws one picture while
  // this thread encodes another. Blocks in Take() only if nothing is in flight.
  while (!(drafts_ && renderer_ == nullptr) &&
         static_cast<int>(in_flight_.size()) < kMaxReadBacks &&
         (in_flight_.empty() || in_flight_.back().Work() < kLargeWork)) {
    std::optional<RenderJob> job = TakeJob();
    if (!job) break;
    job->taken = clock_();
    if (!job->prepares) metrics_->Observe(Timing::kPictureWait, job->taken - job->submitted);
    if (job->was_held) metrics_->Add(Counter::kPicturesHeld);
    Draw(*std::move(job));
  }
  if (!in_flight_.empty()) Collect(/*wait=*/true);
}

// Waits only if nothing is in flight.
std::optional<RenderJob> RenderThread::TakeJob() {
  if (!in_flight_.empty()) return mailbox_.Take(/*wait=*/false, drafts_);
  const Time begun = clock_();
  std::optional<RenderJob> job = mailbox_.Take(/*wait=*/true, drafts_);
  idle_ += clock_() - begun;
  return job;
}

void RenderThread::Draw(RenderJob job) {
  const Step step(&steps_);
  if (renderer_ == nullptr && !Revive()) return Fail(std::move(job));
  // In flight before it is drawn, so that nothing can fail between the two.
  in_flight_.push_back(std::move(job));
  progress_.Begin(&in_flight_.back());
  const Status status =
      OrOutOfMemory(metrics_, "renderer", [this] { return Render(&in_flight_.back()); });
  progress_.End();
  if (status.ok()) return;
  job = std::move(in_flight_.back());
  in_flight_.pop_back();
  if (progress_.abandoned()) return Abandon(std::move(job));
  Fail(std::move(job));
  // Other errors concern the job (its size, its pose), not the context.
  if (status.code() == StatusCode::kUnavailable || status.code() == StatusCode::kInternal) {
    Rebuild(status);
  }
}

Status RenderThread::Render(RenderJob* taken) {
  const RenderJob& job = *taken;
  render::FrameRequest request;
  // Retargeting runs here, not on the network thread: only poses that are drawn pay for it.
  FURROW_RETURN_IF_ERROR(Show(*job.snapshot, &drawn_, &request));
  job.spec.Describe(&request);
  // 0 leaves the number to the device; a number that the user set also holds for stills.
  int& samples = request.settings.anti_aliasing.samples;
  const bool refines = samples == 0 && job.IsStill();
  if (refines) samples = kStillSamples;
  request.is_moving = is_software_ && job.IsLossy();
  // A draft is not worth the programs that only completed pictures need.
  if (!drafts_ && render::CanBeCompleted(request, is_software_)) {
    const PictureStreams::Place place = streams_.Find(job);
    request.stream = place.stream;
    request.scale = place.scale;
    taken->stream = place.stream;
  }
  const Status status = renderer_->Submit(request);
  // A large still with this number of samples needs too much memory.
  if (!refines || status.code() != StatusCode::kLimit) return status;
  samples = 0;
  return renderer_->Submit(request);
}

void RenderThread::Collect(bool wait) {
  const Step step(&steps_);
  Result<render::Image> image =
      OrOutOfMemory(metrics_, "renderer", [this, wait] { return renderer_->Poll(wait); });
  if (!image.ok()) {
    Rebuild(image.status());
    return;
  }
  if (image->width == 0) return;
  // A finished picture, not a created context, proves that rendering works again.
  next_skip_ = 0;
  // Read-backs finish in the order of Submit(), so the oldest job belongs to this image.
  RenderJob job = std::move(in_flight_.front());
  in_flight_.pop_front();
  job.drawn = clock_();
  streams_.OnDrawn(job.stream, job.drawn - idle_, job.drawn);
  if (job.prepares) return;
  metrics_->Add(Counter::kPicturesRendered);
  metrics_->Observe(Timing::kPictureDraw, job.drawn - job.taken);
  Finish(*image, std::move(job));
}

void RenderThread::Watch(Time now) {
  const std::uint64_t step = steps_;
  if (step % 2 == 0 || step != watched_step_) {
    watched_step_ = step;
    watched_since_ = now;
    if (stuck_.exchange(false)) spdlog::info("the renderer responds again; pictures go on");
    return;
  }
  if (stuck_ || now - watched_since_ < kStuckAfter) return;
  stuck_ = true;
  metrics_->Add(Counter::kRendererStuck);
  spdlog::error(
      "the renderer has not responded for {} s: pictures are off until it does, weights go on",
      static_cast<int>(ToSeconds(now - watched_since_)));
  for (RenderJob& job : mailbox_.TakeWaiting()) Refuse(std::move(job));
}

// The frame of a job has ended early. What it has compiled remains.
void RenderThread::Abandon(RenderJob job) {
  if (job.prepares) return mailbox_.PutPreparation(std::move(job), /*first=*/true);
  (void)mailbox_.Complete(&job);
  // A viewer may have come back between the last pass and now.
  if (!job.tickets.empty()) Refuse(std::move(job));
}

// A job that was taken from the mailbox cannot be drawn.
void RenderThread::Fail(RenderJob job) {
  if (job.prepares) return;
  (void)mailbox_.Complete(&job);
  Refuse(std::move(job));
}

// Returns all tickets without a picture, so that the viewers' flow control does not wait forever.
void RenderThread::Refuse(RenderJob job) {
  metrics_->Add(Counter::kPicturesFailed);
  Deliver({.sequence = job.snapshot->sequence, .tickets = std::move(job.tickets)});
}

// If memory is so short that not even a failure can be reported, the viewers ask again after
// ViewerFlow::kGiveUp.
void RenderThread::Deliver(FinishedPicture picture) {
  WithinMemory(metrics_, [&] { deliver_(std::move(picture)); });
}

void RenderThread::Finish(const render::Image& image, RenderJob job) {
  (void)mailbox_.Complete(&job);
  encoder_.Encode(image, std::move(job));
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
