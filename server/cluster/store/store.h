// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/status.h"
#include "server/cluster/lease/lease.h"

namespace furrow::server {

// A record as it lies in the store. An empty value: it was deleted.
struct StoreRecord {
  std::string key;
  std::string value;
  Revision revision = 0;
};

// Replaces a record only if it has the revision `expected`; 0: only if there is none.
struct StorePut {
  std::uint64_t id = 0;
  std::string key;
  std::string value;
  Revision expected = 0;
};

// The answer to a StorePut.
struct StoreAnswer {
  std::uint64_t id = 0;
  WriteResult result = WriteResult::kUnknown;
  Revision revision = 0;
};

// A small key-value store that all nodes of a cluster share, with compare-and-set. Used on one
// thread, except Wake(). No function throws.
class Store {
 public:
  Store() = default;
  virtual ~Store() = default;
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  // Tries to connect, for 2 seconds at most besides the look-up of the host's name: the system
  // decides how long that takes. If the store does not answer, Poll() tries again. False: the
  // options are wrong; `why` says what.
  [[nodiscard]] virtual bool Open(std::string* why) = 0;
  // True while there is a connection. It is made again after a loss.
  [[nodiscard]] virtual bool connected() = 0;
  // True if there is no connection because the store refuses the credentials. It is asked again at
  // intervals.
  [[nodiscard]] virtual bool refuses_credentials() const { return false; }
  // Sends a write; its answer arrives by Poll(), or never.
  virtual void Put(const StorePut& put) = 0;
  // Waits up to `wait` for answers and for changed records. Without a connection, one attempt to
  // connect may come first, which takes as long as Open(). Returns false if changes may have been
  // missed, so that List() is needed.
  [[nodiscard]] virtual bool Poll(std::chrono::milliseconds wait, std::vector<StoreAnswer>* answers,
                                  std::vector<StoreRecord>* changes) = 0;
  // While there is a connection, the wait of this Poll(), or of the next one, ends within a few
  // milliseconds. Thread-safe; does not wait.
  virtual void Wake() = 0;
  // Reads all records, for less than a second. `incarnation`: another number for a store that was
  // emptied. Makes the store's bucket if there is none. False: not possible at present; `why` says
  // what is wrong.
  [[nodiscard]] virtual bool List(std::uint64_t* incarnation, std::vector<StoreRecord>* records,
                                  std::string* why) = 0;
};

// What a store needs to be reached.
struct StoreOptions {
  std::string url;     // nats://HOST:PORT or tls://HOST:PORT
  std::string bucket;  // of this cluster
  std::string node;    // the name of this node, for the server's log
  std::string user;    // empty: none
  std::string password;
  std::string credentials;  // a .creds file of NATS; empty: none
  std::string authority;    // PEM file that checks the server's certificate; empty: the system's
};

// Makes the store of NATS (JetStream's key-value buckets). The client library is a module,
// lib/furrow/furrow-nats.so beside bin/, so that daemons without a cluster need not have it. Error:
// kUnavailable (the module or its library is missing).
[[nodiscard]] Result<std::unique_ptr<Store>> MakeNatsStore(const StoreOptions& options);

// The function of the module. Starts no thread. The caller owns the result.
using MakeStore = Store* (*)(const StoreOptions& options);

}  // namespace furrow::server
