// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <vector>

#include "base/status.h"
#include "server/core/file_watch.h"
#include "server/tls/handshake_places.h"
#include "server/tls/tls_context.h"
#include "server/tls/tls_files.h"

namespace furrow::server {

// Notice changes of the files. Made before the files are read, they miss none.
using TlsWatches = std::vector<FileWatch>;
[[nodiscard]] TlsWatches WatchTlsFiles(const TlsFiles& files);

// The certificate and key of a running daemon, read again when the files change. Connections that
// are open keep what they began with. Load(), Replace() and ReadIfChanged() belong to one thread;
// the other functions are thread-safe.
class TlsIdentity {
 public:
  explicit TlsIdentity(TlsFiles files);

  // Reads the files, if there are any. Errors: those of LoadTlsContexts().
  [[nodiscard]] Status Load();
  // Uses these contexts, which were read from `files`, for connections from now on. Precondition:
  // the files are for the same kind of service: enabled() and asks_clients() do not change.
  // `watches`: WatchTlsFiles(files), from before they were read.
  void Replace(TlsFiles files, TlsWatches watches, TlsContexts contexts);
  // Reads files that have changed. Call it about once per second. A change counts when a second
  // passes without another one, because certificate and key are written one after the other.
  // Files that cannot be used change nothing; the fault is logged once per change.
  void ReadIfChanged();

  // False: the ports speak plain TCP and HTTP.
  [[nodiscard]] bool enabled() const { return enabled_; }
  // True: clients must show a certificate.
  [[nodiscard]] bool asks_clients() const { return asks_clients_; }
  // The present contexts, with which new connections begin. Only if enabled().
  [[nodiscard]] TlsContext for_messages() const;
  [[nodiscard]] TlsContext for_web() const;
  // The places for the strangers of all ports. Thread-safe.
  [[nodiscard]] const HandshakePlaces& places() const { return places_; }
  [[nodiscard]] HandshakePlaces& places() { return places_; }

 private:
  [[nodiscard]] bool FilesChanged();
  void Use(TlsContexts contexts);

  TlsFiles files_;  // of the thread of Load()
  const bool enabled_;
  const bool asks_clients_;
  TlsWatches watches_;
  bool changed_ = false;  // and not read yet
  mutable std::mutex mutex_;
  TlsContexts contexts_;  // guarded by mutex_
  HandshakePlaces places_;
};

}  // namespace furrow::server
