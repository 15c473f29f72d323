// SPDX-License-Identifier: Apache-2.0
#include "toy_folder.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <vector>

#include <glm/vec3.hpp>

namespace furrow::authoring {
namespace {

constexpr int kColumns = 24;
constexpr int kRows = 16;

struct ToyJoint {
  std::string name;
  std::string parent;
  glm::vec3 head;
  glm::vec3 tail;
};

// Joints in decimetres. The face lies on a ball of radius 1 around (0, 3, 0).
std::vector<ToyJoint> ToyJoints() {
  std::vector<ToyJoint> joints{
      {"root", "", {0, 1, 0}, {0, 2, 0}},
      {"head", "root", {0, 2.2f, 0}, {0, 4, 0}},
      {"special03", "head", {0, 2.5f, 0.3f}, {0, 2.9f, 1.05f}},
      {"special04", "head", {0, 2.2f, 0.5f}, {0, 2.25f, 0.75f}},
      {"oris05", "head", {0, 2.7f, 0.95f}, {0, 2.62f, 0.98f}},
      {"oris01", "head", {0, 2.42f, 0.9f}, {0, 2.54f, 0.96f}},
  };
  for (const float side : {1.0f, -1.0f}) {
    const std::string s = side > 0 ? ".L" : ".R";
    const auto add = [&](const char* name, glm::vec3 head, glm::vec3 tail) {
      head.x *= side;
      tail.x *= side;
      joints.push_back({name + s, "head", head, tail});
    };
    add("oculi01", {0.34f, 3.35f, 0.87f}, {0.15f, 3.36f, 0.92f});
    add("oculi02", {0.55f, 3.2f, 0.8f}, {0.34f, 3.35f, 0.87f});
    add("temporalis01", {0.8f, 3.2f, 0.5f}, {0.6f, 3.2f, 0.7f});
    add("eye", {0.31f, 3.1f, 0.7f}, {0.31f, 3.1f, 1.0f});
    add("orbicularis04", {0.31f, 3.1f, 0.7f}, {0.31f, 3.0f, 0.95f});
    add("levator02", {0.03f, 3.0f, 1.0f}, {0.2f, 2.8f, 0.95f});
    add("levator03", {0.2f, 2.8f, 0.95f}, {0.26f, 2.65f, 0.9f});
    add("levator04", {0.26f, 2.65f, 0.9f}, {0.3f, 2.55f, 0.84f});
    add("levator05", {0.3f, 2.55f, 0.84f}, {0.26f, 2.5f, 0.83f});
    add("oris06", {0, 2.2f, 0.6f}, {0.13f, 2.4f, 0.8f});
    add("risorius02", {0.6f, 3.0f, 0.75f}, {0.55f, 2.8f, 0.8f});
  }
  return joints;
}

void Line(std::ostringstream* out, const char* keyword, const glm::vec3& p) {
  *out << keyword << ' ' << p.x << ' ' << p.y << ' ' << p.z << '\n';
}

// A ball with (kColumns + 1) x (kRows + 1) UVs and rings of kColumns positions.
void AddBall(std::ostringstream* out) {
  for (int row = 0; row <= kRows; ++row) {
    const float down = std::numbers::pi_v<float> * (static_cast<float>(row) + 0.5f) / (kRows + 1);
    for (int column = 0; column < kColumns; ++column) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(column) / kColumns;
      Line(out, "v",
           {std::sin(down) * std::sin(turn), 3 + std::cos(down), std::sin(down) * std::cos(turn)});
    }
  }
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column)
      *out << "vt " << static_cast<float>(column) / kColumns << ' '
           << 1 - static_cast<float>(row) / kRows << '\n';
  }
}

void AddBallFaces(std::ostringstream* out) {
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      *out << 'f';
      for (const auto& [r, c] : {std::pair{1, 0}, {1, 1}, {0, 1}, {0, 0}})
        *out << ' ' << 1 + (row + r) * kColumns + (column + c) % kColumns << '/'
             << 1 + (row + r) * (kColumns + 1) + column + c;
      *out << '\n';
    }
  }
}

