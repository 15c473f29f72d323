// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/body/hand_net.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/body/body_skinning.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/mesh/solid.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr int kFingers = 4;
constexpr int kRing = 8;               // points around a finger: 0 and 4 at its sides, 1 to 3 above
constexpr int kPalmRows = 7;           // from the wrist to the webs
constexpr int kAcross = 2 * kFingers;  // cells across the back of the hand
constexpr int kThumbRow = 2;           // first of the two rows with the thumb's opening
constexpr float kWristX = 0.668f;      // inside the cuff
constexpr float kWeb = 0.019f;         // from the knuckles to the webs

// A finger or thumb: positions and radii of its joints and tip, and the names of the joints.
struct Digit {
  std::array<vec3, 4> places;
  std::array<float, 4> radii;
  std::array<int, 3> joints;
};

// The last rod ends one radius before the tip, so that its round end reaches the tip.
float DigitDistance(const Digit& digit, const vec3& p) {
  float d = 1.0f;
  for (int i = 0; i < 3; ++i) {
    const vec3 end = i < 2 ? digit.places[i + 1]
                           : digit.places[3] -
                                 glm::normalize(digit.places[3] - digit.places[2]) * digit.radii[3];
    const float rod = RodDistance(p, digit.places[i], end, digit.radii[i], digit.radii[i + 1]);
    d = i == 0 ? rod : SmoothMin(d, rod, 0.004f);
  }
  return d;
}

class HandMaker {
 public:
  HandMaker(const wrinkle::Skeleton& skeleton, int panel, QuadNet* net)
      : skeleton_(skeleton),
        panel_(panel),
        net_(net),
        solid_([this](const vec3& p) { return Distance(p); }),
        wrist_(skeleton.rest_model()[skeleton.Find("hand_l")][3]) {
    constexpr std::array<float, 4> kRadii[] = {{0.0098f, 0.0088f, 0.0080f, 0.0068f},
                                               {0.0100f, 0.0090f, 0.0082f, 0.0069f},
                                               {0.0096f, 0.0085f, 0.0077f, 0.0066f},
                                               {0.0086f, 0.0075f, 0.0068f, 0.0059f}};
    const char* names[] = {"index", "middle", "ring", "little"};
    for (int i = 0; i < kFingers; ++i) {
      const std::string name = names[i];
      fingers_.push_back(MakeDigit(
          {name + "_proximal_l", name + "_intermediate_l", name + "_distal_l"}, kRadii[i]));
    }
    thumb_ = MakeDigit({"thumb_metacarpal_l", "thumb_proximal_l", "thumb_distal_l"},
                       {0.0150f, 0.0122f, 0.0102f, 0.0078f});
  }

  void Make() {
    MakePalm();
    for (int i = 0; i < kFingers; ++i) {
      std::vector<int> ring = {
          webs_[i],     top_.back()[2 * i],       top_.back()[2 * i + 1],   top_.back()[2 * i + 2],
          webs_[i + 1], under_.back()[2 * i + 2], under_.back()[2 * i + 1], under_.back()[2 * i]};
      constexpr std::pair<int, float> kStops[] = {{0, 0.66f}, {0, 0.86f}, {1, 0.0f}, {1, 0.16f},
                                                  {1, 0.5f},  {1, 0.84f}, {2, 0.0f}, {2, 0.22f},
                                                  {2, 0.62f}, {2, 0.86f}};
      MakeTube(fingers_[i], kStops, std::move(ring));
    }
    const auto side = [&](int r) { return radial_[r]; };
    const int r = kThumbRow;
    constexpr std::pair<int, float> kThumbStops[] = {{0, 0.62f}, {0, 0.84f}, {1, 0.0f}, {1, 0.18f},
                                                     {1, 0.55f}, {1, 0.85f}, {2, 0.0f}, {2, 0.25f},
                                                     {2, 0.62f}, {2, 0.86f}};
    MakeTube(thumb_, kThumbStops,
             {side(r), top_[r][0], top_[r + 1][0], top_[r + 2][0], side(r + 2), under_[r + 2][0],
              under_[r + 1][0], under_[r][0]});
    Relax(solid_, 6, net_);
    for (QuadNet::Point& point : net_->points) point.skin = Weigh(point.place);
    SmoothInfluences(1, net_);
  }

