// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace furrow::motion::mcap {

// Collects the faults of a file that is being read: the first 32 different ones.
class Warnings {
 public:
  // `file`: its name, for the texts.
  explicit Warnings(std::string file) : file_(std::move(file)) {}

  // A second pass over a damaged file repeats its warnings, which are kept once.
  void Add(std::uint64_t offset, std::string_view what) {
    constexpr std::size_t kMost = 32;
    std::string text = file_ + ": byte " + std::to_string(offset) + ": " + std::string(what);
    if (texts_.size() < kMost && std::ranges::find(texts_, text) == texts_.end())
      texts_.push_back(std::move(text));
  }
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::string file_;
  std::vector<std::string> texts_;
};

}  // namespace furrow::motion::mcap
