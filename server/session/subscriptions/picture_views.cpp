// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/picture_views.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>

#include "protocol/messages/limits.h"
#include "render/passes/picture_cost.h"
#include "render/request/request_check.h"

namespace furrow::server {
namespace {

// Pictures that may wait for a slow viewer without flow control.
constexpr std::size_t kMaxQueuedPictures = 1;
// The space in a message of kMaxReplyBytes beside the envelope and the table.
constexpr std::size_t kMaxPictureBytes = protocol::kMaxReplyBytes - 1024;

// After this time without visible movement, a viewer gets the refined picture.
constexpr Time kAtRestAfter = FromSeconds(0.1);
constexpr int kTierQualities[ViewerFlow::kNumTiers] = {85, 65, 45};  // JPEG

// The camera of a request: a preset, or free eye and target, which may follow the face's joint. The
// coordinates come from the wire, so they are checked.
Result<render::Camera> CameraOf(const protocol::SubscribePictures& request,
                                const PictureSource& pictures) {
  if (!request.has_camera) {
    return pictures.Preset(request.camera_preset.empty() ? "face" : request.camera_preset);
  }
  render::Camera camera;
  if (request.camera_follows) {
    const Result<render::Camera> preset = pictures.Preset("face");
    FURROW_RETURN_IF_ERROR(preset);
    camera = *preset;
  }
  const protocol::Camera& given = request.camera;
  camera.position = {given.eye.x, given.eye.y, given.eye.z};
  camera.target = {given.target.x, given.target.y, given.target.z};
  camera.fov_y_degrees = given.vertical_fov_degrees;
  render::FrameRequest frame;
  frame.camera = camera;
  frame.camera.follow_joint = -1;  // the joints come from the preset and need no check
  frame.camera.turn_joint = -1;
  FURROW_RETURN_IF_ERROR(render::CheckRequest(frame, /*num_joints=*/0));
  return camera;
}

// Since when the viewer has been shown the same: neither the subject nor the view has changed.
Time UnchangedSince(const Subscription& subscription, const PictureRequest& request) {
  return std::max(subscription.subject->rest.moved_at(), request.changed);
}

bool IsAtRest(const Subscription& subscription, const PictureRequest& request, Time now) {
  return now - UnchangedSince(subscription, request) >= kAtRestAfter;
}

// Encoders want even sizes. The picture gets another column or row, which the viewer leaves out.
render::VideoFormat VideoFormatOf(const PictureRequest& request) {
  const auto even = [](int pixels) { return pixels + pixels % 2; };
  return {.width = even(request.spec.width),
          .height = even(request.spec.height),
          .quality = request.encoding.quality};
}

// The job of this spec, added if it is absent. All jobs of a list share one snapshot.
RenderJob& FindOrAddJob(const Subscription& subscription, const PictureSpec& spec,
                        std::int64_t age_us, std::vector<RenderJob>* jobs) {
  const auto job = std::ranges::find(*jobs, spec, &RenderJob::spec);
  if (job != jobs->end()) return *job;
  const Subject& subject = *subscription.subject;
  std::shared_ptr<const Snapshot> snapshot =
      jobs->empty() ? subject.pipeline->TakeSnapshot(age_us, ToMicroseconds(subject.last_pose))
                    : jobs->front().snapshot;
  jobs->push_back({subject.id, spec, std::move(snapshot), {}, subject.rest.moved_at()});
  return jobs->back();
}

}  // namespace

Result<PictureRequest> PictureViews::MakeRequest(const protocol::SubscribePictures& request) {
  PictureRequest result;
  if (const int pixels = request.width * request.height; pixels > kMaxPicturePixels) {
    return Status(StatusCode::kLimit,
                  "a picture of " + std::to_string(request.width) + "x" +
                      std::to_string(request.height) + " has more than " +
                      std::to_string(kMaxPicturePixels) + " pixels",
                  "", "ask for a smaller one, or draw large stills by 'furrow render'");
  }
  const Result<render::View> view = render::ParseView(request.view);
  FURROW_RETURN_IF_ERROR(view);
  Result<SharedSettings> settings = settings_.Get(request.settings);
  FURROW_RETURN_IF_ERROR(settings);
  const std::size_t bytes =
      render::EstimateCost(**settings, request.width, request.height).texture_bytes;
  if (bytes > kMaxTextureBytes) {
    return Status(StatusCode::kLimit,
                  "the picture needs " + std::to_string(bytes >> 20) +
                      " MiB of textures; the limit is " + std::to_string(kMaxTextureBytes >> 20) +
                      " MiB",
                  "", "ask for fewer pixels, a smaller anti_aliasing.samples or shadow.resolution");
  }
  const Result<render::Camera> camera = CameraOf(request, *pictures_);
  FURROW_RETURN_IF_ERROR(camera);
  result.spec = {.view = *view,
                 .camera = *camera,
                 .width = request.width,
                 .height = request.height,
                 .settings = *std::move(settings)};
  // Kept as text, because the daemon's own settings below them may change (SetOwnSettings()).
  result.overrides = request.settings;
  const bool png = request.format == protocol::ImageFormat::kPng;
  result.encoding.format = png ? render::ImageFormat::kPng : render::ImageFormat::kJpeg;
  // PNG has no quality. One value for all makes equal encodings compare equal.
  result.encoding.quality = png ? 0 : request.quality;
  result.wants_video =
      !png && std::ranges::find(request.codecs, protocol::kH264) != request.codecs.end();
  return result;
}

void PictureViews::SetView(Subscription& subscription, PictureRequest view, Time now) {
  auto& request = std::get<PictureRequest>(subscription.request);
  // The numbers of pictures and acknowledgements continue across a change of the view.
  view.flow = std::move(request.flow);
  view.video = std::move(request.video);
  if (!view.wants_video && view.video) {
    view.video.reset();
    pictures_->CloseVideo(subscription.uid);
  }
  request = std::move(view);
  BeginVideo(request);
  MarkChanged(subscription, request, now);
}

std::vector<Subscription*> PictureViews::SetOwnSettings(const render::Settings& settings,
                                                        Time now) {
  settings_.SetOwn(settings);
  std::vector<Subscription*> changed;
  table_->ForEach([&](Subscription& subscription) {
    auto* request = std::get_if<PictureRequest>(&subscription.request);
    if (request == nullptr) return;
    // Overrides that were valid once are valid on top of any settings.
    Result<SharedSettings> merged = settings_.Get(request->overrides);
    if (!merged.ok()) return;
    request->spec.settings = *std::move(merged);
    MarkChanged(subscription, *request, now);
    changed.push_back(&subscription);
  });
  return changed;
}

void PictureViews::BeginVideo(PictureRequest& request) {
  if (request.flow && request.wants_video && !request.video) request.video.emplace();
}

// A still of the old view that is not rendered yet would only delay the new view.
void PictureViews::MarkChanged(const Subscription& subscription, PictureRequest& request,
                               Time now) {
  request.changed = now;
  if (request.flow && request.flow->is_pending() && pictures_->WithdrawStill(subscription.uid)) {
    request.flow->Withdraw();
  }
}

PictureRequest* PictureViews::FlowControlled(Subscription& subscription) {
  auto* request = std::get_if<PictureRequest>(&subscription.request);
  return request != nullptr && request->flow ? request : nullptr;
}

bool PictureViews::NeedsStill(Subscription& subscription, Time now) {
  const PictureRequest* viewer = FlowControlled(subscription);
  return viewer != nullptr && !viewer->flow->HasStill(UnchangedSince(subscription, *viewer)) &&
         IsAtRest(subscription, *viewer, now);
}

void PictureViews::AddJob(Subscription& subscription, PictureRequest& request, std::int64_t age_us,
                          Time now, std::vector<RenderJob>* jobs) {
  if (request.flow) return AddFlowControlledJob(subscription, request, age_us, now, jobs);
  // The ticket names the subscription by uid, not by address: it may end while the job waits or
  // renders on another thread.
  FindOrAddJob(subscription, request.spec, age_us, jobs)
      .tickets.push_back({.subscription = subscription.uid,
                          .encoding = request.encoding,
                          .view_request = request.view_request,
                          .viewer = subscription.peer->id,
                          .host = HostKey(subscription.peer->host)});
}

void PictureViews::OnEnd(const Subscription& subscription) {
  if (pictures_ == nullptr || !std::holds_alternative<PictureRequest>(subscription.request)) return;
  pictures_->Withdraw(subscription.uid);
}

void PictureViews::AddFlowControlledJob(Subscription& subscription, PictureRequest& request,
                                        std::int64_t age_us, Time now,
                                        std::vector<RenderJob>* jobs) {
  ViewerFlow& flow = *request.flow;
  const bool at_rest = IsAtRest(subscription, request, now);
  // FanOut sets `owed` before delivery if a limit forbids the frame; here the flow control decides.
  subscription.owed = false;
  // The viewer already has the refined picture of this pose and view.
  if (at_rest && flow.HasStill(UnchangedSince(subscription, request))) return;
  if (!flow.CanRequest(now)) {
    subscription.owed = true;
    // A job without tickets refreshes the pose of a picture that still waits for the renderer.
    if (flow.is_pending()) FindOrAddJob(subscription, request.spec, age_us, jobs);
    return;
  }
  flow.Request(at_rest, now);
  PictureTicket ticket{.subscription = subscription.uid,
                       .encoding = request.encoding,
                       .view_request = request.view_request,
                       // The tier travels with the picture, because the viewer's tier may change
                       // while it is rendered.
                       .tier = static_cast<std::uint8_t>(flow.tier()),
                       .still = at_rest,
                       .acknowledges = true,
                       .viewer = subscription.peer->id,
                       .host = HostKey(subscription.peer->host)};
  if (request.encoding.format == render::ImageFormat::kJpeg) {
    ticket.encoding.quality = kTierQualities[flow.tier()];
  }
  // Also for a still, which becomes a moving picture if its subject moves before it is drawn.
  if (request.video &&
      pictures_->OpenVideo(subscription.uid, subscription.peer->host, VideoFormatOf(request))) {
    ticket.video = request.video->Target();
  }
  FindOrAddJob(subscription, request.spec, age_us, jobs).tickets.push_back(ticket);
}

// The mailbox keeps the newest snapshot per view, so this never waits for the renderer.
void PictureViews::Submit(std::vector<RenderJob>* jobs) {
  for (RenderJob& job : *jobs) pictures_->Submit(std::move(job));
  jobs->clear();
}

void PictureViews::OnPicture(const FinishedPicture& picture, Time now) {
  // A large PNG may exceed protocol::kMaxReplyBytes, which clients refuse.
  const bool too_large = picture.bytes.size() > kMaxPictureBytes;
  if (too_large) {
    metrics_->Add(Counter::kPicturesFailed, picture.tickets.size());
    if (!std::exchange(has_logged_large_picture_, true)) {
      spdlog::warn(
          "a picture of {} x {} pixels has {} bytes, more than a message may hold; "
          "request JPEG or a smaller size",
          picture.width, picture.height, picture.bytes.size());
    }
  }
  const bool failed = too_large || picture.bytes.empty();
  if (!failed) FillImage(picture);
  for (const PictureTicket& ticket : picture.tickets) {
    Subscription* subscription = table_->Find(ticket.subscription);
    if (subscription == nullptr) continue;  // it ended while the picture was rendered
    // Another node may serve the subject since the picture was requested.
    const bool unplaced =
        subscription->subject != nullptr && now >= subscription->subject->served_until;
    if (!failed && !unplaced) {
      SendPicture(*subscription, picture, ticket, now);
    } else if (PictureRequest* viewer = FlowControlled(*subscription); viewer != nullptr) {
      // Ends the request; the tick asks again after ViewerFlow::kRetry.
      viewer->flow->Fail();
      OweNext(*subscription, picture);
    }
  }
}

// A picture of a flow-controlled viewer does not reach it.
void PictureViews::OweNext(Subscription& subscription, const FinishedPicture& picture) {
  auto& request = std::get<PictureRequest>(subscription.request);
  // Pictures that were never encoded leave no gap in the video.
  if (request.video && !picture.codec.empty()) request.video->Lose();
  subscription.owed = subscription.subject != nullptr;
}

void PictureViews::FillImage(const FinishedPicture& picture) {
  image_.width = static_cast<std::uint16_t>(picture.width);
  image_.height = static_cast<std::uint16_t>(picture.height);
  image_.format = picture.encoding.format == render::ImageFormat::kPng
                      ? protocol::ImageFormat::kPng
                      : protocol::ImageFormat::kJpeg;
  image_.age_us = picture.age_us;
  image_.received_us = picture.received_us;
  image_.bytes = picture.bytes;
  image_.codec = picture.codec;
  image_.key = picture.key;
  image_.drawn_percent = static_cast<std::uint8_t>(picture.drawn_percent);
}

void PictureViews::SendPicture(Subscription& subscription, const FinishedPicture& picture,
                               const PictureTicket& ticket, Time now) {
  // `view_request` comes from the ticket: the viewer may have changed its view since, and tells by
  // this number which view the picture shows.
  auto& request = std::get<PictureRequest>(subscription.request);
  image_.view_request = ticket.view_request;
  image_.tier = ticket.still || !picture.codec.empty() ? 0 : ticket.tier;
  image_.still = ticket.still;
  image_.number = request.flow ? request.flow->Send() : 0;
  image_.dropped = request.flow ? request.flow->dropped() : 0;
  const MessageSender::Sent sent =
      messages_->SendFrame(*subscription.peer, subscription.uid,
                           {.stream = subscription.id,
                            .sequence = picture.sequence,
                            .capture_time_us = picture.capture_time_us},
                           image_, Counter::kPicturesSent, Counter::kPicturesDroppedSlow,
                           request.flow ? ViewerFlow::kMaxUnderWay : kMaxQueuedPictures);
  if (!sent.had_room && request.flow) {
    request.flow->TakeBack();
    return OweNext(subscription, picture);
  }
  if (!request.video) return;
  request.video->Sent(image_.number, picture.bytes.size(), picture.key, now);
  // Which picture of the viewer made room is not known. It may be one of this video.
  if (sent.dropped > 0) request.video->Lose();
}

}  // namespace furrow::server
