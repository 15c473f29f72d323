// SPDX-License-Identifier: Apache-2.0
#include "bench/preview/measure_preview.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include <malloc.h>
#include <turbojpeg.h>

#include "bench/preview/preview_server.h"
#include "bench/preview/viewers.h"
#include "client/load/compare/comparison.h"
#include "report/statistics.h"
#include "report/table.h"
#include "server/net/clock.h"

namespace furrow::bench {
namespace {

using report::Fixed;
using server::Counter;

constexpr double kFrame = 1.0 / PreviewServer::kRate;
constexpr int kQuality = 80;
constexpr int kWarmUp = 10;
constexpr double kSettle = 0.5;      // seconds until the state is stable
constexpr double kWatched = 2.5;     // seconds; a viewer changes to a better tier after 4 s
constexpr double kPastWindow = 0.1;  // seconds; tiers are decided once per second

using Crowd = std::vector<std::unique_ptr<Viewer>>;

Crowd MakeCrowd(const PreviewServer& house, const PreviewSetup& setting, bool acknowledged) {
  Crowd crowd;
  for (int i = 0; i < setting.viewers; ++i) {
    crowd.push_back(std::make_unique<Viewer>(house.port(), setting.picture.width,
                                             setting.picture.height, acknowledged, kQuality));
  }
  return crowd;
}

void Sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

std::string Middle(const std::vector<double>& values, int digits) {
  const load::Quartiles spread = load::QuartilesOf(values);
  return Between(spread.median, spread.low, spread.high, digits);
}

// Measures libjpeg-turbo alone, in seconds. Reuses its compressor and its memory.
class BareEncoder {
 public:
  explicit BareEncoder(const render::Image& image)
      : image_(image), bytes_(tjBufSize(image.width, image.height, TJSAMP_420)) {}
  ~BareEncoder() { tjDestroy(compressor_); }
  BareEncoder(const BareEncoder&) = delete;
  BareEncoder& operator=(const BareEncoder&) = delete;

