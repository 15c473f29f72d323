// SPDX-License-Identifier: Apache-2.0
// The functions of furrow.h: null pointers, exceptions and callbacks end here.
#include <algorithm>
#include <cstring>
#include <new>
#include <string>

#include "base/text.h"
#include "client/c/connection.h"
#include "client/c/include/furrow/furrow.h"
#include "client/c/struct_copy.h"
#include "client/c/text_input.h"
#include "client/cpp/address.h"
#include "protocol/messages/limits.h"

using furrow::Status;
using furrow::StatusCode;
using furrow::capi::Connection;
using furrow::capi::Feed;

struct furrow_connection {
  Connection connection;
};

namespace {

// Runs `work` on a connection that may be null. No exception passes.
template <class Work>
furrow_status Guarded(furrow_connection* connection, Work&& work) noexcept {
  if (connection == nullptr) return FURROW_INVALID_ARGUMENT;
  try {
    return work(connection->connection);
  } catch (const std::bad_alloc&) {
    return FURROW_OUT_OF_MEMORY;
  } catch (...) {
    return FURROW_INTERNAL;
  }
}

// As Guarded(), for functions that must not be called inside a callback.
template <class Work>
furrow_status Outside(furrow_connection* connection, Work&& work) noexcept {
  return Guarded(connection, [&](Connection& inner) {
    if (!inner.calling_back()) return work(inner);
    return inner.Fail(FURROW_WRONG_CALL, "this function must not be called inside a callback");
  });
}

// Copies as much of a text as fits between two characters, with its zero byte.
void CopyCut(const std::string& text, char* buffer, std::uint32_t size) {
  if (buffer == nullptr || size == 0) return;
  const std::string cut = furrow::CutText(text, size - 1);
  std::memcpy(buffer, cut.c_str(), cut.size() + 1);
}

// Copies a whole name.
furrow_status CopyName(Connection& connection, const std::string& name, char* buffer,
                       std::uint32_t size) {
  if (buffer == nullptr || size == 0) {
    return connection.Fail(FURROW_INVALID_ARGUMENT, "buffer is null, or size is 0");
  }
  if (name.size() < size) {
    CopyCut(name, buffer, size);
    return FURROW_OK;
  }
  buffer[0] = '\0';
  return connection.Fail(FURROW_BUFFER_TOO_SMALL,
                         "the name needs " + std::to_string(name.size() + 1) + " bytes");
}

// The feed of a subject with its names; null with a status if there is none.
const Feed* NamedFeed(Connection& connection, const char* subject, furrow_status* status) {
  const Feed* const feed = connection.Find(subject);
  *status = FURROW_NOT_FOUND;
  if (feed == nullptr || feed->layout() != 0) return feed;
  *status = feed->status();
  return nullptr;
}

// Takes over a file of the options, which the address may state instead.
Status TakeFile(const char* value, const char* field, const char* todo, std::string* target) {
  if (value == nullptr) return {};
  if (!target->empty()) {
    return {StatusCode::kInvalidArgument, "the address states it, too", field, "use one of both"};
  }
  constexpr int kMostBytes = 4096;
  if (furrow::capi::ReadText(value, kMostBytes, target) && !target->empty()) return {};
  return {StatusCode::kInvalidArgument, todo, field};
}

// Takes over the token and TLS of the options.
Status TakeSecurity(const furrow_options& options, furrow::client::Address* address) {
  FURROW_RETURN_IF_ERROR(TakeFile(options.token, "options.token",
                                  "use the name of a file, or the text of a token",
                                  &address->token));
  FURROW_RETURN_IF_ERROR(TakeFile(options.tls_authority, "options.tls_authority",
                                  "use the name of a file in PEM form",
                                  &address->tls_files.authority));
  address->tls |= options.tls != 0;
  return address->Complete();
}

// Refuses what is reserved. A key that is silently ignored would pretend to protect.
Status CheckOptions(const furrow_options& options, std::string* program) {
  const auto reserved = [](const char* field) {
    return Status(StatusCode::kUnsupported, "it is reserved for a later version",
                  std::string("options.") + field, "leave it empty");
  };
  if (options.server_key != nullptr) return reserved("server_key");
  if (options.tls > 1) {
    return {StatusCode::kUnsupported, "use 0 or 1", "options.tls"};
  }
  if ((options.flags & ~FURROW_OPEN_WITHOUT_SUBSCRIPTION) != 0) {
    return {StatusCode::kUnsupported, "unknown flags", "options.flags"};
  }
  if (options.program == nullptr) return {};
  if (furrow::capi::ReadText(options.program, furrow::protocol::kMaxProgramBytes, program)) {
    return {};
  }
  return {StatusCode::kInvalidArgument, "use at most 64 bytes of UTF-8", "options.program"};
}

furrow_status Open(const char* address, const furrow_options& options,
                   furrow_connection** connection, std::string* error) {
  std::string program = "libfurrow " FURROW_VERSION;
  if (const Status status = CheckOptions(options, &program); !status.ok()) {
    *error = status.ToString();
    const bool unsupported = status.code() == StatusCode::kUnsupported;
    return unsupported ? FURROW_UNSUPPORTED : FURROW_INVALID_ARGUMENT;
  }
  auto parsed = furrow::client::ParseAddress(address);
  if (!parsed.ok()) {
    *error = parsed.status().ToString();
    const bool unsupported = parsed.status().code() == StatusCode::kUnsupported;
    return unsupported ? FURROW_UNSUPPORTED : FURROW_INVALID_ADDRESS;
  }
  Status fault = TakeSecurity(options, &*parsed);
  furrow::client::Security security;
  if (fault.ok()) {
    auto loaded = furrow::client::LoadSecurityOf(*parsed);
    if (loaded.ok()) security = *std::move(loaded);
    fault = loaded.status();
  }
  if (!fault.ok()) {
    *error = fault.ToString();
    return FURROW_INVALID_ARGUMENT;
  }
  auto opened = std::unique_ptr<furrow_connection>(
      new furrow_connection{{*std::move(parsed), std::move(program), std::move(security)}});
  if ((options.flags & FURROW_OPEN_WITHOUT_SUBSCRIPTION) == 0) {
    const furrow_status status = opened->connection.SubscribeToAddress();
    *error = opened->connection.last_error();
    if (status != FURROW_OK) return FURROW_INVALID_ADDRESS;  // a subject that is named twice
  }
  *connection = opened.release();
  return FURROW_OK;
}

}  // namespace