  [[nodiscard]] const Solid& solid() const { return solid_; }

 private:
  Digit MakeDigit(const std::array<std::string, 3>& names,
                  const std::array<float, 4>& radii) const {
    Digit digit;
    digit.radii = radii;
    for (int i = 0; i < 3; ++i) {
      digit.joints[i] = skeleton_.Find(names[i]);
      digit.places[i] = vec3(skeleton_.rest_model()[digit.joints[i]][3]);
    }
    digit.places[3] = digit.places[2] + skeleton_.tails()[digit.joints[2]];
    return digit;
  }

  float Distance(const vec3& p) const {
    float palm = RodDistance(p, wrist_ + vec3(-0.06f, 0, 0), wrist_, 0.0265f, 0.0235f);
    // A wrist is flatter than it is wide.
    const vec3 flat(p.x, wrist_.y + (p.y - wrist_.y) * 1.35f, p.z);
    palm = std::max(palm, RodDistance(flat, wrist_ + vec3(-0.06f, 0, 0), wrist_, 0.0265f, 0.0250f));
    float fingers = 1.0f;
    for (const Digit& finger : fingers_) {
      const vec3 carpal = wrist_ + vec3(0.012f, -0.001f, 0.36f * (finger.places[0].z - wrist_.z));
      const float bone =
          RodDistance(p, carpal, finger.places[0] + vec3(0, -0.002f, 0), 0.0165f, 0.0122f);
      palm = SmoothMin(palm, bone, 0.012f);
      fingers = std::min(fingers, DigitDistance(finger, p));
    }
    const float ball = RodDistance(p, thumb_.places[0] + vec3(0.0f, -0.002f, -0.006f),
                                   thumb_.places[1], 0.0165f, 0.0125f);
    const float heel =
        RodDistance(p, wrist_ + vec3(0.022f, -0.006f, -0.020f),
                    fingers_[3].places[0] + vec3(-0.014f, -0.005f, 0.0f), 0.0135f, 0.0125f);
    palm = SmoothMin(SmoothMin(palm, heel, 0.015f), ball, 0.018f);
    const float d = SmoothMin(palm, fingers, 0.008f);
    return SmoothMin(d, DigitDistance(thumb_, p), 0.009f);
  }

  // The end of column `k` of the back of the hand, between two fingers or at the middle of one.
  vec3 Web(int k) const {
    const auto at = [&](int i) {
      const Digit& finger = fingers_[std::clamp(i, 0, kFingers - 1)];
      return finger.places[0] + glm::normalize(finger.places[1] - finger.places[0]) * kWeb;
    };
    if (k % 2 == 1) return at(k / 2);
    if (k == 0) return at(0) + vec3(0, 0, 0.75f * fingers_[0].radii[0]);
    if (k == kAcross) return at(kFingers - 1) - vec3(0, 0, 0.75f * fingers_[3].radii[0]);
    return 0.5f * (at(k / 2 - 1) + at(k / 2));
  }

