// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/chunk.h"

#include <string>

#include "motion/mcap/compression.h"

namespace furrow::motion::mcap {

Result<std::vector<std::uint8_t>> LoadChunk(const RecordFile& file, const ChunkInfo& info,
                                            Index* index) {
  const auto record = file.ReadAt(info.offset, info.length);
  if (!record.ok() || info.compression == kLooseMessages) return record;
  ByteReader content(*record);
  if (content.Get<std::uint8_t>() != static_cast<std::uint8_t>(Opcode::kChunk))
    return Status(StatusCode::kParse, "the index does not refer to a chunk");
  (void)content.Get<std::uint64_t>();  // length
  (void)content.Get<std::uint64_t>();  // start and
  (void)content.Get<std::uint64_t>();  // end time
  const auto size = content.Get<std::uint64_t>();
  if (size != info.uncompressed_bytes)
    return Status(StatusCode::kParse, "the index states a different size");
  const auto crc = content.Get<std::uint32_t>();
  const std::string compression = content.GetText();
  const auto packed = content.GetBytes(content.Get<std::uint64_t>());
  if (!content.ok()) return Status(StatusCode::kParse, "its length fields are wrong");
  const std::uint64_t most = index->limits().record_bytes;
  if (size > most)
    return Status(StatusCode::kLimit, "its decompressed size of " + std::to_string(size) +
                                          " bytes exceeds the limit of " + std::to_string(most));
  // `size` agrees with the index and is within the limit, so the output is bounded.
  auto records = Decompress(compression, packed, size);
  if (!records.ok()) return records;
  if (crc != 0 && Crc32(*records) != crc)
    return Status(StatusCode::kParse, "its checksum is wrong");
  FURROW_RETURN_IF_ERROR(index->AddDeclarations(*records));
  return records;
}

}  // namespace furrow::motion::mcap