std::uint32_t furrow_abi_version(void) { return FURROW_ABI_VERSION; }

const char* furrow_version(void) { return FURROW_VERSION; }

furrow_status furrow_open(const char* address, const furrow_options* options,
                          furrow_connection** connection) {
  if (connection == nullptr) return FURROW_INVALID_ARGUMENT;
  *connection = nullptr;
  if (address == nullptr) return FURROW_INVALID_ARGUMENT;
  furrow_options wanted{};
  if (options != nullptr) {
    const furrow_status status = furrow::capi::CopyIn(options, &wanted);
    if (status != FURROW_OK) return status;
  }
  CopyCut("", wanted.error, wanted.error_size);
  try {
    std::string error;
    const furrow_status status = Open(address, wanted, connection, &error);
    if (status != FURROW_OK) CopyCut(error, wanted.error, wanted.error_size);
    return status;
  } catch (const std::bad_alloc&) {
    return FURROW_OUT_OF_MEMORY;
  } catch (...) {
    return FURROW_INTERNAL;
  }
}

void furrow_close(furrow_connection* connection) {
  (void)Guarded(connection, [&](Connection& inner) {
    if (inner.calling_back()) {
      inner.CloseLater();
    } else {
      delete connection;
    }
    return FURROW_OK;
  });
}

furrow_status furrow_poll(furrow_connection* connection, std::int32_t timeout_ms) {
  const furrow_status status =
      Outside(connection, [&](Connection& inner) { return inner.Poll(timeout_ms); });
  if (status == FURROW_CLOSED) furrow_close(connection);
  return status;
}

furrow_status furrow_get_info(furrow_connection* connection, furrow_connection_info* info) {
  return Guarded(connection, [&](Connection& inner) { return inner.GetInfo(info); });
}

furrow_status furrow_last_error(furrow_connection* connection, char* buffer, std::uint32_t size) {
  return Guarded(connection, [&](Connection& inner) {
    if (buffer == nullptr || size == 0) return FURROW_INVALID_ARGUMENT;
    CopyCut(inner.last_error(), buffer, size);
    return FURROW_OK;
  });
}

furrow_status furrow_subscribe(furrow_connection* connection,
                               const furrow_subscription* subscription) {
  return Outside(connection, [&](Connection& inner) { return inner.Subscribe(subscription); });
}

furrow_status furrow_unsubscribe(furrow_connection* connection, const char* subject) {
  return Outside(connection, [&](Connection& inner) { return inner.Unsubscribe(subject); });
}

furrow_status furrow_subject_name(furrow_connection* connection, std::uint32_t index, char* buffer,
                                  std::uint32_t size) {
  return Guarded(connection, [&](Connection& inner) {
    std::string name;
    const furrow_status status = inner.SubjectName(index, &name);
    return status == FURROW_OK ? CopyName(inner, name, buffer, size) : status;
  });
}

