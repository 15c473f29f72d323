// SPDX-License-Identifier: Apache-2.0
#include "server/net/mocap_inputs.h"

#include "protocol/mocap/livelink_face.h"
#include "protocol/mocap/vmc.h"

namespace furrow::server {

Status MocapInputs::Open(const Options& options, asio::io_context& io, Hub* hub, Metrics* metrics) {
  // ValidateConfig() has checked that all addresses are numeric, so make_address() does not throw.
  const auto address = asio::ip::make_address(options.bind);
  std::vector<asio::ip::address> allowed;
  for (const std::string& text : options.allow) {
    allowed.push_back(asio::ip::make_address(text));
  }
  if (options.vmc) {
    // VMC does not name its sender, so only one may hold the port.
    vmc_ =
        std::make_unique<MocapInput>(io, "--vmc", protocol::mocap::MakeVmcAdapter(),
                                     SenderGate(allowed, SenderGate::Policy::kOne), hub, metrics);
    FURROW_RETURN_IF_ERROR(vmc_->Open({address, *options.vmc}));
  }
  if (options.livelink_face) {
    // Live Link Face names the device in each packet, so several may send at once.
    livelink_face_ = std::make_unique<MocapInput>(
        io, "--livelink-face", protocol::mocap::MakeLiveLinkFaceAdapter(),
        SenderGate(allowed, SenderGate::Policy::kAllAllowed), hub, metrics);
    return livelink_face_->Open({address, *options.livelink_face});
  }
  return {};
}

void MocapInputs::Start() {
  if (vmc_) vmc_->Start();
  if (livelink_face_) livelink_face_->Start();
}

void MocapInputs::Tick(Time now) {
  if (vmc_) vmc_->Tick(now);
  if (livelink_face_) livelink_face_->Tick(now);
}

void MocapInputs::Close() {
  if (vmc_) vmc_->Close();
  if (livelink_face_) livelink_face_->Close();
}

}  // namespace furrow::server
