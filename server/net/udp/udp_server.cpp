// SPDX-License-Identifier: Apache-2.0
#include "server/net/udp/udp_server.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include <asio/post.hpp>
#include <asio/use_awaitable.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/framing/envelope.h"
#include "server/core/network_address.h"
#include "server/core/within_memory.h"
#include "server/machine/listen_error.h"
#include "server/net/await_tuple.h"
#include "server/net/clock.h"
#include "server/net/critical_task.h"
#include "server/net/local_endpoint.h"
#include "server/net/udp/udp_address.h"
#include "server/session/peers/peer_label.h"

namespace furrow::server {
namespace {

using asio::ip::udp;

// Holds a burst of a thousand subjects while the thread is busy.
constexpr int kReceiveBufferBytes = 4 * 1024 * 1024;
// Batches read before the event loop may run other work.
constexpr int kMaxBatches = 8;

// Sets SO_REUSEPORT, for which Asio has no option.
asio::error_code AllowSharing(int socket) {
  const int yes = 1;
  if (setsockopt(socket, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof(yes)) == 0) return {};
  return {errno, asio::error::get_system_category()};
}

// The host of an address, as in HostOf(): its network of 64 bits. In ::/64, which has the mapped
// IPv4 addresses, it is the other half.
std::uint64_t HostNumber(const UdpAddress& address) {
  std::uint64_t host = 0;
  std::memcpy(&host, address.data(), sizeof(host));
  if (host == 0) std::memcpy(&host, address.data() + sizeof(host), sizeof(host));
  return host;
}

}  // namespace

// One UDP address. Its messages leave when the shard is flushed, as bundles if the peer accepts
// them. Sending never blocks; if the socket buffer is full, datagrams are lost.
class UdpServer::UdpPeer : public Link {
 public:
  UdpPeer(UdpServer* server, udp::endpoint endpoint, std::uint64_t peer_session,
          std::uint32_t secure_session = 0)
      : session(peer_session),
        address(AddressOf(endpoint)),
        host_number_(HostNumber(address)),
        server_(server),
        endpoint_(endpoint),
        secure_session_(secure_session) {}

  void SendReply(std::span<const std::uint8_t> message) override {
    Send(message, server_->sender_);
  }
  int SendFrame(std::uint64_t, std::span<const std::uint8_t> message, std::size_t,
                int shard) override {
    // A frame leaves through the publishing shard's socket, whose lock the caller holds. Using the
    // sender of the peer's own shard would need that shard's lock for every pose. A reply, and a
    // frame that follows one, leaves through the peer's own socket, so that the two keep their
    // order.
    UdpServer& by =
        shard == kExclusive ? *server_ : *server_->by_shard_[static_cast<std::size_t>(shard)];
    Send(message, by.sender_);
    return 0;
  }
  void SetTakesBundles(bool takes) override { takes_bundles_ = takes; }
  void DropFrames(std::uint64_t) override {}  // nothing is queued

  // What the hub does not know of it.
  [[nodiscard]] SavedUdpPeer Saved(int shard) const {
    return {.shard = static_cast<std::uint8_t>(shard),
            .address = address,
            .scope = ScopeOf(endpoint_),
            .is_v4 = endpoint_.address().is_v4(),
            .session = session,
            .secure_session = secure_session_,
            .next_message = next_message_id_,
            .takes_bundles = takes_bundles_,
            .peer = {}};
  }
  void GoOnFrom(const SavedUdpPeer& saved) {
    next_message_id_ = saved.next_message;
    takes_bundles_ = saved.takes_bundles;
  }

  [[nodiscard]] std::string host() const { return HostOf(endpoint_.address().to_string()); }
  [[nodiscard]] protocol::FragmentSource source() const { return {host_number_, id}; }

  PeerId id = 0;
  Peer* entry = nullptr;  // of the hub
  const std::uint64_t
      session;            // in all messages of the peer; 0 for secure ones, which may have any
  const Address address;  // of a secure peer: the first one

