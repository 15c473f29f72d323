// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace furrow::protocol::secure {

// Which of the newest 1,024 counters were received. A counter below them counts as received.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  enum class Answer : std::uint8_t { kNew, kDuplicate, kTooOld };

  // What another process needs to go on with the window.
  static constexpr std::size_t kWords = kSize / 64;
  struct State {
    std::array<std::uint64_t, kWords> words{};
    std::uint64_t newest = 0;
    bool any = false;
  };
  ReplayWindow() = default;
  explicit ReplayWindow(const State& state)
      : words_(state.words), newest_(state.newest), any_(state.any) {}
  [[nodiscard]] State state() const { return {words_, newest_, any_}; }

  // Whether `counter` was received. Changes nothing, so a forged packet cannot move the window.
  [[nodiscard]] Answer Check(std::uint64_t counter) const {
    if (!any_ || counter > newest_) return Answer::kNew;
    // By subtraction: `counter` plus the size would overflow near 2^64.
    if (newest_ - counter >= kSize) return Answer::kTooOld;
    return (word(counter) & bit(counter)) != 0 ? Answer::kDuplicate : Answer::kNew;
  }

  // Marks a counter as received. Precondition: Check() says kNew, and the packet is authentic.
  void Mark(std::uint64_t counter) {
    if (!any_ || counter > newest_) Advance(counter);
    word(counter) |= bit(counter);
  }

 private:
  [[nodiscard]] static std::uint64_t bit(std::uint64_t counter) {
    return std::uint64_t{1} << (counter % 64);
  }
  [[nodiscard]] const std::uint64_t& word(std::uint64_t counter) const {
    return words_[counter / 64 % kWords];
  }
  [[nodiscard]] std::uint64_t& word(std::uint64_t counter) { return words_[counter / 64 % kWords]; }

  // Clears the bits from the newest counter to the new one. They hold counters that are 1,024 older
  // and leave the window.
  void Advance(std::uint64_t counter) {
    if (!any_ || counter - newest_ >= kSize) {
      words_ = {};
    } else {
      for (std::uint64_t c = newest_ + 1; c != counter + 1;) {
        if (c % 64 == 0 && counter - c >= 63) {
          word(c) = 0;
          c += 64;
        } else {
          word(c) &= ~bit(c);
          ++c;
        }
      }
    }
    any_ = true;
    newest_ = counter;
  }

  std::array<std::uint64_t, kWords> words_{};
  std::uint64_t newest_ = 0;
  bool any_ = false;
};

}  // namespace furrow::protocol::secure
