// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <unistd.h>

namespace furrow {

// Owns a file descriptor and closes it at the end. Negative: there is none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { Close(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.Release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    // The destructor of `other` closes the former descriptor.
    std::swap(number_, other.number_);
    return *this;
  }

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool ok() const { return number_ >= 0; }
  // The descriptor belongs to the caller then.
  [[nodiscard]] int Release() noexcept { return std::exchange(number_, -1); }
  void Close() {
    if (ok()) ::close(Release());
  }

 private:
  int number_;
};

}  // namespace furrow
