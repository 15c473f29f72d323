// SPDX-License-Identifier: Apache-2.0
#include "render/request/request_check.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class RequestCheck : public testing::Test {
 protected:
  // Invalidates one field of a valid request and expects the error to name it.
  void ExpectRefused(const std::string& field, const std::function<void(FrameRequest&)>& spoil,
                     StatusCode code = StatusCode::kInvalidArgument) {
    FrameRequest request;
    request.model = model_;
    spoil(request);
    const Status status = CheckRequest(request, 2);
    EXPECT_EQ(status.code(), code) << field;
    EXPECT_EQ(status.where(), field) << status.ToString();
  }
  std::vector<glm::mat4> model_{glm::mat4(1.0f), glm::mat4(1.0f)};
};

TEST_F(RequestCheck, AcceptsDefaultsAndLimits) {
  FrameRequest request;
  request.model = model_;
  EXPECT_TRUE(CheckRequest(request, 2).ok());
  request.width = kMinSize;
  request.height = kMaxSize;
  request.settings.wrinkle_strength = 4.0f;
  request.settings.exposure = 16.0f;
  request.camera.follow_joint = 1;
  EXPECT_TRUE(CheckRequest(request, 2).ok());
}

TEST_F(RequestCheck, NamesTheInvalidField) {
  ExpectRefused("width", [](FrameRequest& r) { r.width = kMinSize - 1; });
  ExpectRefused("height", [](FrameRequest& r) { r.height = kMaxSize + 1; });
  ExpectRefused("scale", [](FrameRequest& r) { r.scale = 0.49f; });
  ExpectRefused("scale", [](FrameRequest& r) { r.scale = 1.01f; });
  ExpectRefused("scale", [](FrameRequest& r) { r.scale = kNan; });
  ExpectRefused("settings.wrinkle_strength",
                [](FrameRequest& r) { r.settings.wrinkle_strength = 4.01f; });
  ExpectRefused("settings.wrinkle_strength",
                [](FrameRequest& r) { r.settings.wrinkle_strength = kNan; });
  ExpectRefused("settings.exposure", [](FrameRequest& r) { r.settings.exposure = 0.0f; });
  ExpectRefused("settings.background", [](FrameRequest& r) { r.settings.background.y = -0.1f; });
  ExpectRefused("camera.position", [](FrameRequest& r) { r.camera.position.x = kNan; });
  ExpectRefused("camera.target", [](FrameRequest& r) { r.camera.target = r.camera.position; });
  ExpectRefused("camera.fov_y_degrees", [](FrameRequest& r) { r.camera.fov_y_degrees = 180.0f; });
  ExpectRefused("camera.follow_joint", [](FrameRequest& r) { r.camera.follow_joint = 2; });
  ExpectRefused("camera.turn_joint", [](FrameRequest& r) { r.camera.turn_joint = -2; });
  ExpectRefused("model", [](FrameRequest& r) { r.model = r.model.first(1); });
  model_[1][3].y = kNan;
  ExpectRefused(
      "model", [](FrameRequest&) {}, StatusCode::kNonFinite);
}

TEST_F(RequestCheck, NamesTheInvalidSubject) {
  PosedSubject good;
  good.model = model_;
  std::vector<PosedSubject> others(2, good);
  const auto expect = [&](const std::string& field,
                          StatusCode code = StatusCode::kInvalidArgument) {
    ExpectRefused(
        field, [&](FrameRequest& r) { r.others = others; }, code);
    others[1] = good;
  };
  others[1].model = good.model.first(1);
  expect("others[1].model");
  others[1].placement[3].x = kNan;
  expect("others[1].placement", StatusCode::kNonFinite);
  others[1].placement[0].x = 2.0f;  // not a uniform scale
  expect("others[1].placement");
  others[1].placement[0].x = -1.0f;  // mirrored
  expect("others[1].placement");
  others[1].placement = glm::mat4(0.0f);
  expect("others[1].placement");
  ExpectRefused("placement", [](FrameRequest& r) { r.placement[0].y = 1.0f; });
}

TEST_F(RequestCheck, ShapesAreOnePerShapeOrNone) {
  FrameRequest request;
  request.model = model_;
  EXPECT_TRUE(CheckRequest(request, 2, 3).ok());
  std::vector<float> shapes = {0.5f, -7.0f, 9.0f};  // drawn, limited
  request.shapes = shapes;
  EXPECT_TRUE(CheckRequest(request, 2, 3).ok());
  for (const std::size_t num_shapes : {0, 2, 4}) {
    const Status status = CheckRequest(request, 2, num_shapes);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.where(), "shapes");
  }
  shapes[1] = kNan;
  EXPECT_EQ(CheckRequest(request, 2, 3).code(), StatusCode::kNonFinite);
  const std::vector<PosedSubject> others(2, request);
  request.shapes = {};
  request.others = others;
  EXPECT_EQ(CheckRequest(request, 2, 3).where(), "others[0].shapes");
}

TEST_F(RequestCheck, LimitsTheNumberOfSubjects) {
  FrameRequest request;
  request.model = model_;
  std::vector<PosedSubject> others(kMaxSubjects, request);
  request.others = std::span(others).first(kMaxSubjects - 1);
  EXPECT_TRUE(CheckRequest(request, 2).ok());
  request.others = others;
  const Status status = CheckRequest(request, 2);
  EXPECT_EQ(status.code(), StatusCode::kLimit);
  EXPECT_EQ(status.where(), "others");
  EXPECT_NE(status.what().find(std::to_string(kMaxSubjects)), std::string::npos);
}

}  // namespace
}  // namespace furrow::render
