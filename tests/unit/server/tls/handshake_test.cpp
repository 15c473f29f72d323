// SPDX-License-Identifier: Apache-2.0
#include "server/tls/handshake.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include "server/tls/handshake_places.h"

namespace furrow::server {
namespace {

TEST(Handshake, TlsIsKnownByItsFirstBytes) {
  for (std::uint8_t minor = 0; minor <= 4; ++minor) {
    const std::array<std::uint8_t, 3> hello{22, 3, minor};
    for (std::size_t size = 0; size <= hello.size(); ++size) {
      EXPECT_TRUE(LooksLikeTls(std::span(hello).first(size)));
    }
  }
  // HTTP, a Furrow message of 22 bytes, and records that begin no handshake.
  const std::array<std::uint8_t, 3> others[] = {
      {'G', 'E', 'T'}, {22, 0, 0}, {21, 3, 3}, {22, 2, 0}, {22, 3, 5}};
  for (const auto& bytes : others) EXPECT_FALSE(LooksLikeTls(bytes));
}

TEST(Handshake, FailuresAreCountedByReason) {
  const auto counter = [](int reason) {
    return HandshakeFailure(ERR_PACK(ERR_LIB_SSL, 0, reason));
  };
  EXPECT_EQ(counter(SSL_R_UNSUPPORTED_PROTOCOL), Counter::kTlsOldVersion);
  EXPECT_EQ(counter(SSL_R_NO_APPLICATION_PROTOCOL), Counter::kTlsWrongProtocol);
  EXPECT_EQ(counter(SSL_R_PEER_DID_NOT_RETURN_A_CERTIFICATE), Counter::kTlsNoCertificate);
  EXPECT_EQ(counter(SSL_R_CERTIFICATE_VERIFY_FAILED), Counter::kTlsBadCertificate);
  EXPECT_EQ(counter(SSL_R_TLSV1_ALERT_UNKNOWN_CA), Counter::kTlsRefusedByClient);
  EXPECT_EQ(counter(SSL_R_BAD_EXTENSION), Counter::kTlsFailed);
  EXPECT_EQ(HandshakeFailure(2), Counter::kTlsFailed) << "the connection ended";
}

TEST(HandshakeBudget, AHostUsesUpNothingOfOthers) {
  HandshakeBudget budget;
  const Time now = std::chrono::seconds(100);
  std::uint32_t taken = 0;
  while (budget.Take("192.0.2.1", now)) ++taken;
  EXPECT_EQ(taken, HandshakeBudget::kPerHost);
  EXPECT_FALSE(budget.Take("192.0.2.1", now));
  EXPECT_TRUE(budget.Take("192.0.2.2", now));
  EXPECT_TRUE(budget.Take("2001:db8::", now));
  EXPECT_TRUE(budget.Take("192.0.2.1", now + std::chrono::seconds(1))) << "it fills again";
}

TEST(HandshakeBudget, AllHostsTogetherHaveALimit) {
  HandshakeBudget budget;
  const Time now = std::chrono::seconds(100);
  std::uint32_t taken = 0;
  for (int host = 0; host < 250; ++host) {
    const std::string name = "192.0.2." + std::to_string(host);
    for (int i = 0; i < 3; ++i) taken += budget.Take(name, now) ? 1 : 0;
  }
  EXPECT_EQ(taken, HandshakeBudget::kTotal + HandshakeBudget::kReserve);
}

TEST(HandshakeBudget, TwoHostsDoNotShutOutAThirdOne) {
  HandshakeBudget budget;
  const Time now = std::chrono::seconds(100);
  for (const char* host : {"192.0.2.1", "192.0.2.2"}) {
    while (budget.Take(host, now)) {
    }
  }
  std::uint32_t taken = 0;
  while (budget.Take("192.0.2.3", now)) ++taken;
  EXPECT_EQ(taken, HandshakeBudget::kReservePerHost);
}

TEST(HandshakePlaces, AHostHasOne) {
  const HandshakePlaces places;
  auto one = places.Enter("192.0.2.1");
  ASSERT_NE(one, nullptr);
  EXPECT_EQ(places.Enter("192.0.2.1"), nullptr);
  EXPECT_NE(places.Enter("192.0.2.2"), nullptr);
  one.reset();
  EXPECT_NE(places.Enter("192.0.2.1"), nullptr) << "the place came back";
}

TEST(HandshakePlaces, AHostMayHaveMore) {
  HandshakePlaces places;
  places.SetPlacesOfHost(3);
  std::vector<std::unique_ptr<HandshakePlaces::Place>> held;
  for (int i = 0; i < 3; ++i) {
    held.push_back(places.Enter("192.0.2.1"));
    ASSERT_NE(held.back(), nullptr);
  }
  EXPECT_EQ(places.Enter("192.0.2.1"), nullptr);
  EXPECT_NE(places.Enter("192.0.2.2"), nullptr);
  const auto waiting = places.Wait("192.0.2.1");
  for (const auto& place : held) EXPECT_TRUE(place->IsWanted());
  places.SetPlacesOfHost(1);
  held.pop_back();
  held.pop_back();
  EXPECT_EQ(places.Enter("192.0.2.1"), nullptr) << "one is held yet";
  held.pop_back();
  EXPECT_NE(places.Enter("192.0.2.1"), nullptr);
}

TEST(HandshakePlaces, AllPlacesHaveALimitWithManyPerHost) {
  HandshakePlaces places;
  places.SetPlacesOfHost(HandshakePlaces::kPlaces);
  std::vector<std::unique_ptr<HandshakePlaces::Place>> held;
  while (auto place = places.Enter("192.0.2.1")) held.push_back(std::move(place));
  EXPECT_EQ(held.size(), HandshakePlaces::kPlaces);
  EXPECT_EQ(places.Enter("192.0.2.2"), nullptr);
  const auto waiting = places.Wait("192.0.2.2");
  EXPECT_TRUE(held.front()->IsWanted());
}

TEST(HandshakePlaces, APlaceIsWantedByThoseOfItsHost) {
  const HandshakePlaces places;
  const auto place = places.Enter("192.0.2.1");
  const auto other = places.Enter("192.0.2.2");
  EXPECT_FALSE(place->IsWanted());
  auto first = places.Wait("192.0.2.1");
  auto second = places.Wait("192.0.2.1");
  EXPECT_TRUE(place->IsWanted());
  EXPECT_FALSE(other->IsWanted());
  first.reset();
  EXPECT_TRUE(place->IsWanted());
  second.reset();
  EXPECT_FALSE(place->IsWanted());
}

TEST(HandshakePlaces, EveryPlaceIsWantedWhenNoneIsLeft) {
  const HandshakePlaces places;
  std::vector<std::unique_ptr<HandshakePlaces::Place>> held;
  for (std::size_t i = 0; i < HandshakePlaces::kPlaces; ++i) {
    held.push_back(places.Enter(std::to_string(i)));
    ASSERT_NE(held.back(), nullptr);
  }
  EXPECT_EQ(places.Enter("192.0.2.1"), nullptr);
  {
    const auto waiting = places.Wait("1");
    EXPECT_TRUE(held[1]->IsWanted());
    EXPECT_FALSE(held[2]->IsWanted()) << "the place would be of no use to a host that has its own";
  }
  const auto waiting = places.Wait("192.0.2.1");
  EXPECT_TRUE(held.front()->IsWanted());
  held.pop_back();
  EXPECT_FALSE(held.front()->IsWanted());
  EXPECT_NE(places.Enter("192.0.2.1"), nullptr);
}

TEST(HandshakePlaces, APlaceMayOutliveThem) {
  std::unique_ptr<HandshakePlaces::Place> place;
  HandshakePlaces::Waiting waiting;
  {
    const HandshakePlaces places;
    place = places.Enter("192.0.2.1");
    waiting = places.Wait("192.0.2.1");
  }
  waiting.reset();  // must not touch what has gone
  EXPECT_FALSE(place->IsWanted());
}

}  // namespace
}  // namespace furrow::server
