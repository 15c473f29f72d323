// SPDX-License-Identifier: Apache-2.0
#include "protocol/secure/handshake/cookie.h"

#include <algorithm>

#include "protocol/messages/bytes.h"

namespace furrow::protocol::secure {

Cookie CookieMaker::Make(Purpose purpose, const PeerAddress& address, Context context,
                         std::int64_t now_us) {
  TurnTo(static_cast<std::uint64_t>(now_us / kSlotMicroseconds));
  return Compute(slot_, purpose, address, context);
}

bool CookieMaker::Check(CookieView cookie, Purpose purpose, const PeerAddress& address,
                        Context context, std::int64_t now_us) {
  TurnTo(static_cast<std::uint64_t>(now_us / kSlotMicroseconds));
  const auto slot = LoadLittle<std::uint64_t>(cookie.data());
  if (slot != slot_ && slot + 1 != slot_) return false;
  return EqualInConstantTime(Compute(slot, purpose, address, context), cookie);
}

void CookieMaker::TurnTo(std::uint64_t slot) {
  if (started_ && slot <= slot_) return;
  // After a gap, nobody has a cookie of the slot before. Its key must not be a known one.
  previous_ = started_ && slot == slot_ + 1 ? current_ : random_.MakeKey();
  current_ = random_.MakeKey();
  slot_ = slot;
  started_ = true;
}

Cookie CookieMaker::Compute(std::uint64_t slot, Purpose purpose, const PeerAddress& address,
                            Context context) const {
  std::array<std::uint8_t, 1 + 16 + 2 + kContextBytes + 8> input;
  std::uint8_t* out = input.data();
  *out++ = static_cast<std::uint8_t>(purpose);
  out = std::copy(address.host.begin(), address.host.end(), out);
  StoreLittle(address.port, out);
  out = std::copy(context.begin(), context.end(), out + 2);
  StoreLittle(slot, out);
  const Mac mac = Blake2b128(slot == slot_ ? current_ : previous_, input);
  Cookie cookie;
  StoreLittle(slot, cookie.data());
  std::copy(mac.begin(), mac.end(), cookie.begin() + 8);
  return cookie;
}

}  // namespace furrow::protocol::secure
