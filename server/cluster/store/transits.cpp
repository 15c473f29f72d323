// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/transits.h"

#include <algorithm>

#include "server/cluster/coordinator.h"

namespace furrow::server {

void Transits::Expect(std::string_view subject, Time now) {
  const std::lock_guard lock(mutex_);
  expected_.insert_or_assign(std::string(subject), now + Coordinator::kExpected);
}

void Transits::ForgetExpected(std::string_view subject) {
  const std::lock_guard lock(mutex_);
  if (const auto known = expected_.find(subject); known != expected_.end()) expected_.erase(known);
}

bool Transits::IsExpected(std::string_view subject, Time now) const {
  const std::lock_guard lock(mutex_);
  const auto known = expected_.find(subject);
  return known != expected_.end() && now < known->second;
}

std::size_t Transits::CountExpected(std::string_view besides,
                                    const std::function<bool(const std::string&)>& is_here,
                                    Time now) const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(std::ranges::count_if(expected_, [&](const auto& each) {
    return now < each.second && each.first != besides && !is_here(each.first);
  }));
}

bool Transits::ExpectsAny(Time now) {
  const std::lock_guard lock(mutex_);
  std::erase_if(expected_, [now](const auto& known) { return now >= known.second; });
  return !expected_.empty();
}

void Transits::Give(std::string_view subject, const NodeAddress& heir, Time now) {
  const std::lock_guard lock(mutex_);
  std::erase_if(given_, [now](const auto& given) { return now >= given.second.until; });
  given_.insert_or_assign(std::string(subject), Given{heir, now + Coordinator::kExpected});
  ++given_to_[heir.name];
}

std::optional<NodeAddress> Transits::HeirOf(std::string_view subject, Time now) const {
  const std::lock_guard lock(mutex_);
  const auto known = given_.find(subject);
  if (known == given_.end() || now >= known->second.until) return std::nullopt;
  return known->second.heir;
}

int Transits::NumGivenTo(const std::string& node) const {
  const std::lock_guard lock(mutex_);
  const auto known = given_to_.find(node);
  return known == given_to_.end() ? 0 : known->second;
}

}  // namespace furrow::server
