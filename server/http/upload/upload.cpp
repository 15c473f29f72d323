// SPDX-License-Identifier: Apache-2.0
#include "server/http/upload/upload.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include "server/http/api/playback_api.h"
#include "server/net/clock.h"

namespace furrow::server {
namespace {

constexpr std::size_t kMostNameBytes = 255;  // as of a file name
// How often a request looks whether its file is still being read.
constexpr auto kLookTime = std::chrono::seconds(1);
// At a time, so that other clients are served in between.
constexpr std::size_t kReadBytes = std::size_t{256} << 10;

std::string Megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + 999'999) / 1'000'000) + " MB";
}

}  // namespace

bool IsUpload(const WebRequest& request, const Url& url) {
  return url.path == "/api/playback" && request.method() == http::verb::post;
}

Result<std::string> UploadName(const Url& url) {
  std::string_view name = url.Value("name");
  name.remove_prefix(name.find_last_of("/\\") + 1);  // npos + 1 is 0
  const bool has_control =
      std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < ' '; });
  if (name.empty() || name.size() > kMostNameBytes || has_control) {
    return Status(StatusCode::kInvalidArgument,
                  "must be a file name of 1 to 255 bytes without control characters", "name",
                  "use /api/playback?name=FILE");
  }
  return std::string(name);
}

std::optional<ApiReply> RefuseUpload(const Url& url, const Access& access,
                                     std::optional<std::uint64_t> size, std::uint64_t most_bytes,
                                     Metrics* metrics) {
  if (!access.Has(Role::kDirect)) {
    metrics->Add(Counter::kRefusedDirect);
    return NeedsRole("direct", url.path, access);
  }
  if (most_bytes == 0) {
    return ErrorReply(403, "forbidden", "",
                      "this daemon takes no recordings: http.max_upload_megabytes is 0",
                      "start furrowd with --play FILE");
  }
  if (!size) {
    return ErrorReply(411, "length", "", "the request does not state the size of its body",
                      "send Content-Length");
  }
  if (*size > most_bytes) {
    metrics->Add(Counter::kHttpRefused);
    return ErrorReply(413, "limit", "",
                      "the file has " + Megabytes(*size) + ", the limit is " +
                          Megabytes(most_bytes) + " (http.max_upload_megabytes)",
                      "shorten the recording, or start furrowd with --play FILE");
  }
  const auto name = UploadName(url);
  if (!name.ok()) return ErrorReply(name.status());
  return RefuseSubject(std::filesystem::path(*name).stem().string(), access);
}

Time UploadDeadline(Time begun, std::uint64_t received) {
  return begun + kWebDeadline + FromSeconds(static_cast<double>(received) / kLeastUploadRate);
}

net::awaitable<bool> ReceiveUpload(WebStream& stream, beast::flat_buffer& buffer, bool expects,
                                   UploadedFile* file) {
  const Time begun = ReadClock();
  beast::error_code error;
  std::size_t done = std::min(file->size, buffer.size());
  net::buffer_copy(net::buffer(file->buffer.get(), done), buffer.data());
  buffer.consume(done);
  if (expects && done < file->size) {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    stream.expires_after(kWebDeadline);
    co_await net::async_write(stream, net::buffer(kContinue.data(), kContinue.size()),
                              Redirect(error));
  }
  while (!error && done < file->size) {
    const Time left = UploadDeadline(begun, done) - ReadClock();
    // A client that goes on sends something sooner than this, even if it was fast before.
    stream.expires_after(std::clamp<Time>(left, Time{0}, kWebDeadline));
    const std::size_t most = std::min(file->size - done, kReadBytes);
    const auto part = net::buffer(file->buffer.get() + done, most);
    const std::size_t size = co_await stream.async_read_some(part, Redirect(error));
    done += size;
  }
  stream.expires_never();
  co_return done == file->size;
}

net::awaitable<Result<std::shared_ptr<RecordingLoader::Loaded>>> LoadUpload(WebContext* context,
                                                                            UploadedFile file) {
  using Shared = Result<std::shared_ptr<RecordingLoader::Loaded>>;
  // The timer wakes this coroutine: reading takes as long as it takes, and has limits itself.
  struct Pending {
    net::steady_timer timer;
    std::optional<Shared> loaded;
  };
  const auto executor = co_await net::this_coro::executor;
  const auto pending = std::make_shared<Pending>(
      Pending{net::steady_timer(executor, net::steady_timer::time_point::max()), std::nullopt});
  // Weak, because the loader may outlive the event loop of the timer.
  auto done = [weak = std::weak_ptr(pending),
               post_to_web = context->post_to_web](Result<RecordingLoader::Loaded> loaded) {
    Shared shared = loaded.status();
    if (loaded.ok()) shared = std::make_shared<RecordingLoader::Loaded>(*std::move(loaded));
    post_to_web([weak, shared = std::move(shared)] {
      if (const auto waiting = weak.lock()) {
        waiting->loaded = shared;
        waiting->timer.cancel();
      }
    });
  };
  const Status begins = context->loader->Load(std::move(file), std::move(done));
  if (!begins.ok()) co_return begins;
  beast::error_code ignored;
  // Lack of memory may cost the message. The last one may be on its way when reading has ended.
  for (bool reads = true; !pending->loaded && reads;) {
    reads = context->loader->is_reading();
    pending->timer.expires_after(kLookTime);
    co_await pending->timer.async_wait(Redirect(ignored));
  }
  if (!pending->loaded) co_return Status(StatusCode::kUnavailable, "the recording was not read");
  co_return *std::move(pending->loaded);
}

ApiReply UnreadableReply(const Status& status) {
  // 404 would mean that the route does not exist.
  if (status.code() == StatusCode::kNotFound) {
    return ErrorReply(400, "parse", status.where(), status.what(), status.todo());
  }
  return ErrorReply(status);
}

}  // namespace furrow::server
