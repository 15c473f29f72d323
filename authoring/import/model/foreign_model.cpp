// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/foreign_model.h"

#include <utility>

#include "base/process/helper_call.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

constexpr std::size_t kMaxForeignBytes = 512u << 20;
constexpr ProcessLimits kModelLimits = {.max_memory_bytes = std::size_t{4} << 30,
                                        .max_cpu_seconds = 120,
                                        .max_seconds = 360,
                                        .max_output_bytes = std::size_t{1} << 30};

}  // namespace

Result<ForeignModel> ReadWithAssimp(std::string_view bytes, const std::string& extension) {
  if (bytes.size() > kMaxForeignBytes) {
    return Status(StatusCode::kLimit, "the file has " + std::to_string(bytes.size()) +
                                          " bytes; the limit is " +
                                          std::to_string(kMaxForeignBytes));
  }
  Result<HelperReply> reply = CallHelper(
      "furrow-assimp", std::vector<std::string>{"model", extension}, bytes, kModelLimits);
  FURROW_RETURN_IF_ERROR(reply);
  return ForeignModel{std::move(reply->payload), std::move(reply->notes)};
}

}  // namespace furrow::authoring
