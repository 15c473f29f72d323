// SPDX-License-Identifier: Apache-2.0
#include "server/config/config.h"

#include <asio/ip/address.hpp>

namespace furrow::server {

motion::LoadOptions ReadOptions(const Config& config) {
  motion::LoadOptions options;
  options.bvh_positions =
      motion::ParseBvhPositions(config.bvh_positions).value_or(motion::BvhPositions::kAuto);
  options.up_axis = motion::ParseUpAxis(config.up_axis).value_or(motion::UpAxis::kAuto);
  return options;
}

motion::LoadOptions PlayOptions(const Config& config) {
  motion::LoadOptions options = ReadOptions(config);
  options.rest_frame = config.rest_frame;
  return options;
}

bool ListensToNetwork(const Config& config) {
  asio::error_code error;
  const auto address = asio::ip::make_address(config.bind, error);
  return !error && !address.is_loopback();
}

}  // namespace furrow::server
