// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp_sender.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <numeric>
#include <utility>

#include <netinet/in.h>
#include <netinet/udp.h>

namespace furrow::server {

UdpSender::UdpSender() : buffer_(kMaxItems * protocol::kMaxDatagramBytes) {}

void UdpSender::Open(int socket) {
  socket_ = socket;
  int size = 0;
  socklen_t length = sizeof(size);
  can_cut_ = getsockopt(socket, SOL_UDP, UDP_SEGMENT, &size, &length) == 0;
}

std::span<std::uint8_t> UdpSender::Prepare() {
  if (num_items_ == kMaxItems) Flush();
  return std::span(buffer_).subspan(used_, protocol::kMaxDatagramBytes);
}

void UdpSender::Commit(std::uint64_t key, const asio::ip::udp::endpoint& to, std::size_t size) {
  items_[num_items_++] = {key, used_, size, to};
  used_ += size;
}

// How far from `first` one message goes: the same address, equal sizes, the last may be smaller.
std::size_t UdpSender::EndOfRun(std::size_t first) const {
  const Item& head = items_[order_[first]];
  std::size_t bytes = head.size;
  std::size_t last = first + 1;
  while (can_cut_ && last < num_items_ && last - first < kMaxSegments) {
    const Item& item = items_[order_[last]];
    bytes += item.size;
    if (item.key != head.key || item.size > head.size || bytes > kMaxCutBytes) break;
    ++last;
    if (item.size < head.size) break;
  }
  return last;
}

void UdpSender::Write(std::size_t message) {
  const auto [first, last] = messages_[message];
  Item& head = items_[order_[first]];
  msghdr& header = headers_[message].msg_hdr;
  header = {};
  header.msg_name = head.to.data();
  header.msg_namelen = static_cast<socklen_t>(head.to.size());
  header.msg_iov = &slices_[first];
  header.msg_iovlen = last - first;
  if (last - first < 2) return;
  header.msg_control = &controls_[message];
  header.msg_controllen = sizeof(Control);
  cmsghdr* item = CMSG_FIRSTHDR(&header);
  item->cmsg_level = SOL_UDP;
  item->cmsg_type = UDP_SEGMENT;
  item->cmsg_len = CMSG_LEN(sizeof(std::uint16_t));
  const auto size = static_cast<std::uint16_t>(head.size);
  std::memcpy(CMSG_DATA(item), &size, sizeof(size));
}

void UdpSender::Build() {
  const auto order = std::span(order_).first(num_items_);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [this](std::size_t i) { return std::pair(items_[i].key, i); });
  for (std::size_t i = 0; i < num_items_; ++i) {
    const Item& item = items_[order_[i]];
    slices_[i] = {buffer_.data() + item.offset, item.size};
  }
  num_messages_ = 0;
  for (std::size_t first = 0; first < num_items_;) {
    const std::size_t last = EndOfRun(first);
    messages_[num_messages_] = {first, last};
    Write(num_messages_++);
    first = last;
  }
}

void UdpSender::Flush() {
  if (num_items_ == 0) return;
  Build();
  Send();
  num_items_ = used_ = 0;
}

void UdpSender::Send() {
  std::size_t at = 0;
  while (at < num_messages_) {
    ++counts_.calls;
    const int sent =
        sendmmsg(socket_, &headers_[at], static_cast<unsigned>(num_messages_ - at), MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    for (int i = 0; i < sent; ++i, ++at) counts_.sent += messages_[at].last - messages_[at].first;
    if (sent > 0) continue;
    if (!Retry(at)) counts_.lost += messages_[at].last - messages_[at].first;
    ++at;
  }
}

// A message that the system would not cut after all (the way out has no checksums): one by one, and
// so from now on. False: that is not why it failed.
bool UdpSender::Retry(std::size_t message) {
  const auto [first, last] = messages_[message];
  if (last - first < 2 || (errno != EIO && errno != EINVAL && errno != EOPNOTSUPP)) return false;
  can_cut_ = false;
  msghdr header = headers_[message].msg_hdr;
  header.msg_iovlen = 1;
  header.msg_control = nullptr;
  header.msg_controllen = 0;
  for (std::size_t i = first; i < last; ++i) {
    header.msg_iov = &slices_[i];
    ++counts_.calls;
    ++(sendmsg(socket_, &header, MSG_DONTWAIT) < 0 ? counts_.lost : counts_.sent);
  }
  return true;
}

UdpSender::Counts UdpSender::TakeCounts() { return std::exchange(counts_, {}); }

}  // namespace furrow::server
