// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/subject_registry.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr StreamKey Key(std::uint64_t session) { return {.peer = 1, .session = session}; }

TEST(SubjectRegistry, TheNewestRetiredStreamsAreRemembered) {
  SubjectRegistry registry;
  Subject& subject = registry.Add("ann", Time{0});
  std::uint64_t session = 1;
  for (; session <= SubjectRegistry::kMaxRetired + 2; ++session) {
    registry.SetOwner(subject, Key(session));
  }
  EXPECT_FALSE(registry.IsRetired(Key(1)));
  EXPECT_TRUE(registry.IsRetired(Key(2)));
  EXPECT_TRUE(registry.IsRetired(Key(session - 2)));
  EXPECT_FALSE(registry.IsRetired(Key(session - 1))) << "it feeds the subject";
}

TEST(SubjectRegistry, RetiringAgainRenewsTheMemory) {
  SubjectRegistry registry;
  Subject& subject = registry.Add("ann", Time{0});
  for (const std::uint64_t session : {1, 2, 1, 3}) registry.SetOwner(subject, Key(session));
  for (std::uint64_t i = 0; i < SubjectRegistry::kMaxRetired - 1; ++i) {
    EXPECT_TRUE(registry.IsRetired(Key(1))) << i;
    registry.SetOwner(subject, Key(100 + i));
  }
  EXPECT_TRUE(registry.IsRetired(Key(1)));
  registry.SetOwner(subject, Key(99));
  EXPECT_FALSE(registry.IsRetired(Key(1)));
}

}  // namespace
}  // namespace furrow::server
