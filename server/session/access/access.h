// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/secure/token/connect_token.h"
#include "server/core/time.h"

namespace furrow::server {

using protocol::secure::Role;

// What a peer or an HTTP request may do. All checks of permissions are calls of this class.
class Access {
 public:
  // Nothing: before a token was shown.
  Access() = default;
  // Everything: for everybody at an open daemon, and for parts of the daemon itself.
  [[nodiscard]] static Access Everything();
  // What a token grants, until `expires`. `key_id`: of the key that sealed it.
  [[nodiscard]] static Access Of(const protocol::secure::Grant& grant, std::uint32_t key_id,
                                 Time expires);

  // False: nothing is allowed before a token is shown.
  [[nodiscard]] bool admitted() const { return kind_ != Kind::kNothing; }
  [[nodiscard]] bool by_token() const { return kind_ == Kind::kToken; }

  [[nodiscard]] bool MayPublish(std::string_view subject) const {
    return MayDo(Role::kPublish, subject);
  }
  // Weights, poses and pictures of the subject, and everything that the API says about it.
  [[nodiscard]] bool MayWatch(std::string_view subject) const {
    return MayDo(Role::kWatch, subject);
  }
  // True if the subject is one of those that the access is for, whatever the role.
  [[nodiscard]] bool Concerns(std::string_view subject) const;
  // True if the access is for all subjects.
  [[nodiscard]] bool ConcernsAll() const;
  // True if the holder has the role at all.
  [[nodiscard]] bool Has(Role role) const {
    return kind_ == Kind::kEverything || (kind_ == Kind::kToken && grant_.roles.Has(role));
  }

  // What the token states. Only by_token().
  [[nodiscard]] const protocol::secure::Grant& grant() const { return grant_; }
  // "the token allows publish, watch of stage-*", for messages.
  [[nodiscard]] std::string Text() const;

  // By token: when it expires, the id of its key, and the most packets per second (0: no limit).
  [[nodiscard]] Time expires() const { return expires_; }
  [[nodiscard]] std::uint32_t key_id() const { return key_id_; }
  [[nodiscard]] std::uint32_t packets_per_second() const { return grant_.packets_per_second; }

 private:
  enum class Kind : std::uint8_t { kNothing, kEverything, kToken };
  [[nodiscard]] bool MayDo(Role role, std::string_view subject) const;

  Kind kind_ = Kind::kNothing;
  protocol::secure::Grant grant_;
  std::uint32_t key_id_ = 0;
  Time expires_{0};
};

}  // namespace furrow::server
