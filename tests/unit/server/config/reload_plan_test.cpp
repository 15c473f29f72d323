// SPDX-License-Identifier: Apache-2.0
#include "server/config/reload_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(PlanReload, NothingChanges) {
  const ReloadPlan plan = PlanReload({}, {}, false);
  EXPECT_THAT(plan.applied, IsEmpty());
  EXPECT_THAT(plan.needs_restart, IsEmpty());
  EXPECT_EQ(plan.config, Config());
}

TEST(PlanReload, TakesOverWhatCanChangeAndNothingElse) {
  Config wanted;
  wanted.udp = 7499;
  wanted.security.name = "stage";
  wanted.security.keys = "furrow.keys";
  wanted.mocap_allow = {"10.0.0.7"};
  wanted.http.allow_hosts = {"furrow.example"};
  wanted.log_level = LogLevel::kError;
  wanted.limits.max_subjects = 7;
  wanted.limits.max_udp_peers = 8;
  const ReloadPlan plan = PlanReload({}, wanted, false);
  EXPECT_THAT(plan.applied, ElementsAre("security.keys", "mocap.allow", "http.allow_hosts",
                                        "log.level", "limits.max_subjects"));
  EXPECT_THAT(plan.needs_restart,
              ElementsAre("listen.udp", "security.name", "limits.max_udp_peers"));
  Config expected;
  expected.security.keys = "furrow.keys";
  expected.mocap_allow = {"10.0.0.7"};
  expected.http.allow_hosts = {"furrow.example"};
  expected.log_level = LogLevel::kError;
  expected.limits.max_subjects = 7;
  EXPECT_EQ(plan.config, expected);
  // A second reload of the same file names the rest again, and only that.
  const ReloadPlan again = PlanReload(plan.config, wanted, false);
  EXPECT_THAT(again.applied, IsEmpty());
  EXPECT_EQ(again.needs_restart, plan.needs_restart);
}

TEST(PlanReload, EveryLimitButOneChanges) {
  Config wanted;
  wanted.limits = {.max_connections = 1,
                   .max_udp_peers = 2,
                   .max_subjects = 3,
                   .max_strangers_per_host = 14,
                   .max_skeletons = 4,
                   .max_subscriptions = 5,
                   .max_all_subscriptions = 12,
                   .packets_per_second = 6,
                   .packet_burst = 7,
                   .max_waiting_megabytes = 73,
                   .outbox_messages = 8,
                   .idle_seconds = 9,
                   .loss_seconds = 10,
                   .drain_seconds = 11};
  const ReloadPlan plan = PlanReload({}, wanted, false);
  EXPECT_THAT(plan.needs_restart, ElementsAre("limits.max_udp_peers"));
  Limits expected = wanted.limits;
  expected.max_udp_peers = Limits().max_udp_peers;
  EXPECT_EQ(plan.config.limits, expected);
}

TEST(PlanReload, CertificatesChangeButNotWhetherThereAreAny) {
  const TlsFiles first{.certificate = "a.crt", .key = "a.key", .client_authority = {}};
  const TlsFiles second{.certificate = "b.crt", .key = "b.key", .client_authority = {}};
  Config with;
  with.security.tls = first;
  Config other = with;
  other.security.tls = second;
  EXPECT_THAT(PlanReload(with, other, false).applied, ElementsAre("tls.certificate", "tls.key"));
  EXPECT_EQ(PlanReload(with, other, false).config.security.tls, second);
  EXPECT_THAT(PlanReload(with, {}, false).needs_restart, ElementsAre("tls.certificate", "tls.key"));
  EXPECT_EQ(PlanReload(with, {}, false).config.security.tls, first);
  Config asking = with;
  asking.security.tls.client_authority = "ca.crt";
  EXPECT_THAT(PlanReload(with, asking, false).needs_restart, ElementsAre("tls.client_authority"));
}

TEST(PlanReload, ARigChangesWhereNoPicturesBelongToIt) {
  Config running;
  running.rig = "a.json";
  Config wanted;
  wanted.rig = "b.json";
  EXPECT_THAT(PlanReload(running, wanted, false).applied, ElementsAre("rig"));
  EXPECT_THAT(PlanReload(running, wanted, true).needs_restart, ElementsAre("rig"));
  EXPECT_THAT(PlanReload(running, {}, false).needs_restart, ElementsAre("rig"))
      << "the default character has a rig and a skeleton";
}

}  // namespace
}  // namespace furrow::server
