// SPDX-License-Identifier: Apache-2.0
#include "server/http/pictures/picture_replies.h"

#include "base/status.h"
#include "server/http/pictures/picture_query.h"

namespace furrow::server {

ApiReply PictureRefusal(const protocol::ErrorMessage& error) {
  using protocol::ErrorCode;
  switch (error.code) {
    case ErrorCode::kUnknownSubject: return ErrorReply(404, "not_found", "subject", error.message);
    // Strangers do not come this far: the token has expired, or its key was retired.
    case ErrorCode::kNeedsToken: return RefusesToken(error.message);
    case ErrorCode::kNotPermitted: return ErrorReply(403, "forbidden", "subject", error.message);
    case ErrorCode::kLimit: {
      ApiReply reply = ErrorReply(503, "limit", "", error.message, "try again later");
      reply.closes = true;  // the place is wanted by somebody else
      return reply;
    }
    case ErrorCode::kNotRendering: return NotOfferedReply(error.message);
    case ErrorCode::kDraining: return ErrorReply(503, "unavailable", "", error.message);
    default: return ErrorReply(400, "invalid_argument", "", error.message);
  }
}

ApiReply HeadOfPictures(const ApiRequest& request, Hub& hub, Time /*now*/) {
  Result<protocol::SubscribePictures> wanted = PicturesOf(request.url);
  if (!wanted.ok()) return ErrorReply(wanted.status());
  const bool once = request.url.path == "/snapshot.png";
  wanted->wait = !once;  // as GET
  if (const auto why = hub.WhyNoPictures(*wanted, request.access)) return PictureRefusal(*why);
  return {.type = once ? kSnapshotType : kMjpegType};
}

}  // namespace furrow::server
