// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motion/mcap/records.h"

namespace furrow::motion::mcap {

// Appends MCAP's little-endian values to a record.
class ByteWriter {
 public:
  template <std::unsigned_integral T>
  ByteWriter& Put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return *this;
  }
  ByteWriter& PutBytes(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  // Appends the length as 32 bits and then the bytes.
  ByteWriter& PutText(std::string_view text) {
    Put(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  ByteWriter& PutMap(const std::map<std::string, std::string>& map) {
    ByteWriter entries;
    for (const auto& [key, value] : map) entries.PutText(key).PutText(value);
    Put(static_cast<std::uint32_t>(entries.bytes_.size()));
    return PutBytes(entries.bytes_);
  }
  // Appends a whole record: opcode, length, content.
  ByteWriter& PutRecord(Opcode opcode, const ByteWriter& content) {
    Put(static_cast<std::uint8_t>(opcode)).Put(static_cast<std::uint64_t>(content.size()));
    return PutBytes(content.bytes_);
  }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  // Removes all bytes but the first `size`.
  void Truncate(std::size_t size) { bytes_.resize(std::min(size, bytes_.size())); }
  void Clear() { bytes_.clear(); }
  // Returns memory that is not in use, for records that are kept.
  void ShrinkToFit() { bytes_.shrink_to_fit(); }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Reads the values that ByteWriter writes from bytes that may be hostile and must outlive the
// reader. Past the end, every value is zero or empty and ok() stays false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  [[nodiscard]] T Get() {
    const auto taken = GetBytes(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < taken.size(); ++i)
      value = static_cast<T>(value | static_cast<T>(T{taken[i]} << (8 * i)));
    return value;
  }
  [[nodiscard]] std::span<const std::uint8_t> GetBytes(std::uint64_t size) {
    if (size > bytes_.size() - at_) {
      ok_ = false;
      at_ = bytes_.size();
      return {};
    }
    const auto taken = bytes_.subspan(at_, static_cast<std::size_t>(size));
    at_ += static_cast<std::size_t>(size);
    return taken;
  }
  [[nodiscard]] std::string GetText() {
    const auto taken = GetBytes(Get<std::uint32_t>());
    return {taken.begin(), taken.end()};
  }
  [[nodiscard]] std::map<std::string, std::string> GetMap() {
    ByteReader entries(GetBytes(Get<std::uint32_t>()));
    std::map<std::string, std::string> map;
    while (entries.ok() && !entries.at_end()) {
      std::string key = entries.GetText();
      map[std::move(key)] = entries.GetText();
    }
    ok_ = ok_ && entries.ok();
    return map;
  }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  // The number of unread bytes.
  [[nodiscard]] std::uint64_t left() const { return bytes_.size() - at_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace furrow::motion::mcap
