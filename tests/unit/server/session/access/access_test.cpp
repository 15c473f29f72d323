// SPDX-License-Identifier: Apache-2.0
#include "server/session/access/access.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using protocol::secure::Grant;
using protocol::secure::Roles;

Access Granted(Roles roles, const std::string& subjects) {
  Grant grant;
  grant.roles = roles;
  grant.subjects = subjects;
  return Access::Of(grant, 7, Time(5));
}

TEST(Access, NothingIsAllowedBeforeATokenIsShown) {
  const Access access;
  EXPECT_FALSE(access.admitted());
  EXPECT_FALSE(access.MayPublish("ann"));
  EXPECT_FALSE(access.MayWatch("ann"));
  EXPECT_FALSE(access.Concerns("ann"));
  EXPECT_FALSE(access.ConcernsAll());
  for (const Role role : {Role::kPublish, Role::kWatch, Role::kDirect, Role::kOperate}) {
    EXPECT_FALSE(access.Has(role));
  }
}

TEST(Access, AnOpenDaemonAllowsEverything) {
  const Access access = Access::Everything();
  EXPECT_TRUE(access.admitted());
  EXPECT_FALSE(access.by_token());
  EXPECT_TRUE(access.MayPublish("ann"));
  EXPECT_TRUE(access.MayWatch("ann"));
  EXPECT_TRUE(access.Has(Role::kOperate));
}

TEST(Access, ATokenAllowsItsRolesForItsSubjects) {
  const Access publisher = Granted(Role::kPublish, "stage-*,ann");
  EXPECT_TRUE(publisher.by_token());
  EXPECT_TRUE(publisher.MayPublish("stage-1"));
  EXPECT_TRUE(publisher.MayPublish("ann"));
  EXPECT_FALSE(publisher.MayPublish("bob"));
  EXPECT_FALSE(publisher.MayWatch("ann"));
  EXPECT_TRUE(publisher.Concerns("ann")) << "whatever the role";
  EXPECT_FALSE(publisher.ConcernsAll());
  EXPECT_TRUE(Access::Everything().ConcernsAll());
  EXPECT_FALSE(publisher.Has(Role::kDirect));
  EXPECT_EQ(publisher.Text(), "the token allows publish of 'stage-*,ann'");
  const Access both = Granted(Roles(Role::kWatch) | Role::kDirect, "ann");
  EXPECT_TRUE(both.MayWatch("ann"));
  EXPECT_FALSE(both.MayPublish("ann"));
  EXPECT_TRUE(both.Has(Role::kDirect));
  EXPECT_EQ(both.key_id(), 7u);
  EXPECT_EQ(both.expires(), Time(5));
}

}  // namespace
}  // namespace furrow::server
