// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/access.h"

#include "protocol/messages/pattern.h"

namespace furrow::server {

Access Access::Everything() {
  Access access;
  access.kind_ = Kind::kEverything;
  return access;
}

Access Access::Of(const protocol::secure::Grant& grant, std::uint32_t key_id, Time expires) {
  Access access;
  access.kind_ = Kind::kToken;
  access.grant_ = grant;
  access.key_id_ = key_id;
  access.expires_ = expires;
  return access;
}

bool Access::Concerns(std::string_view subject) const {
  return kind_ == Kind::kEverything ||
         (kind_ == Kind::kToken && protocol::MatchesPattern(grant_.subjects, subject));
}

bool Access::ConcernsAll() const {
  return kind_ == Kind::kEverything || (kind_ == Kind::kToken && grant_.subjects == "*");
}

bool Access::MayDo(Role role, std::string_view subject) const {
  return Has(role) && Concerns(subject);
}

std::string Access::Text() const {
  return "the token allows " + ToText(grant_.roles) + " of '" + grant_.subjects + "'";
}

}  // namespace furrow::server
