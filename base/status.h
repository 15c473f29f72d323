// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace furrow {

// The kind of a failure. Exit codes, replies to peers and tests depend on it.
enum class StatusCode {
  kOk = 0,
  kInvalidArgument,  // wrong size, unknown name, or out of range
  kNotFound,         // a file, joint, region or subject that does not exist
  kParse,            // malformed text or bytes
  kSchema,           // well-formed, but a field is missing, unknown or of the wrong type
  kLimit,            // larger or deeper than the limit for untrusted input
  kNonFinite,        // NaN or infinity
  kCyclic,           // a hierarchy with a cycle
  kUnsupported,      // valid, but not implemented
  kIo,               // the operating system reported an error
  kUnavailable,      // GL, a socket or a peer is unavailable at the moment
  kInternal,         // a bug in Furrow
};

// Success, or one clear message: what went wrong, where, and what to do.
//
// `where` is "file:line" for text, "file" or "file: field" for other input, and empty if there is
// no place. The packet path does not use Status: jobs and decoders return enums (JobStatus in
// wrinkle/, DecodeStatus in protocol/).
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string what, std::string where = {}, std::string todo = {});

  [[nodiscard]] bool ok() const { return code_ == StatusCode::kOk; }
  [[nodiscard]] StatusCode code() const { return code_; }
  [[nodiscard]] const std::string& what() const { return what_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& todo() const { return todo_; }

  // "where: what (todo)" without the empty parts; "ok" on success.
  [[nodiscard]] std::string ToString() const;

  // The same failure, with `where` filled in if it was empty.
  [[nodiscard]] Status At(std::string_view where) const;

  // The same failure inside a larger thing, for example a field inside a file: prefixes `where`
  // with "outer: ".
  [[nodiscard]] Status Within(std::string_view outer) const;

 private:
  StatusCode code_ = StatusCode::kOk;
  std::string what_;
  std::string where_;
  std::string todo_;
};

// A value, or the Status of the failure that prevented it. status() of a value is Ok.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}         // NOLINT: implicit
  Result(Status status) : state_(std::in_place_index<1>, std::move(status)) {}  // NOLINT: implicit

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  [[nodiscard]] Status status() const { return ok() ? Status() : std::get<1>(state_); }

  // Precondition of the accessors below: ok().
  [[nodiscard]] T& value() & { return std::get<0>(state_); }
  [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] T* operator->() { return &value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }

 private:
  std::variant<T, Status> state_;
};

// The failure that an expression reports, whether it returns a Status or a Result.
[[nodiscard]] inline const Status& FailureOf(const Status& status) { return status; }
template <class T>
[[nodiscard]] Status FailureOf(const Result<T>& result) {
  return result.status();
}

}  // namespace furrow

// Returns the failure of a Status or Result expression from the enclosing function, which must
// return a Status or a Result. Does nothing on success. Evaluates the expression once.
#define FURROW_RETURN_IF_ERROR(...)                                         \
  do {                                                                      \
    if (const auto& furrow_outcome = (__VA_ARGS__); !furrow_outcome.ok()) { \
      return ::furrow::FailureOf(furrow_outcome);                           \
    }                                                                       \
  } while (false)
