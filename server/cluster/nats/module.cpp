// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <nats/nats.h>

#include "server/cluster/store/store.h"

namespace furrow::server {
namespace {

using std::chrono::milliseconds;

template <auto kDestroy>
struct Deleter {
  template <class T>
  void operator()(T* object) const {
    kDestroy(object);
  }
};
using Options = std::unique_ptr<natsOptions, Deleter<natsOptions_Destroy>>;
using Connection = std::unique_ptr<natsConnection, Deleter<natsConnection_Destroy>>;
using Subscription = std::unique_ptr<natsSubscription, Deleter<natsSubscription_Destroy>>;
using Message = std::unique_ptr<natsMsg, Deleter<natsMsg_Destroy>>;
using Context = std::unique_ptr<jsCtx, Deleter<jsCtx_Destroy>>;
using StreamInfo = std::unique_ptr<jsStreamInfo, Deleter<jsStreamInfo_Destroy>>;
using Bucket = std::unique_ptr<kvStore, Deleter<kvStore_Destroy>>;
using Watcher = std::unique_ptr<kvWatcher, Deleter<kvWatcher_Destroy>>;
using Entry = std::unique_ptr<kvEntry, Deleter<kvEntry_Destroy>>;

// A server that answers no ping for about twice this time is gone.
constexpr std::int64_t kPingMs = 400;
constexpr std::int64_t kReconnectMs = 250;
constexpr std::int64_t kConnectMs = 1000;
constexpr std::int64_t kRequestMs = 400;
// Between attempts at a server that refuses the credentials.
constexpr milliseconds kRefusedPause(5000);
// Reading everything must end before the leases do.
constexpr milliseconds kListTime(700);
// How often the stream is compared with what was heard of it: a watcher may die without a word.
constexpr milliseconds kCheckPause(1000);
// Records of nodes and subjects that are gone. Far above every time of a lease, and the epochs of
// subjects that left are remembered for it.
constexpr std::int64_t kRecordLifeNs = std::int64_t{600} * 1'000'000'000;
constexpr std::size_t kMaxBucketBytes = 64 << 20;
constexpr int kMaxValueBytes = 1024;
// What one call of Poll() takes, so that a flood does not keep the leases from being renewed. What
// is left comes with the next call.
constexpr int kMostAtOnce = 10'000;
constexpr milliseconds kPollTime(100);
constexpr milliseconds kWakeTime(10);  // until Wake() is noticed, at about 0.5% of a core
// Answers that wait to be read. The library drops more, and a write without an answer is unknown.
constexpr int kMaxWaiting = 65'536;
constexpr int kMaxWaitingBytes = 16 << 20;
constexpr int kWrongLastSequence = 10071;  // err_code of JetStream

using Clock = std::chrono::steady_clock;

// The number after `"key":` in a small JSON text of the server; 0 if there is none.
std::uint64_t NumberAfter(std::string_view text, std::string_view key) {
  std::size_t at = text.find(key);
  if (at == std::string_view::npos) return 0;
  at = std::min(text.find_first_not_of(" :", at + key.size()), text.size());
  std::uint64_t number = 0;
  (void)std::from_chars(text.data() + at, text.data() + text.size(), number);
  return number;
}

std::size_t BytesOf(const StoreRecord& record) {
  return sizeof(record) + record.key.size() + record.value.size();
}

// The state of a connection. Changed by threads of the library, which may call after the connection
// has been closed.
struct Link {
  std::atomic<bool> connected = false;
  std::atomic<bool> refused = false;  // the credentials, which closed the connection
  std::atomic<bool> closed = false;   // changes last: the library calls no more
};

// Lets the library report changes of its connection to `link`.
natsStatus FollowConnection(natsOptions* options, Link* link) {
  const natsConnectionHandler up = [](natsConnection*, void* of) {
    static_cast<Link*>(of)->connected = true;
  };
  const natsConnectionHandler down = [](natsConnection*, void* of) {
    static_cast<Link*>(of)->connected = false;
  };
  const natsConnectionHandler closed = [](natsConnection* connection, void* of) {
    const char* text = nullptr;
    const natsStatus last = natsConnection_GetLastError(connection, &text);
    static_cast<Link*>(of)->connected = false;
    static_cast<Link*>(of)->refused = last == NATS_CONNECTION_AUTH_FAILED;
    static_cast<Link*>(of)->closed = true;
  };
  natsStatus status = natsOptions_SetReconnectedCB(options, up, link);
  if (status == NATS_OK) status = natsOptions_SetDisconnectedCB(options, down, link);
  if (status == NATS_OK) status = natsOptions_SetClosedCB(options, closed, link);
  return status;
}

class NatsStore : public Store {
 public:
  explicit NatsStore(const StoreOptions& options)
      : options_(options), bucket_name_(options.bucket), stream_("KV_" + options.bucket) {}