  // The palm is a box of rows from wrist to webs: rays from its middle surface up, down and to both
  // sides find the skin. The thumb's opening is left out.
  void MakePalm() {
    for (int r = 0; r <= kPalmRows; ++r) {
      const float t = static_cast<float>(r) / kPalmRows;
      std::vector<int> top, under;
      for (int k = 0; k <= kAcross; ++k) {
        const float across = 1.0f - 2.0f * static_cast<float>(k) / kAcross;
        const vec3 start(kWristX, wrist_.y, wrist_.z + 0.020f * across);
        const vec3 middle = glm::mix(start, Web(k), t);
        top.push_back(net_->AddPoint(CastOut(solid_, middle, {0, 1, 0}, 0.03f), Slack(r)));
        under.push_back(net_->AddPoint(CastOut(solid_, middle, {0, -1, 0}, 0.03f), Slack(r)));
      }
      const vec3 front = glm::mix(vec3(kWristX, wrist_.y, wrist_.z + 0.01f), Web(0), t);
      const vec3 back = glm::mix(vec3(kWristX, wrist_.y, wrist_.z - 0.01f), Web(kAcross), t);
      const bool opening = r == kThumbRow + 1;  // the thumb's opening has no side
      radial_.push_back(
          opening ? -1 : net_->AddPoint(CastOut(solid_, front, {0, 0, 1}, 0.05f), Slack(r)));
      ulnar_.push_back(net_->AddPoint(CastOut(solid_, back, {0, 0, -1}, 0.05f), Slack(r)));
      top_.push_back(std::move(top));
      under_.push_back(std::move(under));
    }
    webs_[0] = radial_.back();
    webs_[kFingers] = ulnar_.back();
    for (int i = 1; i < kFingers; ++i) {
      webs_[i] = net_->AddPoint(OnSurface(solid_, Web(2 * i) + vec3(0.003f, 0, 0)));
    }
    for (int r = 0; r < kPalmRows; ++r) {
      for (int k = 0; k < kAcross; ++k) {
        Quad(panel_, top_[r][k], top_[r + 1][k], top_[r + 1][k + 1], top_[r][k + 1]);
        Quad(panel_ + 1, under_[r][k], under_[r][k + 1], under_[r + 1][k + 1], under_[r + 1][k]);
      }
      Quad(panel_, top_[r][kAcross], top_[r + 1][kAcross], ulnar_[r + 1], ulnar_[r]);
      Quad(panel_ + 1, ulnar_[r], ulnar_[r + 1], under_[r + 1][kAcross], under_[r][kAcross]);
      if (r == kThumbRow || r == kThumbRow + 1) continue;
      Quad(panel_, radial_[r], radial_[r + 1], top_[r + 1][0], top_[r][0]);
      Quad(panel_ + 1, under_[r][0], under_[r + 1][0], radial_[r + 1], radial_[r]);
    }
  }

  // The first row is hidden in the cuff and must not move.
  static float Slack(int row) { return row == 0 ? 0.0f : 0.8f; }

  // Adds rings from `ring` to the tip. Each stop names a joint and a fraction of the way to the
  // next.
  void MakeTube(const Digit& digit, std::span<const std::pair<int, float>> stops,
                std::vector<int> ring) {
    const Solid solid = [&digit](const vec3& p) { return DigitDistance(digit, p); };
    bool first = true;
    for (const auto& [joint, share] : stops) {
      const vec3 along = glm::normalize(digit.places[joint + 1] - digit.places[joint]);
      const vec3 up = glm::normalize(vec3(0, 1, 0) - along * along.y);
      const vec3 aside = glm::cross(along, up);
      const vec3 middle = glm::mix(digit.places[joint], digit.places[joint + 1], share);
      std::vector<int> next;
      for (int k = 0; k < kRing; ++k) {
        const float turn = 2.0f * kPi * static_cast<float>(k) / kRing;
        const vec3 out = aside * std::cos(turn) + up * std::sin(turn);
        next.push_back(net_->AddPoint(CastOut(solid, middle, out, 0.03f), first ? 0.5f : 0.0f));
      }
      first = false;
      for (int k = 0; k < kRing; ++k) {
        const int after = (k + 1) % kRing;
        Quad(panel_ + (k < kRing / 2 ? 0 : 1), ring[k], next[k], next[after], ring[after]);
      }
      ring = std::move(next);
    }
    // The tip has a line from side to side; the panel of the back is above it.
    const vec3 tip = digit.places[3];
    const vec3 side = 0.5f * (net_->points[ring[0]].place - net_->points[ring[4]].place);
    const int middle = net_->AddPoint(tip);
    const int near = net_->AddPoint(OnSurface(solid, tip + 0.6f * side));
    const int far = net_->AddPoint(OnSurface(solid, tip - 0.6f * side));
    Quad(panel_, ring[0], near, ring[2], ring[1]);
    Quad(panel_, near, middle, far, ring[2]);
    Quad(panel_, ring[2], far, ring[4], ring[3]);
    Quad(panel_ + 1, ring[4], far, ring[6], ring[5]);
    Quad(panel_ + 1, far, middle, near, ring[6]);
    Quad(panel_ + 1, ring[6], near, ring[0], ring[7]);
  }

