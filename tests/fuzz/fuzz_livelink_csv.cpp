// SPDX-License-Identifier: Apache-2.0
// Live Link Face recordings: an accepted file has increasing times and can be written and read
// again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "motion/livelink/livelink_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace furrow::motion;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  ClipReport report;
  const furrow::Result<Clip> clip = ParseLiveLinkCsv(text, "fuzz.csv", {}, &report);
  if (!clip.ok()) return 0;
  for (std::size_t f = 1; f < clip->times.size(); ++f) {
    if (clip->times[f] <= clip->times[f - 1]) std::abort();
  }
  if (clip->timecodes.size() != clip->times.size()) std::abort();
  for (const auto& timecode : clip->timecodes) {
    if (timecode && !furrow::IsValid(*timecode)) std::abort();
  }
  const furrow::Result<std::string> written = LiveLinkCsvToText(*clip, &report);
  if (written.ok() && !ParseLiveLinkCsv(*written, "written.csv").ok()) std::abort();
  return 0;
}
