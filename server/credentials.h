// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"
#include "protocol/secure/token/key_ring.h"
#include "server/config/config.h"
#include "server/core/metrics.h"
#include "server/net/udp/secure_sessions.h"
#include "server/reload.h"
#include "server/session/access/key_file.h"
#include "server/session/access/token_gate.h"
#include "server/tls/tls_identity.h"

namespace furrow::server {

// The keys of a daemon, with all that they open, and its certificate. Belongs to the main thread;
// the parts that it hands out say what other threads may do with them.
class Credentials {
 public:
  // `metrics`: not null; outlives this object.
  Credentials(const Config& config, Metrics* metrics);

  // Reads the files that the configuration names. Errors: those of KeyFile::Load() and of
  // TlsIdentity::Load().
  [[nodiscard]] Status Load();
  // Reads files that have changed. Call it about once per second.
  void ReadIfChanged();
  // Uses what the reload has read.
  void TakeOver(Reload* reload);

  [[nodiscard]] const TokenGate& gate() const { return gate_; }
  [[nodiscard]] SecureSessions* secure() { return &secure_; }
  [[nodiscard]] const TlsIdentity& tls() const { return tls_; }

 private:
  void SetLimits(const Limits& limits);
  void SetKeys(protocol::secure::KeyRing keys);

  TokenGate gate_;
  SecureSessions secure_;
  KeyFile keys_file_;
  TlsIdentity tls_;
};

}  // namespace furrow::server
