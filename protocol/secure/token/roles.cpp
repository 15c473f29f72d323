// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/token/roles.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"

namespace furrow::protocol::secure {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, 4> kWords = {{{Role::kPublish, "publish"},
                                                                      {Role::kWatch, "watch"},
                                                                      {Role::kDirect, "direct"},
                                                                      {Role::kOperate, "operate"}}};

}  // namespace

std::string ToText(Roles roles) {
  std::string text;
  for (const auto& [role, word] : kWords) {
    if (roles.Has(role)) text.append(text.empty() ? "" : ",").append(word);
  }
  return text;
}

Result<Roles> ParseRoles(std::string_view text) {
  Roles roles;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    const auto* const found =
        std::find_if(kWords.begin(), kWords.end(), [&](const auto& w) { return w.second == word; });
    if (found == kWords.end()) {
      return Status(StatusCode::kInvalidArgument,
                    Quoted(word) + " is not a role; the roles are publish, watch, direct, operate");
    }
    roles = roles | found->first;
    if (comma == std::string_view::npos) return roles;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace furrow::protocol::secure
