// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/status.h"
#include "motion/mcap/index.h"
#include "motion/mcap/record_file.h"

namespace furrow::motion::mcap {

// The decompressed records of a chunk, or of a run of loose messages. Adds the chunk's schemas and
// channels to `index`. Errors: kIo, kParse, kLimit, kUnsupported (its compression).
[[nodiscard]] Result<std::vector<std::uint8_t>> LoadChunk(const RecordFile& file,
                                                          const ChunkInfo& info, Index* index);

}  // namespace furrow::motion::mcap
