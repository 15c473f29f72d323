// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

namespace furrow {

Status::Status(StatusCode code, std::string what, std::string where, std::string todo)
    : code_(code), what_(std::move(what)), where_(std::move(where)), todo_(std::move(todo)) {}

std::string Status::ToString() const {
  if (ok()) return "ok";
  std::string text;
  if (!where_.empty()) text += where_ + ": ";
  text += what_;
  if (!todo_.empty()) text += " (" + todo_ + ")";
  return text;
}

Status Status::At(std::string_view where) const {
  // The innermost place is the most precise one, so it stays.
  if (ok() || !where_.empty()) return *this;
  return {code_, what_, std::string(where), todo_};
}

Status Status::Within(std::string_view outer) const {
  if (ok()) return *this;
  return {code_, what_, std::string(outer) + (where_.empty() ? "" : ": " + where_), todo_};
}

}  // namespace furrow
