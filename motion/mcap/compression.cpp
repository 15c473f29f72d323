// SPDX-License-Identifier: Apache-2.0
#include "motion/mcap/compression.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace furrow::motion::mcap {
namespace {

Status Damaged(std::string_view method) {
  return {StatusCode::kParse, "a chunk's " + std::string(method) + " data is damaged"};
}

// The decompressed bytes. The buffer grows with the data instead of the stated size, so that a
// small file with a large number in it costs little.
class Output {
 public:
  explicit Output(std::uint64_t size) : size_(size) {}

  // The space for the next bytes; empty once `size` bytes are there.
  [[nodiscard]] std::span<std::uint8_t> Room() {
    if (written_ == bytes_.size()) {
      const std::uint64_t size = std::min(size_, std::max(kFirst, 2 * bytes_.size()));
      bytes_.reserve(size);  // the exact size: no doubling at the end
      bytes_.resize(size);
    }
    return std::span(bytes_).subspan(written_);
  }
  void Wrote(std::size_t count) { written_ += count; }
  [[nodiscard]] bool full() const { return written_ == size_; }
  [[nodiscard]] std::vector<std::uint8_t> Release() { return std::move(bytes_); }

 private:
  static constexpr std::uint64_t kFirst = 64u << 10;
  std::vector<std::uint8_t> bytes_;
  std::size_t written_ = 0;
  std::uint64_t size_;
};

Result<std::vector<std::uint8_t>> DecompressZstd(std::span<const std::uint8_t> bytes,
                                                 std::uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  if (context == nullptr) return Status(StatusCode::kInternal, "out of memory for zstd");
  Output out(size);
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t hint = 0;  // 0: a frame has ended
  while (in.pos < in.size || hint != 0) {
    const std::span<std::uint8_t> room = out.Room();
    ZSTD_outBuffer to{room.data(), room.size(), 0};
    const std::size_t before = in.pos;
    hint = ZSTD_decompressStream(context.get(), &to, &in);
    // A step that neither reads nor writes would loop forever: the data is cut off, or larger than
    // stated.
    const bool moves = in.pos > before || to.pos > 0;
    if (ZSTD_isError(hint) != 0 || (!moves && hint != 0)) return Damaged("zstd");
    out.Wrote(to.pos);
  }
  if (!out.full()) return Damaged("zstd");
  return out.Release();
}

Result<std::vector<std::uint8_t>> DecompressLz4(std::span<const std::uint8_t> bytes,
                                                std::uint64_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0)
    return Status(StatusCode::kInternal, "out of memory for lz4");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  Output out(size);
  std::size_t hint = 1;
  while (hint != 0) {
    const std::span<std::uint8_t> room = out.Room();
    std::size_t written = room.size();
    std::size_t taken = bytes.size();
    hint = LZ4F_decompress(context.get(), room.data(), &written, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0 || (written == 0 && taken == 0 && hint != 0)) return Damaged("lz4");
    out.Wrote(written);
    bytes = bytes.subspan(taken);
  }
  if (!out.full()) return Damaged("lz4");
  return out.Release();
}

}  // namespace

std::optional<std::vector<std::uint8_t>> CompressZstd(std::span<const std::uint8_t> bytes,
                                                      int level) {
  std::vector<std::uint8_t> out(ZSTD_compressBound(bytes.size()));
  const std::size_t written =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(written) != 0) return std::nullopt;
  out.resize(written);
  return out;
}

Result<std::vector<std::uint8_t>> Decompress(std::string_view method,
                                             std::span<const std::uint8_t> bytes,
                                             std::uint64_t size) {
  if (method == "zstd") return DecompressZstd(bytes, size);
  if (method == "lz4") return DecompressLz4(bytes, size);
  if (!method.empty()) {
    return Status(StatusCode::kUnsupported, "a chunk has the unknown compression '" +
                                                std::string(method) +
                                                "', supported are zstd and lz4");
  }
  if (bytes.size() != size) return Damaged("uncompressed");
  return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
}

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  constexpr std::size_t kMost = 1u << 30;  // zlib takes 32-bit lengths
  while (!bytes.empty()) {
    const std::size_t size = std::min(bytes.size(), kMost);
    crc = static_cast<std::uint32_t>(::crc32(crc, bytes.data(), static_cast<uInt>(size)));
    bytes = bytes.subspan(size);
  }
  return crc;
}

}  // namespace furrow::motion::mcap