  ~NatsStore() override;

  bool Open(std::string* why) override;
  // The library locks the connection while it tries to connect, so its status cannot be asked.
  bool connected() override { return link_->connected; }
  bool refuses_credentials() const override { return link_->refused && !link_->connected; }
  void Put(const StorePut& put) override;
  bool Poll(milliseconds wait, std::vector<StoreAnswer>* answers,
            std::vector<StoreRecord>* changes) override;
  void Wake() override { woken_ = true; }
  bool List(std::uint64_t* incarnation, std::vector<StoreRecord>* records,
            std::string* why) override;

 private:
  void DropConnection();
  void OpenAgain();
  natsStatus PrepareAnswers();
  void TakeAnswers(Clock::time_point until, std::vector<StoreAnswer>* answers);
  natsStatus PrepareBucket(StreamInfo* info);
  natsStatus GetInfo(StreamInfo* info);
  bool IsComplete();
  // Ends the watcher at the next listing: its end waits for a server, which may not answer.
  void RetireWatcher() {
    if (watcher_ != nullptr) retired_.push_back(std::move(watcher_));
  }
  void TakeAnswer(const Message& message, std::vector<StoreAnswer>* answers) const;
  void TakeEntry(const Entry& entry, std::vector<StoreRecord>* records);

  const StoreOptions options_;
  const std::string bucket_name_;
  const std::string stream_;
  std::unique_ptr<Link> link_ = std::make_unique<Link>();
  std::atomic<bool> woken_ = false;
  Clock::time_point tried_{};  // the end of the last attempt
  Connection connection_;
  Context context_;
  Bucket bucket_;
  Watcher watcher_;
  std::vector<Watcher> retired_;
  std::string inbox_;  // where answers arrive: inbox_ + the number of the write
  Subscription answers_;
  std::uint64_t heard_ = 0;     // the highest revision of a record that was read
  std::uint64_t expected_ = 0;  // of the stream at the last check
  std::int64_t created_ = 0;    // of the stream at the last listing
  Clock::time_point checked_{};
};

// The call that says that the connection is closed is the last one of the library. If it does not
// come, a few bytes are left behind for it.
NatsStore::~NatsStore() { DropConnection(); }

void NatsStore::DropConnection() {
  watcher_.reset();
  retired_.clear();
  answers_.reset();
  bucket_.reset();
  context_.reset();
  if (connection_ == nullptr) return;
  natsConnection_Close(connection_.get());
  const auto deadline = Clock::now() + milliseconds(kConnectMs);
  while (!link_->closed && Clock::now() < deadline) nats_Sleep(5);
  if (!link_->closed) (void)link_.release();
  connection_.reset();
}

// The library connects again once it was connected. It gives up after two refusals. The
// administrator may accept the credentials later, so this function tries again. It also repeats the
// first connection: if the library did, it would not say that the credentials were refused.
void NatsStore::OpenAgain() {
  if (!link_->closed) return;
  const milliseconds pause = link_->refused ? kRefusedPause : milliseconds(kReconnectMs);
  if (Clock::now() - tried_ < pause) return;
  DropConnection();
  link_ = std::make_unique<Link>();
  std::string unused;  // such as a file that cannot be read now; the next attempt may find it
  if (!Open(&unused)) link_->closed = true;
}

bool NatsStore::Open(std::string* why) {
  natsOptions* raw = nullptr;
  natsStatus status = natsOptions_Create(&raw);
  const Options settings(raw);
  const auto set = [&status](natsStatus next) {
    if (status == NATS_OK) status = next;
  };
  if (status == NATS_OK) {
    set(natsOptions_SetURL(raw, options_.url.c_str()));
    set(natsOptions_SetName(raw, ("furrowd " + options_.node).c_str()));
    set(natsOptions_SetAllowReconnect(raw, true));
    set(natsOptions_SetMaxReconnect(raw, -1));
    set(natsOptions_SetReconnectWait(raw, kReconnectMs));
    set(natsOptions_SetTimeout(raw, kConnectMs));
    set(natsOptions_SetPingInterval(raw, kPingMs));
    set(natsOptions_SetMaxPingsOut(raw, 2));
    // A write that waited for a connection would come too late.
    set(natsOptions_SetReconnectBufSize(raw, 1));
    set(natsOptions_SetSendAsap(raw, true));
    // A server that reads nothing must not hold the thread for ever.
    set(natsOptions_SetWriteDeadline(raw, kRequestMs));
    set(FollowConnection(raw, link_.get()));
    if (!options_.user.empty()) {
      set(natsOptions_SetUserInfo(raw, options_.user.c_str(), options_.password.c_str()));
    }
    if (!options_.credentials.empty()) {
      set(natsOptions_SetUserCredentialsFromFiles(raw, options_.credentials.c_str(), nullptr));
    }
    if (options_.url.starts_with("tls://")) {
      set(natsOptions_SetSecure(raw, true));
      const std::string host = options_.url.substr(6, options_.url.rfind(':') - 6);
      set(natsOptions_SetExpectedHostname(raw, host.c_str()));
      if (!options_.authority.empty()) {
        set(natsOptions_LoadCATrustedCertificates(raw, options_.authority.c_str()));
      }
    }
  }
  natsConnection* connection = nullptr;
  if (status == NATS_OK) {
    link_->connected = true;  // before threads of the library may say otherwise
    const natsStatus result = natsConnection_Connect(&connection, raw);
    connection_.reset(connection);
    if (result != NATS_OK) {
      link_->connected = false;
      link_->refused = result == NATS_CONNECTION_AUTH_FAILED;
      link_->closed = true;
    }
    if (result == NATS_INVALID_ARG) status = result;  // which another attempt does not change
  }
  // The pause follows the attempt, which may take longer than the pause.
  tried_ = Clock::now();
  if (status != NATS_OK) *why = natsStatus_GetText(status);
  return status == NATS_OK;
}

natsStatus NatsStore::PrepareAnswers() {
  if (answers_ != nullptr) return NATS_OK;
  natsInbox* inbox = nullptr;
  natsStatus status = natsInbox_Create(&inbox);
  if (status != NATS_OK) return status;
  inbox_ = std::string(inbox) + ".";
  natsInbox_Destroy(inbox);
  natsSubscription* subscription = nullptr;
  status = natsConnection_SubscribeSync(&subscription, connection_.get(), (inbox_ + "*").c_str());
  answers_.reset(subscription);
  if (status != NATS_OK) return status;
  return natsSubscription_SetPendingLimits(subscription, kMaxWaiting, kMaxWaitingBytes);
}

natsStatus NatsStore::GetInfo(StreamInfo* info) {
  jsStreamInfo* found = nullptr;
  const natsStatus status =
      js_GetStreamInfo(&found, context_.get(), stream_.c_str(), nullptr, nullptr);
  info->reset(found);
  return status;
}

// The first node makes the bucket. An operator may have made another one, on disk or on
// several servers.
natsStatus NatsStore::PrepareBucket(StreamInfo* info) {
  natsStatus status = NATS_OK;
  if (context_ == nullptr) {
    jsOptions options;
    jsOptions_Init(&options);
    options.Wait = kRequestMs;
    jsCtx* context = nullptr;
    status = natsConnection_JetStream(&context, connection_.get(), &options);
    context_.reset(context);
    if (status != NATS_OK) return status;
  }
  status = GetInfo(info);
  if (status == NATS_NOT_FOUND) {
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = bucket_name_.c_str();
    config.Description = "leases of a Furrow cluster";
    config.MaxValueSize = kMaxValueBytes;
    config.History = 1;
    config.TTL = kRecordLifeNs;
    config.MaxBytes = static_cast<std::int64_t>(kMaxBucketBytes);
    config.StorageType = js_MemoryStorage;
    config.Replicas = 1;
    kvStore* made = nullptr;
    status = js_CreateKeyValue(&made, context_.get(), &config);
    bucket_.reset(made);
    if (status == NATS_OK) status = GetInfo(info);
  }
  if (status != NATS_OK || bucket_ != nullptr) return status;
  kvStore* bucket = nullptr;
  status = js_KeyValue(&bucket, context_.get(), bucket_name_.c_str());
  bucket_.reset(bucket);
  return status;
}

void NatsStore::Put(const StorePut& put) {
  if (answers_ == nullptr || !connected()) return;
  natsMsg* raw = nullptr;
  const std::string subject = "$KV." + bucket_name_ + "." + put.key;
  const std::string reply = inbox_ + std::to_string(put.id);
  if (natsMsg_Create(&raw, subject.c_str(), reply.c_str(), put.value.data(),
                     static_cast<int>(put.value.size())) != NATS_OK) {
    return;
  }
  const Message message(raw);
  if (natsMsgHeader_Set(raw, "Nats-Expected-Last-Subject-Sequence",
                        std::to_string(put.expected).c_str()) == NATS_OK) {
    (void)natsConnection_PublishMsg(connection_.get(), raw);  // without an answer it is unknown
  }
}

void NatsStore::TakeAnswer(const Message& message, std::vector<StoreAnswer>* answers) const {
  const std::string_view subject = natsMsg_GetSubject(message.get());
  const std::string_view text(natsMsg_GetData(message.get()),
                              static_cast<std::size_t>(natsMsg_GetDataLength(message.get())));
  StoreAnswer answer;
  if (!subject.starts_with(inbox_)) return;
  const std::string_view id = subject.substr(inbox_.size());
  (void)std::from_chars(id.data(), id.data() + id.size(), answer.id);
  answer.revision = NumberAfter(text, "\"seq\"");
  if (text.find("\"error\"") != std::string_view::npos) {
    const bool refused = NumberAfter(text, "\"err_code\"") == kWrongLastSequence;
    answer.result = refused ? WriteResult::kRefused : WriteResult::kUnknown;
  } else if (answer.revision != 0) {
    answer.result = WriteResult::kDone;
  }
  answers->push_back(answer);
}

void NatsStore::TakeEntry(const Entry& entry, std::vector<StoreRecord>* records) {
  kvEntry* const raw = entry.get();
  StoreRecord record{.key = kvEntry_Key(raw), .value = {}, .revision = kvEntry_Revision(raw)};
  heard_ = std::max(heard_, record.revision);
  const int size = kvEntry_ValueLen(raw);
  if (kvEntry_Operation(raw) == kvOp_Put && size > 0 && size <= kMaxValueBytes) {
    record.value.assign(static_cast<const char*>(kvEntry_Value(raw)),
                        static_cast<std::size_t>(size));
  }
  records->push_back(std::move(record));
}

// Waits until there is an answer, and takes all that are there. Nothing but a message ends a wait
// of the library, so Wake() ends one of the short waits of which this one consists.
void NatsStore::TakeAnswers(Clock::time_point until, std::vector<StoreAnswer>* answers) {
  while (!woken_.exchange(false) && answers->empty()) {
    const auto left = std::chrono::ceil<milliseconds>(until - Clock::now());
    if (left.count() <= 0) break;
    natsMsg* raw = nullptr;
    const natsStatus status =
        natsSubscription_NextMsg(&raw, answers_.get(), std::min(left, kWakeTime).count());
    if (status == NATS_OK) {
      TakeAnswer(Message(raw), answers);
    } else if (status != NATS_TIMEOUT) {  // such as a closed connection, which returns at once
      nats_Sleep(left.count());
      break;
    }
  }
  natsMsg* raw = nullptr;
  for (int taken = 0;
       taken < kMostAtOnce && natsSubscription_NextMsg(&raw, answers_.get(), 0) == NATS_OK;
       ++taken) {
    TakeAnswer(Message(raw), answers);
  }
}

bool NatsStore::Poll(milliseconds wait, std::vector<StoreAnswer>* answers,
                     std::vector<StoreRecord>* changes) {
  if (!connected()) OpenAgain();
  if (answers_ == nullptr || !connected()) {
    nats_Sleep(wait.count());
    return false;
  }
  TakeAnswers(Clock::now() + wait, answers);
  if (watcher_ == nullptr) return false;
  kvEntry* entry = nullptr;
  const auto end = Clock::now() + kPollTime;
  for (int taken = 0; taken < kMostAtOnce && Clock::now() < end &&
                      kvWatcher_Next(&entry, watcher_.get(), 1) == NATS_OK && entry != nullptr;
       ++taken) {
    TakeEntry(Entry(entry), changes);
  }
  return IsComplete();
}

// A watcher that has not heard of what was there a second ago hears nothing any more. A stream that
// was made later is another one.
bool NatsStore::IsComplete() {
  const auto now = Clock::now();
  if (now - checked_ < kCheckPause) return true;
  checked_ = now;
  StreamInfo info;
  if (GetInfo(&info) != NATS_OK || info->Created != created_) return false;
  const bool complete = heard_ >= expected_;
  expected_ = info->State.LastSeq;
  return complete;
}

bool NatsStore::List(std::uint64_t* incarnation, std::vector<StoreRecord>* records,
                     std::string* why) {
  const auto deadline = Clock::now() + kListTime;
  StreamInfo info;
  natsStatus status = PrepareAnswers();
  if (status == NATS_OK) status = PrepareBucket(&info);
  RetireWatcher();
  kvWatcher* watcher = nullptr;
  if (status == NATS_OK) {
    retired_.clear();
    status = kvStore_WatchAll(&watcher, bucket_.get(), nullptr);
  }
  watcher_.reset(watcher);
  heard_ = 0;
  std::size_t bytes = 0;
  while (status == NATS_OK) {
    const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
    kvEntry* entry = nullptr;
    status =
        left.count() <= 0 ? NATS_TIMEOUT : kvWatcher_Next(&entry, watcher_.get(), left.count());
    if (status == NATS_OK && entry == nullptr) break;  // the end of what was there
    if (status == NATS_OK) TakeEntry(Entry(entry), records);
    if (status == NATS_OK) bytes += BytesOf(records->back());
    if (bytes > 2 * kMaxBucketBytes) status = NATS_INSUFFICIENT_BUFFER;
  }
  // The stream may have been made again while it was read.
  StreamInfo after;
  if (status == NATS_OK) status = GetInfo(&after);
  if (status == NATS_OK && after->Created != info->Created) status = NATS_TIMEOUT;
  if (status != NATS_OK) {
    *why = natsStatus_GetText(status);
    RetireWatcher();
    return false;
  }
  created_ = info->Created;
  expected_ = 0;
  heard_ = std::max(heard_, after->State.LastSeq);
  *incarnation = static_cast<std::uint64_t>(info->Created);
  return true;
}

}  // namespace
}  // namespace furrow::server

// Where store.h looks for it (MakeStore).
extern "C" __attribute__((visibility("default"))) furrow::server::Store* FurrowNatsStore(
    const furrow::server::StoreOptions& options) {
  return new furrow::server::NatsStore(options);
}
