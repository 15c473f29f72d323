// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/store/records.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

const Lease kLease{.node = "stage-1", .run = 0xFEDCBA9876543210, .epoch = 42, .deadline_ms = 7};

Announcement Node() {
  return {.address =
              {.name = "b", .host = "fe80::1%eth0", .tcp = 1, .udp = 2, .http = 3, .https = true},
          .run = 9,
          .capacity = 2048,
          .subjects = 3,
          .draining = true,
          .ready = false};
}

TEST(LeaseRecord, ComesBackAsItWas) {
  EXPECT_EQ(ParseLease(ToText(kLease)), kLease);
  const Lease released{.node = {}, .run = 0, .epoch = kMaxEpoch, .deadline_ms = 0};
  EXPECT_EQ(ParseLease(ToText(released)), released);
}

TEST(LeaseRecord, EveryTruncationIsRefused) {
  const std::string text = ToText(kLease);
  // The last number stays valid while it has a digit, and here it has one.
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_FALSE(ParseLease(text.substr(0, size))) << text.substr(0, size);
  }
}

TEST(LeaseRecord, InvalidTextIsRefused) {
  for (const char* text :
       {"", "1", "2 a 1 1 1", "1 a 1 1 1 1", "1 a/b 1 1 1", "1 a g 1 1", "1 a 1 -1 1", "1 a 1 +1 1",
        "1 a 1 1 -1", "1 a 1 4611686018427387905 1", "1 a 1 99999999999999999999 1",
        "1 a 11111111111111111 1 1", "1 a 0x1 1 1"}) {
    EXPECT_FALSE(ParseLease(text)) << text;
  }
  EXPECT_FALSE(ParseLease("1 a 1 1 1" + std::string(kMaxRecordBytes, ' ')));
}

TEST(NodeRecord, ComesBackAsItWas) { EXPECT_EQ(ParseAnnouncement("b", ToText(Node())), Node()); }

// Without the last word, which older nodes do not write.
TEST(NodeRecord, EveryTruncationIsRefused) {
  const std::string text = ToText(Node());
  for (std::size_t size = 0; size < text.rfind(' '); ++size) {
    EXPECT_FALSE(ParseAnnouncement("b", text.substr(0, size))) << text.substr(0, size);
  }
}

// From now on, nodes may add words to their records.
TEST(NodeRecord, OlderNodesSpeakHttpAndNewerOnesMayWriteMore) {
  const auto older = ParseAnnouncement("b", "1 9 h 1 2 3 4 5 0 1");
  ASSERT_TRUE(older);
  EXPECT_FALSE(older->address.https);
  EXPECT_TRUE(older->ready);
  EXPECT_EQ(ParseAnnouncement("b", "1 9 h 1 2 3 4 5 0 1 "), older);
  EXPECT_EQ(ParseAnnouncement("b", "1 9 h 1 2 3 4 5 0 1 0"), older);
  EXPECT_EQ(ParseAnnouncement("b", ToText(Node()) + " anything else"), Node());
}

TEST(NodeRecord, InvalidTextIsRefused) {
  for (const char* text :
       {"", "1 9 h 0 2 3 4 5 0 0", "1 9 h 1 0 3 4 5 0 0", "1 9 h 65536 2 3 4 5 0 0",
        "1 9 h 1 2 3 1000001 5 0 0", "1 9 h 1 2 3 4 -5 0 0", "1 9 h 1 2 3 4 5 2 0",
        "1 9 h@x 1 2 3 4 5 0 0", "1 9 h/ 1 2 3 4 5 0 0", "1 9 h 1 2 3 4 5 0 0 2",
        "1 9 h 1 2 3 4 5 0 0 x"}) {
    EXPECT_FALSE(ParseAnnouncement("b", text)) << text;
  }
}

TEST(RecordKey, HoldsAnySubjectInOneForm) {
  const std::string subject = "Ada *.> \xC3\xA4";
  const std::string key = LeaseKey(subject);
  EXPECT_EQ(key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789."), std::string::npos);
  EXPECT_EQ(SubjectOfKey(key), subject);
  EXPECT_EQ(NodeOfKey(NodeKey("stage-1")), "stage-1");
}

TEST(RecordKey, OtherKeysAreRefused) {
  for (const std::string& key :
       {std::string(), std::string("lease."), std::string("lease.6"), std::string("lease.6A"),
        std::string("lease.6g"), std::string("lease.00"), std::string("lease.c3"),
        "lease." + std::string(512, '6'), std::string("node.a")}) {
    EXPECT_FALSE(SubjectOfKey(key)) << key;
  }
  for (const char* key : {"node.", "node.a b", "node.a.b", "lease.61", "nodea"}) {
    EXPECT_FALSE(NodeOfKey(key)) << key;
  }
}

}  // namespace
}  // namespace furrow::server
