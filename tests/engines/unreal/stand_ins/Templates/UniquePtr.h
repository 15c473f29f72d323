// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

template <class T>
class TUniquePtr : public std::unique_ptr<T> {
 public:
  using std::unique_ptr<T>::unique_ptr;
  using std::unique_ptr<T>::operator=;
  TUniquePtr(std::unique_ptr<T> other) : std::unique_ptr<T>(std::move(other)) {}
  bool IsValid() const { return this->get() != nullptr; }
  void Reset() { this->reset(); }
};
template <class T, class... Values>
TUniquePtr<T> MakeUnique(Values&&... values) {
  return TUniquePtr<T>(std::make_unique<T>(std::forward<Values>(values)...));
}
