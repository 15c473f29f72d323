// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "rig/shapes/shape_match.h"

namespace furrow::rig {

// The shape maps of the source tree, whatever is installed on this machine.
inline std::vector<ShapeMap> ShippedShapeMaps() {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  auto maps = LoadShippedShapeMaps();
  unsetenv("FURROW_DATA_DIR");
  return maps.value();
}

inline ShapeMatcher ShippedShapeMatcher() { return ShapeMatcher(ShippedShapeMaps()); }

inline std::vector<std::string> NamesOf(const ShapeMap& map) {
  std::vector<std::string> names;
  for (const MapShape& shape : map.shapes) names.push_back(shape.name);
  return names;
}

inline std::vector<std::string> ArkitNamesForTests() {
  return {ArkitShapes().begin(), ArkitShapes().end()};
}

// One name per shape of each vocabulary, as real files and streams write them.
struct RealNames {
  const char* map;
  std::vector<std::string> names;
};

inline std::vector<RealNames> RealNameLists() {
  return {
      {"arkit", {"EyeBlinkLeft", "JawOpen", "MouthSmileRight", "BrowInnerUp", "HeadYaw"}},
      {"arkit", {"browDown_L", "browDown_R", "eyeBlink_L", "mouthClose", "jawOpen"}},
      {"arkit", {"eyeBlinking_Left", "mouthClosed", "mouseRight", "browInnerUp"}},
      {"cc3", {"A01_Brow_Inner_Up", "A25_Jaw_Open", "A51_Mouth_Stretch_Right"}},
      {"cc4", {"Brow_Raise_Inner_L", "Brow_Drop_R", "Eye_L_Look_R", "Jaw_L", "Mouth_Funnel_Up_L"}},
      {"cc4", {"Mouth_Funnel", "Mouth_Roll_In_Upper", "Brow_Raise_Inner_L", "Cheek_Raise_R"}},
      {"unified", {"EyeClosedLeft", "BrowLowererLeft", "MouthCornerPullRight", "LipSuckUpper"}},
      {"sranipal", {"Jaw_Open", "Mouth_Ape_Shape", "Eye_Left_Right", "Mouth_Sad_Left"}},
      {"metahuman",
       {"CTRL_expressions_browRaiseInL", "CTRL_expressions_eyeLookRightL",
        "CTRL_expressions_jawOpen", "CTRL_expressions_mouthFunnelUL"}},
      {"facs", {"AU01_L", "AU4", "AU12_R", "AU26"}},
      {"facs", {"innerBrowRaiserLeft", "lipCornerPullerLeft", "jawDrop"}},
      {"vrm1", {"happy", "angry", "sad", "relaxed", "aa", "ih", "ou", "blinkLeft"}},
      {"vrm0", {"Joy", "Angry", "Sorrow", "Fun", "A", "I", "U", "E", "O", "Blink", "Blink_L"}},
      {"vroid", {"Fcl_ALL_Joy", "Fcl_MTH_A", "Fcl_EYE_Close_L", "Fcl_HA_Hide"}},
      {"vroid",
       {"Face.M_F00_000_00_Fcl_ALL_Joy", "Face.M_F00_000_00_Fcl_MTH_A",
        "Face.M_F00_000_00_Fcl_EYE_Close_L"}},
      {"oculus-visemes", {"viseme_sil", "viseme_PP", "viseme_aa", "viseme_E", "viseme_U"}},
      {"oculus-visemes", {"vrc.v_sil", "vrc.v_pp", "vrc.v_aa", "vrc.v_oh", "vrc.v_ou"}},
  };
}

}  // namespace furrow::rig