void AddCubes(std::ostringstream* out, int first) {
  for (const float side : {1.0f, -1.0f}) {
    for (int i = 0; i < 8; ++i)
      Line(out, "v",
           {side * 0.31f + ((i & 1) ? 0.14f : -0.14f), 3.1f + ((i & 2) ? 0.14f : -0.14f),
            0.7f + ((i & 4) ? 0.14f : -0.14f)});
  }
  for (int s = 0; s < 2; ++s) {
    const int at = first + 8 * s;
    *out << "g helper-" << (s == 0 ? 'l' : 'r') << "-eye\n";
    *out << "f " << at + 4 << ' ' << at + 5 << ' ' << at + 7 << ' ' << at + 6 << '\n';
    *out << "f " << at << ' ' << at + 2 << ' ' << at + 3 << ' ' << at + 1 << '\n';
  }
}

constexpr char kToyRig[] = R"({
  "name": "toy", "anchor": "head",
  "reference_poses": [{"name": "up", "joints": [{"joint": "oculi01.L", "euler_degrees": [20, 0, 20]}]}],
  "drivers": [{"name": "brow", "pose": {"points": [{"joint": "oculi01.L"}],
               "values": [{"name": "squash", "reference_pose": "up"}]}}],
  "regions": [{"name": "brow_l", "mask": {"texture": "face_masks_a"},
               "feeds": [{"map": "squash", "sources": [{"from": "brow.squash"}]}]}],
  "wrinkle_maps": [{"name": "squash", "normal": "face_squash"}]
})";

}  // namespace

ToyFolder::ToyFolder() {
  const std::vector<ToyJoint> joints = ToyJoints();
  std::ostringstream obj, bones, points;
  AddBall(&obj);
  constexpr int kBall = kColumns * (kRows + 1);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const char* comma = j == 0 ? "" : ",\n";
    const std::string parent = joints[j].parent.empty() ? "null" : '"' + joints[j].parent + '"';
    bones << comma << '"' << joints[j].name << R"(": {"parent": )" << parent << R"(, "head": "h)"
          << j << R"(", "tail": "t)" << j << "\"}";
    points << comma << "\"h" << j << "\": [" << kBall + 2 * j << "], \"t" << j << "\": ["
           << kBall + 2 * j + 1 << ']';
    Line(&obj, "v", joints[j].head);
    Line(&obj, "v", joints[j].tail);
  }
  obj << "g body\n";
  AddBallFaces(&obj);
  AddCubes(&obj, 1 + kBall + 2 * static_cast<int>(joints.size()));
  Write("3dobjs/base.obj", obj.str());
  Write("rigs/default.mhskel",
        "{\"bones\": {" + bones.str() + "},\n\"joints\": {" + points.str() + "}}");
  std::ostringstream weights;
  weights << R"({"weights": {"head": [)";
  for (int v = 0; v < kBall; ++v) weights << (v == 0 ? "" : ",\n") << '[' << v << ", 1.0]";
  Write("rigs/default_weights.mhw", weights.str() + "]}}");
  Write("clothes/cap/cap.obj",
        "v 0 0 0\nv 0 0 0\nv 0 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  // The cap covers and hides the first rows of the ball.
  Write("clothes/cap/cap.mhclo",
        "name cap\nobj_file cap.obj\nverts 0\n0 8 16 1 0 0 0 0.1 0\n"
        "0 8 16 0 1 0 0 0.1 0\n16\ndelete_verts\n0 - 71\n");
  Write("toy.rig.json", kToyRig);
}

void ToyFolder::Write(const std::string& file, const std::string& text) const {
  std::filesystem::create_directories((folder_ / file).parent_path());
  std::ofstream(folder_ / file, std::ios::binary) << text;
}

std::string ToyFolder::Read(const std::string& file) const {
  std::ifstream in(folder_ / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void ToyFolder::Remove(const std::string& file) const { std::filesystem::remove(folder_ / file); }

}  // namespace furrow::authoring
