// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/status.h"
#include "server/http/request/url.h"
#include "server/playback/recording_loader.h"
#include "server/session/access/access.h"

namespace furrow::server {

// A request to the API, independent of HTTP syntax.
struct ApiRequest {
  std::string method;  // "GET", "PATCH"
  Url url;
  std::string body;
  Access access = Access::Everything();
  bool shielded = true;  // nobody on the network can read the request and its reply
  // POST /api/playback: what was read of the body. The reply takes the recording.
  std::shared_ptr<RecordingLoader::Loaded> recording = nullptr;
};

// True for the probes of supervisors, which everybody may ask. They read only what the hub's thread
// writes.
[[nodiscard]] inline bool IsProbe(std::string_view path) {
  return path == "/healthz" || path == "/readyz";
}

// The reply to a request.
struct ApiReply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string file_name;   // suggested name for saving; empty: none
  std::string allow;       // status 405: the allowed methods, "GET, PATCH"
  std::string location;    // status 307: the URL to ask instead
  int retry_after = 1;     // status 429 and 503: seconds; 0: asking again does not help
  bool bad_token = false;  // status 401: the request has shown a token, which is refused
  bool closes = false;     // the connection ends after the reply
};

// Quotes a text for JSON. Invalid UTF-8 in it becomes replacement characters.
[[nodiscard]] std::string JsonText(std::string_view text);

// Returns a reply with an error object: {"error": {"code", "field", "message", "hint"}}. `status`:
// the HTTP status. `field`: the invalid field of the request; may be empty. `hint`: what to do. The
// overload derives the HTTP status from the status code, and the field from `where`.
[[nodiscard]] ApiReply ErrorReply(int status, std::string_view code, std::string_view field,
                                  std::string_view message, std::string_view hint = {});
[[nodiscard]] ApiReply ErrorReply(const Status& status);
// 503 for what this daemon does not do the way it was started, without Retry-After.
[[nodiscard]] ApiReply NotOfferedReply(std::string_view message);
// 403 for a request without the role, "direct" or the like.
[[nodiscard]] ApiReply NeedsRole(std::string_view role, std::string_view path,
                                 const Access& access);
// Returns 405 Method Not Allowed. `allow`: the methods of the path, "GET, HEAD".
[[nodiscard]] ApiReply MethodReply(std::string_view method, std::string_view path,
                                   std::string allow);

// 401 for a request that shows no token, and for one that shows a token that is refused.
[[nodiscard]] ApiReply NeedsToken(std::string_view why);
[[nodiscard]] ApiReply RefusesToken(std::string_view why);

}  // namespace furrow::server