  void Quad(int panel, int a, int b, int c, int d) {
    net_->quads.push_back({Corner(panel, a), Corner(panel, b), Corner(panel, c), Corner(panel, d)});
  }

  // The two sides of the hand, from above and from below.
  int Corner(int panel, int point) {
    const auto [found, is_new] =
        corners_.emplace(std::pair(panel, point), static_cast<int>(net_->corners.size()));
    if (is_new) {
      const vec3& p = net_->points[point].place;
      net_->corners.push_back({point, panel, {p.x, panel == panel_ ? p.z : -p.z}});
    }
    return found->second;
  }

  Influences Weigh(const vec3& p) const {
    Influences skin = InfluenceOf(skeleton_, "hand_l");
    const Digit* nearest = &thumb_;
    float least = DigitDistance(thumb_, p) - 0.001f;
    for (const Digit& finger : fingers_) {
      const float d = DigitDistance(finger, p);
      if (d < least) least = d, nearest = &finger;
    }
    const bool thumb = nearest == &thumb_;
    float shares[4] = {1.0f, 0.0f, 0.0f, 0.0f};  // the hand and the digit's joints
    const float near = Smoothstep(0.014f, 0.003f, least);
    for (int i = 0; i < 3; ++i) {
      const vec3 along = glm::normalize(nearest->places[i + 1] - nearest->places[i]);
      // The blend of two joints is centred between the two bones.
      const vec3 before =
          i > 0 ? glm::normalize(nearest->places[i] - nearest->places[i - 1]) : along;
      const float past = glm::dot(p - nearest->places[i], glm::normalize(along + before));
      const float half = thumb && i == 0 ? 0.016f : 0.0075f;
      const float beyond = near * Smoothstep(-half, half, past - (thumb && i == 0 ? 0.010f : 0.0f));
      shares[i + 1] = shares[i] * beyond;
      shares[i] *= 1.0f - beyond;
    }
    // The end of the arm inside the cuff.
    const float arm = Smoothstep(0.022f, -0.014f, p.x - wrist_.x);
    skin.joints[0] = static_cast<std::uint16_t>(skeleton_.Find("hand_l"));
    skin.weights[0] = shares[0];
    for (int i = 0; i < 3; ++i) {
      skin.joints[i + 1] = static_cast<std::uint16_t>(nearest->joints[i]);
      skin.weights[i + 1] = shares[i + 1];
    }
    if (arm > 0.0f) {
      skin = InfluenceOf(skeleton_, "hand_l");
      skin.weights[0] = 1.0f - arm;
      skin.joints[1] = static_cast<std::uint16_t>(skeleton_.Find("lower_arm_l"));
      skin.weights[1] = arm;
    }
    return skin;
  }

  const wrinkle::Skeleton& skeleton_;
  int panel_;
  QuadNet* net_;
  Solid solid_;
  vec3 wrist_;
  std::vector<Digit> fingers_;
  Digit thumb_;
  std::vector<std::vector<int>> top_, under_;  // rows of the palm
  std::vector<int> radial_, ulnar_;            // its sides
  int webs_[kFingers + 1] = {};
  std::map<std::pair<int, int>, int> corners_;
};

// Mirrors the left hand to make the right hand.
void Mirror(const wrinkle::Skeleton& skeleton, QuadNet* net) {
  for (QuadNet::Point& point : net->points) {
    point.place.x = -point.place.x;
    for (std::uint16_t& joint : point.skin.joints) {
      std::string name = skeleton.joint_names()[joint];
      if (!name.ends_with("_l")) continue;
      name.back() = 'r';
      joint = static_cast<std::uint16_t>(skeleton.Find(name));
    }
  }
  for (QuadNet::Corner& corner : net->corners) corner.uv.x = -corner.uv.x;
  for (std::array<int, 4>& quad : net->quads) std::swap(quad[1], quad[3]);
}

}  // namespace

QuadNet MakeHand(const wrinkle::Skeleton& skeleton, float side, int panel, int level) {
  QuadNet net;
  HandMaker maker(skeleton, panel, &net);
  maker.Make();
  for (int i = 0; i < level; ++i) Subdivide(maker.solid(), &net);
  if (side < 0.0f) Mirror(skeleton, &net);
  return net;
}

}  // namespace furrow::authoring
