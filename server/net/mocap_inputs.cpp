// SPDX-License-Identifier: Apache-2.0
#include "server/net/mocap_inputs.h"

#include "protocol/mocap/livelink_face.h"
#include "protocol/mocap/vmc.h"

namespace furrow::server {

namespace {

// ValidateConfig() has checked that all addresses are numeric, so make_address() does not throw.
std::vector<asio::ip::address> Addresses(const std::vector<std::string>& texts) {
  std::vector<asio::ip::address> addresses;
  for (const std::string& text : texts) addresses.push_back(asio::ip::make_address(text));
  return addresses;
}

// VMC does not name its sender, so only one may hold the port. Live Link Face names the device in
// each packet, so several may send at once.
constexpr auto kOfVmc = SenderGate::Policy::kOne;
constexpr auto kOfLiveLinkFace = SenderGate::Policy::kAllAllowed;

}  // namespace

Status MocapInputs::Open(const Options& options, asio::io_context& io, Hub* hub, Metrics* metrics) {
  const auto address = Addresses({options.bind}).front();
  const std::vector<asio::ip::address> allowed = Addresses(options.allow);
  if (options.vmc) {
    vmc_ = std::make_unique<MocapInput>(io, "--vmc", protocol::mocap::MakeVmcAdapter(),
                                        SenderGate(allowed, kOfVmc), hub, metrics);
    FURROW_RETURN_IF_ERROR(vmc_->Open({address, *options.vmc}));
  }
  if (options.livelink_face) {
    livelink_face_ = std::make_unique<MocapInput>(
        io, "--livelink-face", protocol::mocap::MakeLiveLinkFaceAdapter(),
        SenderGate(allowed, kOfLiveLinkFace), hub, metrics);
    return livelink_face_->Open({address, *options.livelink_face});
  }
  return {};
}

void MocapInputs::SetAllowed(const std::vector<std::string>& allow) {
  const std::vector<asio::ip::address> allowed = Addresses(allow);
  if (vmc_) vmc_->SetGate(SenderGate(allowed, kOfVmc));
  if (livelink_face_) livelink_face_->SetGate(SenderGate(allowed, kOfLiveLinkFace));
}

Status MocapInputs::Give(bool vmc, const std::string& sender, Time now) {
  MocapInput* const input = vmc ? vmc_.get() : livelink_face_.get();
  if (input != nullptr) return input->Give(sender, now);
  return {StatusCode::kUnavailable, std::string(vmc ? "--vmc" : "--livelink-face") + " is off",
          "input"};
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