furrow_status furrow_weights(furrow_connection* connection, const char* subject, float* values,
                             std::uint32_t capacity, furrow_frame* frame) {
  return Guarded(connection, [&](Connection& inner) {
    return inner.Weights(subject, values, capacity, frame);
  });
}

furrow_status furrow_layout(furrow_connection* connection, const char* subject,
                            std::uint32_t* count, std::uint64_t* layout) {
  return Guarded(connection, [&](Connection& inner) {
    furrow_status status = FURROW_OK;
    const Feed* const feed = NamedFeed(inner, subject, &status);
    if (count != nullptr) *count = 0;
    if (layout != nullptr) *layout = 0;
    if (feed == nullptr) return status;
    if (count != nullptr) *count = static_cast<std::uint32_t>(feed->names().size());
    if (layout != nullptr) *layout = feed->layout();
    return FURROW_OK;
  });
}

furrow_status furrow_weight_name(furrow_connection* connection, const char* subject,
                                 std::uint32_t index, char* buffer, std::uint32_t size) {
  return Guarded(connection, [&](Connection& inner) {
    furrow_status status = FURROW_OK;
    const Feed* const feed = NamedFeed(inner, subject, &status);
    if (feed == nullptr) return status;
    if (index >= feed->names().size()) {
      return inner.Fail(FURROW_NOT_FOUND, "there is no weight " + std::to_string(index));
    }
    return CopyName(inner, feed->names()[index], buffer, size);
  });
}

furrow_status furrow_find_weight(furrow_connection* connection, const char* subject,
                                 const char* name, std::uint32_t* index) {
  return Guarded(connection, [&](Connection& inner) {
    if (name == nullptr || index == nullptr) {
      return inner.Fail(FURROW_INVALID_ARGUMENT, "name or index is null");
    }
    furrow_status status = FURROW_OK;
    const Feed* const feed = NamedFeed(inner, subject, &status);
    if (feed == nullptr) return status;
    const auto found = std::ranges::find(feed->names(), name);
    if (found == feed->names().end()) {
      return inner.Fail(FURROW_NOT_FOUND, "there is no weight with this name");
    }
    *index = static_cast<std::uint32_t>(found - feed->names().begin());
    return FURROW_OK;
  });
}

furrow_status furrow_latest_pose(furrow_connection* connection, const char* subject,
                                 furrow_pose_buffer* pose) {
  return Guarded(connection, [&](Connection& inner) { return inner.LatestPose(subject, pose); });
}

furrow_status furrow_get_skeleton(furrow_connection* connection, const char* subject,
                                  furrow_skeleton_info* info) {
  return Guarded(connection, [&](Connection& inner) { return inner.GetSkeleton(subject, info); });
}

furrow_status furrow_get_joint(furrow_connection* connection, const char* subject,
                               std::uint32_t index, char* name, std::uint32_t size,
                               furrow_joint* joint) {
  return Guarded(connection, [&](Connection& inner) {
    std::string text;
    furrow_joint found{};
    furrow_status status = inner.GetJoint(subject, index, &found, &text);
    if (status == FURROW_OK) status = CopyName(inner, text, name, size);
    if (status != FURROW_OK || joint == nullptr) return status;
    *joint = found;
    joint->name = name;
    return FURROW_OK;
  });
}

furrow_status furrow_blend_shape_name(furrow_connection* connection, const char* subject,
                                      std::uint32_t index, char* buffer, std::uint32_t size) {
  return Guarded(connection, [&](Connection& inner) {
    std::string name;
    const furrow_status status = inner.BlendShapeName(subject, index, &name);
    return status == FURROW_OK ? CopyName(inner, name, buffer, size) : status;
  });
}

furrow_status furrow_set_callbacks(furrow_connection* connection,
                                   const furrow_callbacks* callbacks) {
  return Guarded(connection, [&](Connection& inner) { return inner.SetCallbacks(callbacks); });
}

furrow_status furrow_offer(furrow_connection* connection, const furrow_skeleton* skeleton,
                           std::uint32_t* stream) {
  return Guarded(connection, [&](Connection& inner) {
    if (stream == nullptr) return inner.Fail(FURROW_INVALID_ARGUMENT, "stream is null");
    return inner.Offer(skeleton, stream);
  });
}

furrow_status furrow_send_pose(furrow_connection* connection, std::uint32_t stream,
                               const furrow_pose* pose) {
  return Guarded(connection, [&](Connection& inner) { return inner.SendPose(stream, pose); });
}

furrow_status furrow_stream_status(furrow_connection* connection, std::uint32_t stream) {
  return Guarded(connection, [&](Connection& inner) { return inner.StreamStatus(stream); });
}

furrow_status furrow_withdraw(furrow_connection* connection, std::uint32_t stream) {
  return Guarded(connection, [&](Connection& inner) { return inner.Withdraw(stream); });
}
