// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "server/core/time.h"

namespace furrow::server {

// The bit rate of one viewer's video, from the acknowledgements of its pictures. It falls at once
// and rises slowly. The caller supplies the time.
//
// The trip of a picture is the time until its acknowledgement, less the time that the viewer kept
// it. A picture is late if its trip is kPatience longer than the shortest one of the last half
// minute. Late pictures come as fast as the network carries them, so three of them in a row, or two
// that take very long, set the rate to a share of that.
//
// A lowering is on trial: if the next pictures are as late as before, the delay has another reason,
// such as a busy machine. Then the former rate returns, and the delay counts as normal for a while.
class VideoRate {
 public:
  static constexpr int kMinKbps = 150;
  static constexpr int kStartKbps = 2'500;
  static constexpr int kMaxKbps = 20'000;
  static constexpr Time kPatience = FromSeconds(0.03);

  // A picture was sent. Numbers count up by one and wrap around.
  void Sent(std::uint32_t number, std::size_t bytes, Time now);
  // The viewer has shown this picture and all before it. `held`: how long it kept the picture, as
  // it says, so that its own slowness does not count.
  void Acknowledged(std::uint32_t number, Time held, Time now);

  [[nodiscard]] int kbps() const { return static_cast<int>(kbps_); }
  // The bits that a picture may have at the present rate of pictures.
  [[nodiscard]] int PictureBits() const;

 private:
  struct Picture {
    std::uint32_t number = 0;
    double bits = 0.0;
    Time sent{0};
  };
  static constexpr std::size_t kMaxUnderWay = 4;

  void Learn(double trip_s, Time now);
  void Judge(const Picture& picture, double excess_s, Time now);
  void Lower(double carried_kbps, Time now);
  void JudgeLowering();
  void Raise(Time now);
  [[nodiscard]] double SentKbps() const { return picture_bits_ / interval_s_ / 1e3; }

  double kbps_ = kStartKbps;
  std::array<Picture, kMaxUnderWay> under_way_;
  std::size_t num_under_way_ = 0;
  bool has_sent_ = false;
  std::uint32_t last_number_ = 0;
  Time last_sent_{0};
  double picture_bits_ = 0.0;       // mean of the last pictures
  double interval_s_ = 1.0 / 30.0;  // mean between two pictures, while they are not late

  // The shortest trip of this quarter of a minute and of the one before.
  bool has_trip_ = false;
  double shortest_s_ = 0.0;
  double former_shortest_s_ = 0.0;
  Time quarter_{0};
  double normal_s_ = 0.0;  // excess that proved to be no lack of bits per second

  // The late pictures in a row since the last change of the rate.
  std::uint32_t decides_from_ = 0;  // pictures before this one were sent at the former rate
  double excess_s_ = 0.0;           // of the last picture
  int late_ = 0;
  Time late_since_{0};
  double late_bits_ = 0.0;
  double late_excess_s_ = 0.0;  // sum

  // The last lowering, and its trial.
  bool is_on_trial_ = false;
  double kbps_before_ = 0.0;
  double returns_to_kbps_ = 0.0;
  bool has_lowered_ = false;
  Time lowered_{0};
  double excess_before_s_ = 0.0;
  double trial_excess_s_ = 0.0;  // sum
  int num_trial_ = 0;

  bool has_acknowledgement_ = false;
  Time last_acknowledged_{0};
};

}  // namespace furrow::server
