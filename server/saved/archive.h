// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/messages/bytes.h"
#include "protocol/secure/crypto/secret.h"
#include "server/core/time.h"

namespace furrow::server {

// Two archives with one interface, so that one description of a struct writes it and reads it:
//
//   template <class Archive> void Exchange(Archive& archive, Point& point) {
//     archive(point.x);
//     archive(point.y);
//   }
//
// Integers are little-endian, lists follow their length (u32), an optional value follows a byte.

class ArchiveWriter {
 public:
  explicit ArchiveWriter(std::vector<std::uint8_t>* out) : out_(*out) {}

  template <std::integral T>
  void operator()(const T& value) {
    std::array<std::uint8_t, sizeof(T)> bytes;
    if constexpr (std::same_as<T, bool>) {
      bytes[0] = value ? 1 : 0;
    } else {
      protocol::StoreLittle(value, bytes.data());
    }
    Append(bytes);
  }
  void operator()(const Time& time) { (*this)(std::int64_t{time.count()}); }
  template <std::integral T, std::size_t N>
  void operator()(const std::array<T, N>& values) {
    for (const T& value : values) (*this)(value);
  }
  template <std::size_t N>
  void operator()(const protocol::secure::Secret<N>& secret) {
    Append(secret.bytes());
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint32_t>(text.size()));
    Append({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    (*this)(static_cast<std::uint32_t>(values.size()));
    for (T& value : values) Each(value);
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    (*this)(value.has_value());
    if (value) Exchange(*this, *value);
  }

 private:
  template <class T>
  void Each(T& value) {
    if constexpr (std::integral<T>) {
      (*this)(value);
    } else {
      Exchange(*this, value);
    }
  }

  void Append(std::span<const std::uint8_t> bytes) {
    if (out_.capacity() - out_.size() < bytes.size()) Grow(bytes.size());
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  // A vector that grows by itself leaves a copy of keys in the memory that it frees.
  void Grow(std::size_t by) {
    std::vector<std::uint8_t> larger;
    larger.reserve(2 * out_.size() + by);
    larger.assign(out_.begin(), out_.end());
    protocol::secure::Wipe(out_);
    out_.swap(larger);
  }

  std::vector<std::uint8_t>& out_;
};

// Reads what anybody may have written. After the first fault all values are zero and lists empty.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // True if everything was there, and nothing is left.
  [[nodiscard]] bool complete() const { return ok_ && bytes_.empty(); }
  void Fail() { ok_ = false; }

  template <std::integral T>
  void operator()(T& value) {
    const auto bytes = Take(sizeof(T));
    value = {};
    if (bytes.empty()) return;
    if constexpr (std::same_as<T, bool>) {
      if (bytes[0] > 1) Fail();
      value = bytes[0] == 1;
    } else {
      value = protocol::LoadLittle<T>(bytes.data());
    }
  }
  // Sums and differences of two of them must not overflow.
  void operator()(Time& time) {
    std::int64_t count = 0;
    (*this)(count);
    constexpr std::int64_t kMost = (std::int64_t{1} << 62) - 1;
    if (count < 0 || count > kMost) Fail();
    time = Time(std::clamp<std::int64_t>(count, 0, kMost));
  }
  template <std::integral T, std::size_t N>
  void operator()(std::array<T, N>& values) {
    for (T& value : values) (*this)(value);
  }
  template <std::size_t N>
  void operator()(protocol::secure::Secret<N>& secret) {
    const auto bytes = Take(N);
    if (!bytes.empty()) std::copy(bytes.begin(), bytes.end(), secret.bytes().begin());
  }
  void operator()(std::string& text) {
    const auto bytes = TakeList();
    text.assign(bytes.begin(), bytes.end());
  }
  void operator()(std::vector<std::uint8_t>& values) {
    const auto bytes = TakeList();
    values.assign(bytes.begin(), bytes.end());
  }
  // Grows with what is there, whatever length is stated.
  template <class T>
  void operator()(std::vector<T>& values) {
    values.clear();
    std::uint32_t count = 0;
    (*this)(count);
    for (std::uint32_t i = 0; i < count && ok_; ++i) {
      if constexpr (std::integral<T>) {
        (*this)(values.emplace_back());
      } else {
        Exchange(*this, values.emplace_back());
      }
    }
    if (!ok_) values.clear();
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    bool has_value = false;
    (*this)(has_value);
    value.reset();
    if (has_value) Exchange(*this, value.emplace());
  }

 private:
  // Empty if there are fewer.
  std::span<const std::uint8_t> Take(std::size_t size) {
    if (!ok_ || size > bytes_.size()) {
      Fail();
      return {};
    }
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  std::span<const std::uint8_t> TakeList() {
    std::uint32_t size = 0;
    (*this)(size);
    return Take(size);
  }

  std::span<const std::uint8_t> bytes_;
  bool ok_ = true;
};

}  // namespace furrow::server
