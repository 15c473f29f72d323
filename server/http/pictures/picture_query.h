// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "server/http/request/url.h"

namespace furrow::server {

// The pictures that the query of /mjpeg or /snapshot.png asks for: subject, width, height, view,
// camera, rate, quality; every other name is a setting's. Errors: kInvalidArgument, `where` is the
// name. Whom it names is for the hub to find.
[[nodiscard]] Result<protocol::SubscribePictures> PicturesOf(const Url& url);

}  // namespace furrow::server
