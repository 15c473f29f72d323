// SPDX-License-Identifier: Apache-2.0
#include "base/process/helper_reply.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(HelperReply, NotesAndPayloadComeBack) {
  const HelperReply sent{{"one", "", "three"}, std::string("glTF\0\n", 6)};
  const auto reply = DecodeReply(EncodeReply(sent));
  ASSERT_TRUE(reply.ok()) << reply.status().ToString();
  EXPECT_EQ(reply->notes, sent.notes);
  EXPECT_EQ(reply->payload, sent.payload);
}

TEST(HelperReply, ErrorsComeBackUnchanged) {
  const auto reply =
      DecodeReply(EncodeReply(Status(StatusCode::kUnsupported, "what", "where", "todo")));
  EXPECT_EQ(reply.status().code(), StatusCode::kUnsupported);
  EXPECT_EQ(reply.status().ToString(), "where: what (todo)");
}

TEST(HelperReply, EveryTruncationOfTheHeaderIsAnError) {
  const std::string reply = EncodeReply(HelperReply{{"one", "two"}, ""});
  const std::string error = EncodeReply(Status(StatusCode::kParse, "a", "b", "c"));
  for (const std::string& bytes : {reply, error}) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_EQ(DecodeReply(bytes.substr(0, size)).status().code(), StatusCode::kParse) << size;
    }
  }
}

TEST(HelperReply, LyingCountsAndCodesAreErrors) {
  std::string bytes = EncodeReply(HelperReply{{"one"}, "payload"});
  for (const std::size_t at : {1u, 5u}) {  // the number of notes, the length of the first
    std::string lying = bytes;
    std::memset(lying.data() + at, 0xff, 4);
    EXPECT_EQ(DecodeReply(lying).status().code(), StatusCode::kParse) << at;
  }
  bytes = EncodeReply(Status(StatusCode::kParse, "a", "b", "c"));
  bytes[0] = '\x7f';
  EXPECT_EQ(DecodeReply(bytes).status().what().find("incomplete") != std::string::npos, true);
}

}  // namespace
}  // namespace furrow
