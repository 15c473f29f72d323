// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "protocol/messages/messages.h"
#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/session/hub.h"

namespace furrow::server {

inline constexpr char kMjpegType[] = "multipart/x-mixed-replace; boundary=furrow-picture";
inline constexpr char kSnapshotType[] = "image/png";

// The HTTP error for an error of the hub.
[[nodiscard]] ApiReply PictureRefusal(const protocol::ErrorMessage& error);

// Answers HEAD of /mjpeg and /snapshot.png: what GET would reply, as far as that is known without
// drawing, but without a picture. Requires the hub's exclusive lock.
[[nodiscard]] ApiReply HeadOfPictures(const ApiRequest& request, Hub& hub, Time now);

}  // namespace furrow::server
