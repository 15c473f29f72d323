// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <boost/beast/core/flat_buffer.hpp>

#include "base/status.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/http/request/api_types.h"
#include "server/http/request/url.h"
#include "server/http/request/web_context.h"
#include "server/http/stream/beast.h"
#include "server/http/stream/web_stream.h"
#include "server/playback/recording_loader.h"
#include "server/playback/uploaded_file.h"

// The upload of a recording: POST /api/playback?name=FILE. Its body is large, so it is read only
// after the header has been checked.
namespace furrow::server {

// True if a request of this method and path uploads a file.
[[nodiscard]] bool IsUpload(const WebRequest& request, const Url& url);

// The name of the file without folders. Error: kInvalidArgument, with `where` "name", if it is
// empty, too long, or has control characters.
[[nodiscard]] Result<std::string> UploadName(const Url& url);

// The reply that refuses the upload; nothing: its body may be read. `size`: of the body in bytes,
// as the header states it.
[[nodiscard]] std::optional<ApiReply> RefuseUpload(const Url& url, const Access& access,
                                                   std::optional<std::uint64_t> size,
                                                   std::uint64_t most_bytes, Metrics* metrics);

// An upload that is slower on average, after the first kWebDeadline, is ended. In bytes per second.
inline constexpr double kLeastUploadRate = 100'000.0;
// When the next bytes of an upload must have come, of which `received` bytes came since `begun`.
[[nodiscard]] Time UploadDeadline(Time begun, std::uint64_t received);

// Reads a body of `file->size` bytes into the buffer of that size: first the bytes that `buffer`
// has already, then from the stream. `expects`: the client waits for "100 Continue". False: the
// client has gone or was too slow.
[[nodiscard]] net::awaitable<bool> ReceiveUpload(WebStream& stream, beast::flat_buffer& buffer,
                                                 bool expects, UploadedFile* file);

// Waits until the loader has read the file. Errors: those of RecordingLoader.
[[nodiscard]] net::awaitable<Result<std::shared_ptr<RecordingLoader::Loaded>>> LoadUpload(
    WebContext* context, UploadedFile file);

// The reply for a file that cannot be read. `field` says where in the file.
[[nodiscard]] ApiReply UnreadableReply(const Status& status);

}  // namespace furrow::server
