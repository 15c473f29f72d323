// SPDX-License-Identifier: Apache-2.0
#include "server/machine/listen_error.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::server {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(ListenError, AForeignAddressIsNamedBesideTheOwnOnes) {
  const Status status = ListenError("TCP", {"192.0.2.1", 7400}, EADDRNOTAVAIL, "--tcp");
  EXPECT_EQ(status.code(), StatusCode::kUnavailable);
  EXPECT_EQ(status.what(),
            "cannot listen on TCP 192.0.2.1 port 7400: 192.0.2.1 is not an address of this "
            "computer");
  EXPECT_THAT(status.todo(), AllOf(HasSubstr("127.0.0.1"), HasSubstr("--bind"),
                                   Not(HasSubstr("stop the program"))));
}

TEST(ListenError, ATakenPortNamesTheFlag) {
  const Status status = ListenError("UDP", {"::1", 7401}, EADDRINUSE, "--udp");
  EXPECT_THAT(status.ToString(), AllOf(HasSubstr("UDP ::1 port 7401: Address already in use"),
                                       HasSubstr("stop the program"), HasSubstr("--udp")));
}

TEST(ListenError, LowPortsNeedPrivileges) {
  EXPECT_THAT(ListenError("TCP", {"127.0.0.1", 80}, EACCES, "--http").todo(),
              AllOf(HasSubstr("below 1024"), HasSubstr("--http")));
}

TEST(ListenError, OtherReasonsAreThoseOfTheSystem) {
  EXPECT_THAT(ListenError("TCP", {"127.0.0.1", 80}, EMFILE, "--http").what(),
              HasSubstr("Too many open files"));
}

}  // namespace
}  // namespace furrow::server
