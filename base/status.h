// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace furrow {

// Why something failed: what exit codes, replies to peers and tests go by. Words are Status's.
enum class StatusCode {
  kOk = 0,
  kInvalidArgument,  // the caller broke a contract: wrong size, unknown name, out of range
  kNotFound,         // a file, joint, region or subject that is not there
  kParse,            // the text or bytes are not what the format says
  kSchema,           // well-formed, but a field is missing, unknown or of the wrong type
  kLimit,            // larger or deeper than we accept from outside
  kNonFinite,        // NaN or infinity where a number is due
  kCyclic,           // a hierarchy that is not a tree
  kUnsupported,      // valid, but nothing we implement
  kIo,               // the operating system said no
  kUnavailable,      // a service (GL, a socket, a peer) cannot be had now
  kInternal,         // our own fault
};

// Success, or one clear message: what went wrong, where, and what to do.
//
// `where` is "file:line" for text, "file" or "file: field" for the
// rest, empty when there is no place. Not for the packet path: there,
// jobs and decoders return bare enums (see JobStatus and protocol/).
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(StatusCode code, std::string what, std::string where = {}, std::string todo = {});

  [[nodiscard]] bool ok() const { return code_ == StatusCode::kOk; }
  [[nodiscard]] StatusCode code() const { return code_; }
  [[nodiscard]] const std::string& what() const { return what_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const std::string& todo() const { return todo_; }

  // "where: what (todo)", leaving out what is empty; "ok" on success.
  [[nodiscard]] std::string ToString() const;

  // The same failure seen from further out: prefixes `where` when it is still empty.
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

// A value, or the Status that says why there is none. `status()` of a value is Ok.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}         // NOLINT: implicit
  Result(Status status) : state_(std::in_place_index<1>, std::move(status)) {}  // NOLINT: implicit

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  [[nodiscard]] Status status() const { return ok() ? Status() : std::get<1>(state_); }

  // Precondition of all below: ok().
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