 private:
  void Send(std::span<const std::uint8_t> message, UdpSender& sender) {
    const std::size_t count = protocol::NumDatagrams(message.size());
    const std::uint32_t message_id = count > 1 ? next_message_id_++ : 0;
    const Packing packing = takes_bundles_ && count == 1 ? Packing::kBundled : Packing::kSeparate;
    for (std::size_t index = 0; index < count; ++index) {
      const auto datagram = sender.Prepare();
      sender.Commit(id, endpoint_, protocol::WriteDatagram(message, message_id, index, datagram),
                    packing, secure_session_);
    }
  }

  const std::uint64_t host_number_;
  UdpServer* server_;
  udp::endpoint endpoint_;
  const std::uint32_t secure_session_;              // 0: plain
  std::atomic<std::uint32_t> next_message_id_ = 0;  // several shards may send
  bool takes_bundles_ = false;
};

UdpServer::UdpServer(asio::io_context& io, const Limits& limits, Hub* hub, Metrics* metrics,
                     RecordingTap* recording, int shard, SecureSessions* secure,
                     bool requires_token)
    : io_(io),
      socket_(io),
      hub_(hub),
      metrics_(metrics),
      recording_(recording),
      shard_(shard),
      // Enough for a server without Join(), as in tests.
      by_shard_(static_cast<std::size_t>(shard) + 1, this),
      secure_(secure),
      reception_(hub->session(), &hub->address_proof(), metrics, requires_token),
      shares_(static_cast<std::size_t>(limits.max_udp_peers)),
      release_(io) {
  hub_->SetBufferedSender(shard_, this);
  sender_.SetSealer(secure);
}

UdpServer::~UdpServer() { hub_->SetBufferedSender(shard_, nullptr); }

Status UdpServer::Open(const udp::endpoint& endpoint, Port port) {
  asio::error_code error;
  socket_.open(endpoint.protocol(), error);
  if (!error && port == Port::kShared) error = AllowSharing(socket_.native_handle());
  if (!error) socket_.bind(endpoint, error);
  if (!error) socket_.non_blocking(true, error);
  if (error) {
    return ListenError("UDP", {endpoint.address().to_string(), endpoint.port()}, error.value(),
                       "--udp");
  }
  UdpBatch::CountDropped(socket_.native_handle());
  PrepareSocket(/*adopted=*/false);
  // The kernel may grant less; then drops begin earlier.
  socket_.set_option(asio::socket_base::receive_buffer_size(kReceiveBufferBytes), error);
  return {};
}

Status UdpServer::Adopt(int socket) {
  asio::error_code error;
  const udp::endpoint bound = LocalEndpoint(socket, error);
  if (!error) socket_.assign(bound.protocol(), socket, error);
  if (error) close(socket);
  if (!error) socket_.non_blocking(true, error);
  if (error) {
    return {StatusCode::kUnavailable,
            "cannot use the UDP socket of the former daemon: " + error.message()};
  }
  PrepareSocket(/*adopted=*/true);
  return {};
}

void UdpServer::PrepareSocket(bool adopted) {
  sender_.Open(socket_.native_handle());
  // An adopted socket has the option of the former daemon. A new one has that of the system.
  if (busy_poll_ == Time{0} && !adopted) return;
  // Lets a look for datagrams ask the network card. Optional: it needs a privilege unless it is 0,
  // and the loopback has no card.
  const auto microseconds = static_cast<int>(ToMicroseconds(busy_poll_));
  setsockopt(socket_.native_handle(), SOL_SOCKET, SO_BUSY_POLL, &microseconds,
             sizeof(microseconds));
}

Status UdpServer::Share() {
  const asio::error_code error = AllowSharing(socket_.native_handle());
  if (!error) return {};
  return Status(StatusCode::kUnavailable, "cannot share the UDP port: " + error.message(), "",
                "use --threads 1");
}

std::uint16_t UdpServer::port() const {
  asio::error_code error;
  return socket_.local_endpoint(error).port();
}

void UdpServer::Start() { StartCriticalTask(io_, Read()); }

void UdpServer::DropWaiting() {
  while (batch_.Receive(socket_.native_handle()) == UdpBatch::kSize) {
  }
}

void UdpServer::Close() {
  asio::error_code error;
  socket_.close(error);
  release_.cancel();
  sender_.Close();
}

asio::awaitable<void> UdpServer::Read() {
  while (IsReading()) {
    // Asio only waits; recvmmsg() reads, because Asio receives one datagram per call.
    const auto [error] = co_await socket_.async_wait(udp::socket::wait_read, kAwaitTuple);
    if (error || stops_reading_) co_return;
    metrics_->Add(Counter::kWakeUps);
    const std::uint64_t before = num_of_peers_;
    const bool is_drained = ReadBatches();
    // Lets timers and TCP run while datagrams keep arriving.
    if (!is_drained) co_await asio::post(io_, asio::use_awaitable);
    // Strangers must not keep a core busy.
    if (busy_poll_ == Time{0} || num_of_peers_ == before) continue;
    busy_until_ = ReadClock() + busy_poll_;
    while (IsReading() && ReadClock() < busy_until_) {
      Poll();
      co_await asio::post(io_, asio::use_awaitable);
    }
  }
}

// True if no datagrams are left.
bool UdpServer::ReadBatches() {
  for (int batch = 0; batch < kMaxBatches; ++batch) {
    const std::size_t count = batch_.Receive(socket_.native_handle());
    HandleBatch(count);
    if (count < UdpBatch::kSize) return true;
  }
  return false;
}

// A few looks for datagrams, since the loop's own look at all other work costs as much as several.
void UdpServer::Poll() {
  constexpr int kLooks = 16;
  int batches = 0;
  for (int look = 0; look < kLooks && batches < kMaxBatches; ++look) {
    const std::size_t count = batch_.Receive(socket_.native_handle());
    if (count == 0) continue;
    ++batches;
    const std::uint64_t before = num_of_peers_;
    HandleBatch(count);
    metrics_->Add(Counter::kWakeUpsSpared);
    if (num_of_peers_ != before) busy_until_ = ReadClock() + busy_poll_;
  }
}

void UdpServer::HandleBatch(std::size_t count) {
  // One clock reading per batch. The datagrams of a batch waited for the same system call.
  const Time now = ReadClock();
  metrics_->Add(Counter::kDatagramsReceived, count);
  metrics_->Add(Counter::kDatagramsOverrun, batch_.TakeDropped());
  // Held for a whole batch: its end solves the poses together and flushes the messages. Not held
  // across co_await, which would let other coroutines of this thread run inside it.
  const Hub::ShardLock lock(*hub_, shard_);
  for (std::size_t i = 0; i < count; ++i) {
    WithinMemory(metrics_, [&] { OnDatagram(batch_.bytes(i), batch_.sender(i), now); });
  }
  ForgetClosed();
  ReleaseInTime();
}

// Requires the shard's lock. An own timer, because few streams need one, and those to the
// millisecond.
void UdpServer::ReleaseInTime() {
  const std::optional<Time> due = hub_->NextAhead(shard_);
  if (!due || (release_at_ && *release_at_ <= *due)) return;
  release_at_ = due;
  release_.expires_at(asio::steady_timer::time_point(*due));
  release_.async_wait([this](const asio::error_code& error) {
    if (error) return;  // an earlier time has replaced this one, or the server has closed
    release_at_.reset();
    const Hub::ShardLock lock(*hub_, shard_);
    hub_->ReleaseHeld(shard_, ReadClock());
    ReleaseInTime();
  });
}

void UdpServer::Flush() {
  sender_.Flush();
  const UdpSender::Counts counts = sender_.TakeCounts();
  metrics_->Add(Counter::kDatagramsSent, counts.sent);
  metrics_->Add(Counter::kDatagramsUnsendable, counts.lost);
  metrics_->Add(Counter::kMessagesBundled, counts.bundled);
  auto& published = hub_->published(shard_);
  if (published.empty()) return;
  const Time now = ReadClock();
  for (const Shard::Published& pose : published) {
    metrics_->Observe(Timing::kReceiveToSend, now - pose.received);
    if (pose.late) metrics_->Observe(Timing::kCaptureToSend, now - pose.received + *pose.late);
  }
  published.clear();
}

void UdpServer::OnDatagram(std::span<std::uint8_t> bytes, const udp::endpoint& sender, Time now) {
  if (secure_ != nullptr && protocol::secure::IsSecure(bytes)) {
    OnSealed(bytes, sender, now);
  } else {
    OnPlain(bytes, sender, now);
  }
}

void UdpServer::OnPlain(std::span<const std::uint8_t> bytes, const udp::endpoint& sender,
                        Time now) {
  protocol::Envelope envelope;
  // Receive() cuts larger datagrams to one byte more than the limit, so they show here.
  if (bytes.size() > protocol::kMaxDatagramBytes ||
      protocol::ReadEnvelope(bytes, envelope) != protocol::EnvelopeStatus::kOk) {
    metrics_->Add(Counter::kDatagramsMalformed);
    return;
  }
  const Address address = AddressOf(sender);
  const std::uint64_t session = envelope.header.session;
  UdpPeer* peer = Find(address, session);
  if (peer == nullptr) peer = Receive(address, sender, session, bytes, now);
  if (peer == nullptr) return;
  ++num_of_peers_;
  Deliver(*peer, bytes, Lifetime::kBatch, now);
}

void UdpServer::Deliver(const UdpPeer& peer, std::span<const std::uint8_t> bytes, Lifetime lifetime,
                        Time now) {
  if (recording_ != nullptr) recording_->OnDatagram(peer.address, bytes, now);
  std::span<const std::uint8_t> message;
  switch (reassembler_.Push(peer.source(), bytes, ToMicroseconds(now), message)) {
    // The batch keeps whole datagrams until the lock ends, so poses may wait. The reassembler
    // reuses its buffer, so a reassembled message is handled at once.
    case protocol::FragmentStatus::kWhole:
      if (lifetime == Lifetime::kBatch) return hub_->GatherMessage(*peer.entry, message, now);
      return hub_->OnMessage(peer.id, message, now);
    case protocol::FragmentStatus::kComplete: return hub_->OnMessage(peer.id, message, now);
    case protocol::FragmentStatus::kPending:
    case protocol::FragmentStatus::kDuplicate: return hub_->OnFragment(peer.id, now);
    case protocol::FragmentStatus::kMalformed: return metrics_->Add(Counter::kFragmentsMalformed);
    case protocol::FragmentStatus::kOverLimit: return metrics_->Add(Counter::kFragmentsRefused);
  }
}

// The shard of a session reads all its packets, so that its peer stays on one thread. A client that
// has changed its address may reach the socket of another shard.
void UdpServer::OnSealed(std::span<std::uint8_t> bytes, const udp::endpoint& sender, Time now) {
  const SecureSessions::Outcome outcome = secure_->OnDatagram(bytes, sender, shard_, now);
  const protocol::secure::ServerEvent& event = outcome.event;
  if (event.reply_size > 0) SendToStranger(event.reply(), sender);
  if (event.session == 0) return;
  ++num_of_peers_;
  if (outcome.shard != shard_) {
    return PassOn(
        outcome.shard,
        {event.session, event.closed, outcome.access, {event.inner.begin(), event.inner.end()}});
  }
  // A client may also close with its first packet.
  if (event.opened && !event.closed) {
    AddSealed(event.session, *outcome.access, sender, now);
    OnSessionPacket({event.session, false, {}, event.hello}, now);
  }
  const auto found = sealed_.find(event.session);
  if (event.closed || (outcome.access && !event.opened)) {
    OnSessionPacket({event.session, event.closed, outcome.access, {}}, now);
  } else if (found != sealed_.end() && !event.inner.empty()) {
    DeliverOpened(*found->second, event.inner, Lifetime::kBatch, now);
  }
}

void UdpServer::OnSessionPacket(const SessionPacket& packet, Time now) {
  const auto found = sealed_.find(packet.session);
  if (found == sealed_.end()) return;
  if (packet.closed) return ForgetSealed(packet.session);
  if (packet.access) hub_->SetAccess(found->second->id, *packet.access);
  if (!packet.datagram.empty()) {
    DeliverOpened(*found->second, packet.datagram, Lifetime::kCall, now);
  }
}

void UdpServer::DeliverOpened(const UdpPeer& peer, std::span<const std::uint8_t> bytes,
                              Lifetime lifetime, Time now) {
  protocol::Envelope envelope;
  if (protocol::ReadEnvelope(bytes, envelope) != protocol::EnvelopeStatus::kOk) {
    return metrics_->Add(Counter::kDatagramsMalformed);
  }
  Deliver(peer, bytes, lifetime, now);
}

void UdpServer::PassOn(int shard, SessionPacket packet) {
  constexpr int kMaxPassed = 1024;  // a thread that is behind loses datagrams, as a socket does
  UdpServer* const owner = by_shard_[static_cast<std::size_t>(shard)];
  const bool may_wait = owner->num_passed_.fetch_add(1, std::memory_order_relaxed) < kMaxPassed;
  // The end is reported once, and rights must not outlive their token, so neither may be lost.
  if (!may_wait && packet.access) {
    secure_->Close(packet.session);
    packet.closed = true;
  }
  if (!may_wait && !packet.closed) {
    owner->num_passed_.fetch_sub(1, std::memory_order_relaxed);
    return metrics_->Add(Counter::kDatagramsOverrun);
  }
  asio::post(owner->io_, [owner, packet = std::move(packet)] {
    owner->num_passed_.fetch_sub(1, std::memory_order_relaxed);
    const Hub::ShardLock lock(*owner->hub_, owner->shard_);
    owner->OnSessionPacket(packet, ReadClock());
    owner->ReleaseInTime();
  });
}

UdpServer::UdpPeer& UdpServer::AddSealed(std::uint32_t session, const Access& access,
                                         const udp::endpoint& sender, Time now) {
  try {
    UdpPeer& peer = *sealed_.emplace(session, std::make_unique<UdpPeer>(this, sender, 0, session))
                         .first->second;
    peer.id = hub_->AddPeer(Transport::kUdp,
                            LabelOf("secure udp", sender.address().to_string(), sender.port()),
                            &peer, now, shard_, access);
    peer.entry = hub_->FindPeer(peer.id);
    return peer;
  } catch (...) {
    sealed_.erase(session);
    secure_->Close(session);
    throw;
  }
}

void UdpServer::ForgetSealed(std::uint32_t session) {
  const auto found = sealed_.find(session);
  if (found == sealed_.end()) return;
  Forget(*found->second);
  sealed_.erase(found);
}

void UdpServer::ForgetClosed() {
  if (secure_ == nullptr || !secure_->HasClosed(shard_)) return;
  for (const std::uint32_t session : secure_->TakeClosed(shard_)) ForgetSealed(session);
}

UdpServer::Address UdpServer::AddressOf(const udp::endpoint& sender) {
  const protocol::secure::PeerAddress peer = ToPeerAddress(sender);
  Address address{};
  std::ranges::copy(peer.host, address.begin());
  address[16] = static_cast<std::uint8_t>(peer.port >> 8);
  address[17] = static_cast<std::uint8_t>(peer.port & 0xFF);
  return address;
}

UdpServer::UdpPeer* UdpServer::Find(const Address& address, std::uint64_t session) {
  const auto found = peers_.find(address);
  return found != peers_.end() && found->second->session == session ? found->second.get() : nullptr;
}

// Meets a stranger. Returns the new peer if the datagram proves the address, null otherwise.
UdpServer::UdpPeer* UdpServer::Receive(const Address& address, const udp::endpoint& sender,
                                       std::uint64_t session, std::span<const std::uint8_t> bytes,
                                       Time now) {
  if (reception_.Admits(address, peers_.contains(address), bytes, now)) {
    if (UdpPeer* peer = Add(address, sender, session, now); peer != nullptr) return peer;
    reception_.RefuseForLimit(bytes);
  }
  if (const auto reply = reception_.reply(); !reply.empty()) SendToStranger(reply, sender);
  return nullptr;
}

void UdpServer::SendToStranger(std::span<const std::uint8_t> bytes, const udp::endpoint& to) {
  // Each stranger has a key of its own, which no peer has.
  constexpr std::uint64_t kStranger = std::uint64_t{1} << 63;
  const auto datagram = sender_.Prepare();
  std::ranges::copy(bytes, datagram.begin());
  sender_.Commit(kStranger | num_strangers_++, to, bytes.size());
}

// Null: the host has its share of the peers.
UdpServer::UdpPeer* UdpServer::Add(const Address& address, const udp::endpoint& sender,
                                   std::uint64_t session, Time now) {
  const std::string host = HostOf(sender.address().to_string());
  std::optional<Consent> consent;
  if (const auto former = peers_.find(address); former != peers_.end()) {
    // Another program has taken over the address, or the same one after a restart. It has the place
    // of the former one, and its consent: two tokens in turn must not renew that without an answer.
    consent = hub_->ConsentOf(former->second->id);
    Forget(*former->second);
    peers_.erase(former);
  } else if (!shares_.Enter(host)) {
    metrics_->Add(Counter::kConnectionsRefused);
    return nullptr;
  }
  try {
    // On the heap, because the hub keeps its address while the map grows.
    UdpPeer& peer =
        *peers_.emplace(address, std::make_unique<UdpPeer>(this, sender, session)).first->second;
    peer.id =
        hub_->AddPeer(Transport::kUdp, LabelOf("udp", sender.address().to_string(), sender.port()),
                      &peer, now, shard_);
    peer.entry = hub_->FindPeer(peer.id);
    if (consent) hub_->SetConsent(peer.id, *consent);
    return &peer;
  } catch (...) {
    peers_.erase(address);
    shares_.Leave(host);
    throw;
  }
}

void UdpServer::Save(std::vector<SavedUdpPeer>* peers) {
  for (const auto& [address, peer] : peers_) SaveOne(*peer, peers);
  for (const auto& [session, peer] : sealed_) SaveOne(*peer, peers);
}

void UdpServer::SaveOne(const UdpPeer& peer, std::vector<SavedUdpPeer>* peers) {
  auto saved = hub_->SavePeer(peer.id);
  if (!saved) return;
  peers->push_back(peer.Saved(shard_));
  peers->back().peer = *std::move(saved);
}

PeerId UdpServer::Resume(const SavedUdpPeer& saved, std::optional<Access> access, Time now) {
  protocol::secure::PeerAddress from;
  std::copy_n(saved.address.begin(), from.host.size(), from.host.begin());
  from.port = static_cast<std::uint16_t>(saved.address[16] << 8 | saved.address[17]);
  const udp::endpoint endpoint = ToEndpoint(from, saved.is_v4, saved.scope);
  UdpPeer* peer = nullptr;
  if (access) {
    if (!sealed_.contains(saved.secure_session)) {
      peer = &AddSealed(saved.secure_session, *access, endpoint, now);
    }
  } else if (!hub_->RequiresToken() && !peers_.contains(saved.address)) {
    peer = Add(saved.address, endpoint, saved.session, now);
  }
  if (peer == nullptr) return 0;
  peer->GoOnFrom(saved);
  return peer->id;
}

// The hub first: it may use the Link until then. Messages that the sender still holds have their
// own copy of the address.
void UdpServer::Forget(const UdpPeer& peer) {
  hub_->RemovePeer(peer.id);
  reassembler_.ForgetPeer(peer.source());
}

void UdpServer::Expire(Time now) {
  // Shard locks nest, so the mutex is taken once and not once per peer.
  const Hub::ShardLock lock(*hub_, shard_);
  metrics_->Add(Counter::kFragmentsExpired, reassembler_.Expire(ToMicroseconds(now)));
  if (secure_ != nullptr && shard_ == 0) secure_->Expire(now);
  ForgetClosed();
  std::erase_if(peers_, [&](const auto& entry) {
    if (!hub_->IsIdle(entry.second->id, now)) return false;
    Forget(*entry.second);
    shares_.Leave(entry.second->host());
    return true;
  });
}

}  // namespace furrow::server
