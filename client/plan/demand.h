// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::plan {

// The demand on all daemons together. All performers are alike.
struct Demand {
  double performers = 0.0;
  int joints = 51;
  int blend_shapes = 0;
  int weights = 37;        // the default character has 97
  double rate = 60.0;      // poses per second of a performer
  int subscribers = 1;     // of a performer's weights
  bool floats = false;     // poses and blend shapes as floats; else packed
  bool u8 = false;         // weights of 8 bits
  bool is_sealed = false;  // UDP with connect tokens
  // Viewers of pictures with skin shading, each with its own camera.
  double viewers = 0.0;
  int width = 1280;
  int height = 720;
  double picture_rate = 30.0;
};

// One of the machines that serve the demand.
struct Machine {
  int cores = 8;
  double gigabits = 10.0;  // of its network link, per second and direction
  // The share of a core and of the link that is planned for. Above about 0.7, latency grows first
  // and loss follows.
  double load = 0.7;
  int spares = 1;  // machines that may fail at a time
};

}  // namespace furrow::plan
