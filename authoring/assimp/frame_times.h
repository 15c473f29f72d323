// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace furrow::authoring {

// Collects the times of a clip's frames from the keys of its joints and blend shapes.
//
// Keys that are less than 0.5 ms apart are one frame. assimp adds keys to FBX rotations that leap
// by more than 180 degrees from one key to the next. Between two frames of a dense recording, such
// a leap is only a change of sign (179 to -179 degrees), and the added keys would turn the joint
// all the way round. So times that few joints have are dropped between two frames that most joints
// have and that are at most 70 ms apart.
class FrameTimes {
 public:
  // Adds the keys of one joint or blend shape, in seconds, in any order.
  void Add(std::vector<double> seconds);

  // The frames from 0 to `end` seconds, in order. Keys outside are cut; the clip then begins at 0
  // or ends at `end`. There is at least one frame.
  [[nodiscard]] std::vector<double> Finish(double end) const;

 private:
  struct Frame {
    double seconds;
    std::size_t joints;  // with a key there
  };
  [[nodiscard]] std::vector<double> WithoutAddedKeys() const;

  std::vector<Frame> frames_;  // in order
};

}  // namespace furrow::authoring
