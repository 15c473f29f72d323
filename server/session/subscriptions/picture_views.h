// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "render/settings/settings.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/pipeline/picture_source.h"
#include "server/session/delivery/message_sender.h"
#include "server/session/subscriptions/subscription.h"
#include "server/session/subscriptions/subscription_table.h"
#include "server/session/subscriptions/view_settings.h"

namespace furrow::server {

// Manages the subscriptions to pictures (STANDARD.md section 9): checks what each viewer requests,
// requests pictures from the renderer for each pose, and sends finished pictures to their viewers.
// Equal views of a subject share one picture.
//
// AddJob() and Submit() may run on several threads for different subjects; all other functions
// require exclusive access to the hub.
class PictureViews {
 public:
  // The largest picture, and the most memory of the textures that one picture needs. Strangers may
  // ask.
  static constexpr int kMaxPicturePixels = 2048 * 2048;
  static constexpr std::size_t kMaxTextureBytes = std::size_t{512} << 20;

  // `pictures` may be null: this daemon renders nothing. `settings`: the daemon's own.
  PictureViews(const SubscriptionTable* table, PictureSource* pictures,
               const render::Settings& settings, MessageSender* messages, Metrics* metrics)
      : table_(table),
        pictures_(pictures),
        settings_(settings),
        messages_(messages),
        metrics_(metrics) {}

  [[nodiscard]] bool can_render() const { return pictures_ != nullptr; }
  [[nodiscard]] std::string fault() const { return can_render() ? pictures_->fault() : ""; }
  [[nodiscard]] bool is_stuck() const { return can_render() && pictures_->is_stuck(); }
  // Checks a request. Errors: unknown view, camera or setting, or values out of range.
  // Precondition: can_render().
  [[nodiscard]] Result<PictureRequest> MakeRequest(const protocol::SubscribePictures& request);

  // Replaces the view of a picture subscription and keeps its flow control. The caller sends the
  // newest pose in the new view.
  void SetView(Subscription& subscription, PictureRequest view, Time now);
  [[nodiscard]] const render::Settings& own_settings() const { return settings_.own(); }
  // Replaces the daemon's settings. Returns the subscriptions with changed views.
  [[nodiscard]] std::vector<Subscription*> SetOwnSettings(const render::Settings& settings,
                                                          Time now);

  // The request of a viewer that acknowledges its pictures; null for all other subscriptions.
  [[nodiscard]] static PictureRequest* FlowControlled(Subscription& subscription);
  // True if the bound subject is at rest and the viewer has no refined picture of it yet.
  [[nodiscard]] static bool NeedsStill(Subscription& subscription, Time now);

  // Adds a picture of the subject's pose to `jobs`, which belong to one subject. With flow control,
  // does so only if the viewer may receive one now; otherwise Subscription::owed stays true.
  void AddJob(Subscription& subscription, PictureRequest& request, std::int64_t age_us, Time now,
              std::vector<RenderJob>* jobs);
  // The subscription ends: nothing is drawn for it any more.
  void OnEnd(const Subscription& subscription);
  // Hands the jobs to the renderer and empties the list.
  void Submit(std::vector<RenderJob>* jobs);
  // Sends a finished picture to those of its viewers that are still subscribed. A picture without
  // bytes reports a failure.
  void OnPicture(const FinishedPicture& picture, Time now);
  // Starts the video of a viewer that wants one and acknowledges. Call it for new requests.
  static void BeginVideo(PictureRequest& request);

 private:
  void MarkChanged(const Subscription& subscription, PictureRequest& request, Time now);
  void AddFlowControlledJob(Subscription& subscription, PictureRequest& request,
                            std::int64_t age_us, Time now, std::vector<RenderJob>* jobs);
  void FillImage(const FinishedPicture& picture);
  static void OweNext(Subscription& subscription, const FinishedPicture& picture);
  void SendPicture(Subscription& subscription, const FinishedPicture& picture,
                   const PictureTicket& ticket, Time now);

  const SubscriptionTable* const table_;
  PictureSource* const pictures_;
  ViewSettings settings_;
  MessageSender* const messages_;
  Metrics* const metrics_;
  protocol::ImageFrame image_;  // reused
  bool has_logged_large_picture_ = false;
};

}  // namespace furrow::server