  double Encode() {
    const server::Time begin = server::ReadClock();
    unsigned char* data = bytes_.data();
    unsigned long size = bytes_.size();
    if (tjCompress2(compressor_, image_.rgb.data(), image_.width, 0, image_.height, TJPF_RGB, &data,
                    &size, TJSAMP_420, kQuality, TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0) {
      std::fprintf(stderr, "bench_preview: %s\n", tjGetErrorStr2(compressor_));
    }
    return server::ToSeconds(server::ReadClock() - begin);
  }

 private:
  const render::Image& image_;
  std::vector<unsigned char> bytes_;
  tjhandle compressor_ = tjInitCompress();
};

// Alternates between a picture through the daemon and a picture encoded by libjpeg-turbo alone.
Aim DrawnToViewer(const PreviewSetup& setting) {
  PreviewServer house(setting.picture);
  BareEncoder bare(setting.picture);
  Viewer viewer(house.port(), setting.picture.width, setting.picture.height, false, kQuality);
  std::vector<double> bare_ms;
  std::vector<double> ms;
  std::vector<double> ratios;
  for (int round = -kWarmUp; round < setting.rounds; ++round) {
    const double packed = bare.Encode();
    house.MoveOnce();
    const server::Time received = viewer.Next().at;
    const double sent = server::ToSeconds(received - house.ready_at());
    if (round < 0) continue;
    bare_ms.push_back(packed * 1e3);
    ms.push_back(sent * 1e3);
    ratios.push_back(sent / packed);
  }
  const double median = load::QuartilesOf(ratios).median;
  return {std::to_string(setting.picture.width) + " x " + std::to_string(setting.picture.height) +
              ", quality 80: from drawn to received",
          "libjpeg-turbo alone " + Middle(bare_ms, 2) + " ms",
          Middle(ratios, 2) + "x, " + Fixed(report::Median(ms), 2) + " ms",
          "",
          "<= 1.30x",
          median <= 1.3};
}

// The subject moves once and then rests.
Aim StillAfterRest(const PreviewSetup& setting) {
  PreviewServer house(setting.picture);
  Viewer viewer(house.port(), setting.picture.width, setting.picture.height, true);
  std::vector<double> ages;
  for (int round = 0; round < setting.stills; ++round) {
    house.MoveOnce();
    Received picture;
    while (!picture.image.still) {
      picture = viewer.Next();
      viewer.Acknowledge(picture.image.number);
    }
    ages.push_back(picture.age_seconds() * 1e3);
  }
  return {"refined still after the subject came to rest",
          "at rest: 100 ms without movement",
          Middle(ages, 1) + " ms",
          "",
          "<= 150 ms",
          report::Median(ages) <= 150.0};
}

double HeapBytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// The data sent to stalled viewers that they have not read.
struct Held {
  double pictures = 0.0;  // the maximum per viewer, on the heap and in sockets
  double heap = 0.0;      // on the heap per viewer, in pictures
};

Held Stall(const PreviewSetup& setting, bool acknowledged) {
  PreviewServer house(setting.picture);
  Viewer active(house.port(), setting.picture.width, setting.picture.height, true);
  Crowd crowd = MakeCrowd(house, setting, acknowledged);
  const double before = HeapBytes();
  house.Stream(true);
  active.Watch(setting.stall_seconds);
  house.Stream(false);
  Sleep(kSettle);
  const double heap = std::max(0.0, HeapBytes() - before) / setting.viewers;
  Held held;
  double bytes = 0.0;
  double pictures = 0.0;
  for (const auto& viewer : crowd) {
    const std::vector<std::size_t> taken = viewer->DrainInFlight();
    held.pictures = std::max(held.pictures, static_cast<double>(taken.size()));
    pictures += static_cast<double>(taken.size());
    for (const std::size_t size : taken) bytes += static_cast<double>(size);
  }
  held.heap = bytes > 0.0 ? heap / (bytes / pictures) : 0.0;
  return held;
}

Aim StallMemory(const PreviewSetup& setting) {
  const Held all = Stall(setting, false);
  const Held held = Stall(setting, true);
  const auto say = [](const Held& what) {
    return Fixed(what.pictures, 0) + " pictures, including " + Fixed(what.heap, 1) + " on the heap";
  };
  return {"data held for a viewer that stalled for " + Fixed(setting.stall_seconds, 0) + " s",
          "without flow control: " + say(all),
          say(held),
          "",
          "<= 2 pictures",
          held.pictures <= 2.0 && held.heap <= 2.0};
}

// Ages in milliseconds of the third picture that each viewer reads after a stall, because two may
// have been in flight. Limit: a round trip and two frames.
struct Freshness {
  std::vector<double> ages;
  std::vector<double> limits;
  int within = 0;
};

Freshness ComeBack(const PreviewSetup& setting, bool acknowledged) {
  PreviewServer house(setting.picture);
  Crowd crowd = MakeCrowd(house, setting, acknowledged);
  house.Stream(true);
  Sleep(setting.stall_seconds);
  Freshness fresh;
  for (const auto& viewer : crowd) {
    (void)viewer->Next();
    const Received under_way = viewer->Next();
    if (acknowledged) viewer->Acknowledge(under_way.image.number);
    fresh.ages.push_back(viewer->Next().age_seconds() * 1e3);
    fresh.limits.push_back((viewer->RoundTrip() + 2.0 * kFrame) * 1e3);
    fresh.within += fresh.ages.back() <= fresh.limits.back() ? 1 : 0;
  }
  return fresh;
}

Aim FirstAfterStall(const PreviewSetup& setting) {
  const Freshness all = ComeBack(setting, false);
  const Freshness fresh = ComeBack(setting, true);
  const double limit = report::Median(fresh.limits);
  return {
      "age of the first picture drawn after a stall of " + Fixed(setting.stall_seconds, 0) + " s",
      "without flow control: " + Fixed(report::Median(all.ages), 0) + " ms",
      Middle(fresh.ages, 1) + " ms, " + std::to_string(fresh.within) + " of " +
          std::to_string(fresh.ages.size()) + " within",
      "",
      "<= " + Fixed(limit, 1) + " ms: round trip + 2 frames",
      report::Median(fresh.ages) <= limit};
}

// The cost of several viewers of one view. Each viewer first stalls for as many seconds as the tier
// that it shall fall to.
struct Shared {
  double encodes_a_picture = 0.0;
  double sent_a_picture = 0.0;
  double pictures_a_pose = 0.0;
  int most_encodes = 0;
};

Shared Look(const PreviewSetup& setting, int num_tiers) {
  PreviewServer house(setting.picture);
  Crowd crowd = MakeCrowd(house, setting, true);
  house.Stream(true);
  std::vector<std::future<void>> looking;
  const int lowest = num_tiers - 1;
  for (int i = 0; i < setting.viewers; ++i) {
    looking.push_back(std::async(std::launch::async, [&, i, viewer = crowd[i].get()] {
      const int tier = i % num_tiers;
      Sleep(tier == 0 ? 0.0 : tier + kPastWindow);
      viewer->Watch(lowest + kWatched + kSettle - tier);
    }));
  }
  Sleep(lowest + kSettle);
  const auto counts = [&] {
    return std::array{static_cast<double>(house.Count(Counter::kPicturesRendered)),
                      static_cast<double>(house.Count(Counter::kPicturesEncoded)),
                      static_cast<double>(house.Count(Counter::kPicturesSent))};
  };
  const auto before = counts();
  (void)house.TakeMostEncodes();
  Sleep(kWatched);
  const auto after = counts();
  const double pictures = std::max(1.0, after[0] - before[0]);
  const Shared shared{(after[1] - before[1]) / pictures, (after[2] - before[2]) / pictures,
                      pictures / (kWatched * PreviewServer::kRate), house.TakeMostEncodes()};
  for (auto& one : looking) one.get();
  return shared;
}

Aim Encodes(const PreviewSetup& setting, int num_tiers) {
  const Shared shared = Look(setting, num_tiers);
  const std::string viewers = std::to_string(setting.viewers) + " viewers of one view";
  return {num_tiers == 1 ? viewers + ", all at the best tier" : viewers + ", at three tiers",
          "one each: " + Fixed(shared.sent_a_picture, 1) + " encodings per picture",
          Fixed(shared.encodes_a_picture, 2) + " encodings per picture, at most " +
              std::to_string(shared.most_encodes) + "; " + Fixed(shared.pictures_a_pose, 2) +
              " pictures per pose",
          "",
          "<= " + std::to_string(num_tiers),
          shared.most_encodes <= num_tiers};
}

}  // namespace

std::vector<Aim> MeasurePreview(const PreviewSetup& setting) {
  return {DrawnToViewer(setting),
          StallMemory(setting),
          FirstAfterStall(setting),
          Encodes(setting, 1),
          Encodes(setting, server::ViewerFlow::kNumTiers),
          StillAfterRest(setting)};
}

}  // namespace furrow::bench
