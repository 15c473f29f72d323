// SPDX-License-Identifier: Apache-2.0
// mcap-dump FILE: prints the messages that our reader finds, in the format of read.mjs. Prints the
// complete part of a file whose writer died.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "motion/mcap/compression.h"
#include "motion/mcap/reader.h"

int main(int argc, char** argv) {
  using furrow::motion::mcap::Crc32;
  using furrow::motion::mcap::Message;
  using furrow::motion::mcap::Reader;
  if (argc != 2) return 2;
  const auto reader = Reader::Open(argv[1]);
  if (!reader.ok()) {
    std::fprintf(stderr, "%s\n", reader.status().ToString().c_str());
    return 3;
  }
  std::vector<std::pair<std::uint64_t, std::string>> lines;
  const auto status = (*reader)->ForEach({}, [&](const Message& message) {
    char numbers[160];
    std::snprintf(numbers, sizeof numbers, " %" PRIu32 " %" PRIu64 " %" PRIu64 " %zu %" PRIu32,
                  message.sequence, message.log_time, message.publish_time, message.data.size(),
                  Crc32(message.data));
    lines.emplace_back(message.log_time,
                       (*reader)->channels().at(message.channel_id).topic + numbers);
    return true;
  });
  const bool is_damaged = (*reader)->complete() && !(*reader)->warnings().empty();
  if (!status.ok() || is_damaged) {
    std::fprintf(stderr, "%s; %zu warnings\n", status.ToString().c_str(),
                 (*reader)->warnings().size());
    return 3;
  }
  std::sort(lines.begin(), lines.end());
  for (const auto& [time, line] : lines) std::puts(line.c_str());
  for (const auto& info : (*reader)->attachments()) {
    const auto bytes = (*reader)->ReadAttachment(info);
    if (!bytes.ok()) return 3;
    std::printf("attachment %s %zu %" PRIu32 "\n", info.name.c_str(), bytes->size(), Crc32(*bytes));
  }
  return 0;
}
