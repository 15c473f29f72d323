// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "server/http/request/url.h"

namespace furrow::server {

// Parses the query of /mjpeg and /snapshot.png into a request for pictures. Names: subject, width,
// height, view, camera, rate, quality; every other name is a setting of the renderer. Errors:
// kInvalidArgument, with the name as `where`. Does not check whether the subject exists.
[[nodiscard]] Result<protocol::SubscribePictures> PicturesOf(const Url& url);

}  // namespace furrow::server
