// SPDX-License-Identifier: Apache-2.0
// MCAP: all returned messages are in the requested time range, and the reader keeps its limits.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "motion/mcap/reader.h"

namespace {

using furrow::motion::mcap::Message;
using furrow::motion::mcap::Reader;

// A file in memory, because readers take a path.
int Memory() {
  static const int file = ::memfd_create("fuzz", MFD_CLOEXEC);
  return file;
}

void ReadAll(Reader& reader, const Reader::Range& range) {
  std::uint64_t sum = 0;
  const furrow::Status status = reader.ForEach(range, [&](const Message& message) {
    if (message.log_time < range.from || message.log_time > range.to) std::abort();
    for (const std::uint8_t byte : message.data) sum += byte;
    return true;
  });
  // The disk is healthy, so an I/O error is a fault of the reader.
  if (!status.ok() && status.code() != furrow::StatusCode::kLimit) std::abort();
  static volatile std::uint64_t kept;
  kept = sum;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = Memory();
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  const furrow::motion::mcap::ReaderLimits limits{
      .record_bytes = 1u << 20, .loaded_bytes = 2u << 20, .kept_bytes = 64u << 10, .records = 256};
  const auto reader = Reader::Open("/proc/self/fd/" + std::to_string(file), limits);
  if (!reader.ok()) return 0;
  ReadAll(**reader, {});
  ReadAll(**reader, {.from = 1010, .to = 1030});
  std::size_t kept = 0;
  for (const auto& [id, schema] : (*reader)->schemas()) kept += schema.data.size();
  for (const auto& metadata : (*reader)->metadata()) kept += metadata.name.size();
  if (kept > limits.kept_bytes || (*reader)->chunks().size() > limits.records) std::abort();
  for (const auto& info : (*reader)->attachments()) {
    const auto attachment = (*reader)->ReadAttachment(info);
    if (attachment.ok() && attachment->size() > size) std::abort();
  }
  return 0;
}
