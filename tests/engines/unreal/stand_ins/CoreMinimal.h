// SPDX-License-Identifier: Apache-2.0
// Stand-ins for the types of Unreal that the plug-in uses, with the same names and the same meaning as far as it matters.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#define FURROWLIVELINK_API
#define UCLASS(...)
#define GENERATED_BODY()
#define TEXT(text) text
#define UTF8_TO_TCHAR(text) (text)
#define TCHAR_TO_UTF8(text) (text)

using TCHAR = char;
using int32 = std::int32_t;

template <class T>
std::remove_reference_t<T>&& MoveTemp(T&& value) {
  return static_cast<std::remove_reference_t<T>&&>(value);
}

class FString {
 public:
  FString() = default;
  FString(const TCHAR* text) : text_(text) {}
  const TCHAR* operator*() const { return text_.c_str(); }
  bool IsEmpty() const { return text_.empty(); }
  template <class... Values>
  static FString Printf(const TCHAR* format, Values... values) {
    char text[512];
    std::snprintf(text, sizeof text, format, values...);
    return FString(text);
  }

 private:
  std::string text_;
};

class FName {
 public:
  FName() = default;
  explicit FName(const TCHAR* text) : text_(text) {}
  std::string ToString() const { return text_; }

 private:
  std::string text_;
};

class FText {
 public:
  static FText FromString(const FString& text) { return FText(*text); }
  std::string ToString() const { return text_; }

 private:
  explicit FText(const TCHAR* text) : text_(text) {}
  std::string text_;
};

struct FGuid {
  int value = 0;
};

template <class T>
class TArray : public std::vector<T> {
 public:
  void Add(T value) { this->push_back(std::move(value)); }
  void Append(const T* values, int32 count) { this->insert(this->end(), values, values + count); }
  int32 Num() const { return static_cast<int32>(this->size()); }
};

template <class T>
using TSharedPtr = std::shared_ptr<T>;
template <class T, class... Values>
TSharedPtr<T> MakeShared(Values&&... values) {
  return std::make_shared<T>(std::forward<Values>(values)...);
}
