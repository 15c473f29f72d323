// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/address_proof.h"

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr Time kProofNow = FromSeconds(1000);
constexpr std::uint64_t kSession = 77;

class AddressProofTest : public testing::Test {
 protected:
  AddressProof proof{AddressProof::Key{1, 2, 3}};
  UdpAddress address{10, 0, 0, 1};
};

TEST_F(AddressProofTest, ATokenIsValidForOneToTwoSlots) {
  const std::uint64_t token = proof.Token(address, kSession, kProofNow);
  EXPECT_NE(token, 0u);
  EXPECT_TRUE(proof.Check(address, kSession, token, kProofNow));
  EXPECT_TRUE(proof.Check(address, kSession, token, kProofNow + AddressProof::kSlot));
  EXPECT_FALSE(proof.Check(address, kSession, token, kProofNow + 2 * AddressProof::kSlot));
  EXPECT_FALSE(proof.Check(address, kSession, token, kProofNow - AddressProof::kSlot));
}

TEST_F(AddressProofTest, ATokenIsValidForOneAddressAndOneSession) {
  const std::uint64_t token = proof.Token(address, kSession, kProofNow);
  EXPECT_FALSE(proof.Check(address, kSession + 1, token, kProofNow));
  for (std::size_t i = 0; i < address.size(); ++i) {
    UdpAddress other = address;
    other[i] ^= 1;
    EXPECT_FALSE(proof.Check(other, kSession, token, kProofNow)) << "byte " << i;
  }
  const AddressProof restarted(AddressProof::Key{1, 2, 4});
  EXPECT_FALSE(restarted.Check(address, kSession, token, kProofNow));
}

TEST_F(AddressProofTest, NoTokenProvesNothing) {
  EXPECT_FALSE(proof.Check(address, kSession, 0, kProofNow));
}

TEST_F(AddressProofTest, EveryBitOfTheTokenCounts) {
  const std::uint64_t token = proof.Token(address, kSession, kProofNow);
  for (int bit = 0; bit < 64; ++bit) {
    EXPECT_FALSE(proof.Check(address, kSession, token ^ (std::uint64_t{1} << bit), kProofNow));
  }
}

}  // namespace
}  // namespace furrow::server
