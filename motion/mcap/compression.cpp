// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/compression.h"

#include <algorithm>
#include <memory>
#include <string>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace furrow::motion::mcap {
namespace {

Status Damaged(std::string_view method) {
  return {StatusCode::kParse, "a chunk's " + std::string(method) + " data is damaged"};
}

Result<std::vector<std::uint8_t>> DecompressZstd(std::span<const std::uint8_t> bytes,
                                                 std::uint64_t size) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(size));
  const std::size_t written = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(written) != 0 || written != out.size()) return Damaged("zstd");
  return out;
}

Result<std::vector<std::uint8_t>> DecompressLz4(std::span<const std::uint8_t> bytes,
                                                std::uint64_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0)
    return Status(StatusCode::kInternal, "no memory for lz4");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(size));
  std::size_t written = 0;
  std::size_t hint = 1;
  while (hint != 0) {
    std::size_t room = out.size() - written;
    std::size_t taken = bytes.size();
    hint =
        LZ4F_decompress(context.get(), out.data() + written, &room, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0 || (room == 0 && taken == 0 && hint != 0)) return Damaged("lz4");
    written += room;
    bytes = bytes.subspan(taken);
  }
  if (written != out.size()) return Damaged("lz4");
  return out;
}

}  // namespace

std::vector<std::uint8_t> CompressZstd(std::span<const std::uint8_t> bytes, int level) {
  std::vector<std::uint8_t> out(ZSTD_compressBound(bytes.size()));
  const std::size_t written =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  out.resize(ZSTD_isError(written) != 0 ? 0 : written);
  return out;
}

Result<std::vector<std::uint8_t>> Decompress(std::string_view method,
                                             std::span<const std::uint8_t> bytes,
                                             std::uint64_t size) {
  if (method == "zstd") return DecompressZstd(bytes, size);
  if (method == "lz4") return DecompressLz4(bytes, size);
  if (!method.empty()) {
    return Status(StatusCode::kUnsupported,
                  "a chunk is compressed by '" + std::string(method) + "'; known are zstd and lz4");
  }
  if (bytes.size() != size) return Damaged("uncompressed");
  return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  constexpr std::size_t kMost = 1u << 30;  // zlib counts in 32 bits
  while (!bytes.empty()) {
    const std::size_t size = std::min(bytes.size(), kMost);
    crc = static_cast<std::uint32_t>(::crc32(crc, bytes.data(), static_cast<uInt>(size)));
    bytes = bytes.subspan(size);
  }
  return crc;
}

}  // namespace furrow::motion::mcap
