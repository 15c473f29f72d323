// SPDX-License-Identifier: Apache-2.0
#include "authoring/assimp/collada_text.h"

#include <string>

#include <gtest/gtest.h>

#include "authoring/assimp/scene_file.h"

namespace furrow::authoring {
namespace {

TEST(ColladaText, DropsBlanksBetweenATagAndANumber) {
  EXPECT_EQ(WithoutBlanksBeforeNumbers("<v>\n\t 0 1\r\n 2</v>"), "<v>0 1\r\n 2</v>");
  EXPECT_EQ(WithoutBlanksBeforeNumbers("<v> -1</v> <p>\r\n.5 </p>"), "<v>-1</v> <p>.5 </p>");
}

TEST(ColladaText, KeepsAllOtherBytes) {
  for (const std::string& text :
       {std::string(), std::string("<a>\n  <b>text 1</b>\n</a>\n"), std::string("<a> b</a>"),
        std::string("no tags 1"), std::string("<a>   "), std::string(" 1 >"),
        std::string("<\0v\0>\0 \0001\0", 10)}) {
    EXPECT_EQ(WithoutBlanksBeforeNumbers(text), text);
  }
}

// A triangle whose vertices follow two joints. The '@' are places where blanks are allowed.
constexpr char kSkinned[] = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="m" name="m"><mesh>
<source id="p"><float_array id="pa" count="9">@0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>@3</vcount><p>@0 1 2</p></polylist></mesh></geometry></library_geometries>
<library_controllers><controller id="c"><skin source="#m">
<bind_shape_matrix>@1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
<source id="j"><Name_array id="ja" count="2">a b</Name_array><technique_common>
<accessor source="#ja" count="2" stride="1"><param name="JOINT" type="name"/></accessor>
</technique_common></source>
<source id="b"><float_array id="ba" count="32">@1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>
<accessor source="#ba" count="2" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor>
</technique_common></source>
<source id="w"><float_array id="wa" count="1">@1</float_array><technique_common>
<accessor source="#wa" count="1" stride="1"><param name="WEIGHT" type="float"/></accessor>
</technique_common></source>
<joints><input semantic="JOINT" source="#j"/>
<input semantic="INV_BIND_MATRIX" source="#b"/></joints>
<vertex_weights count="3"><input semantic="JOINT" source="#j" offset="0"/>
<input semantic="WEIGHT" source="#w" offset="1"/>
<vcount>@1 1 1</vcount><v>@0 0 0 0 1 0</v></vertex_weights>
</skin></controller></library_controllers>
<library_visual_scenes><visual_scene id="sc">
<node id="a" name="a" sid="a" type="JOINT"><translate>@0 1 0</translate>
<node id="b" name="b" sid="b" type="JOINT"><translate>@0 1 0</translate></node></node>
<node id="mm" name="mm"><instance_controller url="#c"><skeleton>#a</skeleton>
</instance_controller></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#sc"/></scene></COLLADA>
)";

TEST(ColladaText, SkinWeightsMayStartOnALineOfTheirOwn) {
  for (const std::string blanks : {"", " ", "\n    ", "\r\n\t"}) {
    std::string text;
    for (const char* c = kSkinned; *c != '\0'; ++c) {
      if (*c == '@') {
        text += blanks;
      } else {
        text += *c;
      }
    }
    Assimp::Importer importer;
    const auto scene = ReadScene(text, ".dae", Purpose::kModel, &importer);
    ASSERT_TRUE(scene.ok()) << scene.status().ToString();
    ASSERT_EQ((*scene)->mNumMeshes, 1u);
    const aiMesh& mesh = *(*scene)->mMeshes[0];
    EXPECT_EQ(mesh.mNumVertices, 3u);
    ASSERT_EQ(mesh.mNumBones, 2u);
    EXPECT_EQ(mesh.mBones[0]->mNumWeights + mesh.mBones[1]->mNumWeights, 3u);
  }
}

}  // namespace
}  // namespace furrow::authoring
