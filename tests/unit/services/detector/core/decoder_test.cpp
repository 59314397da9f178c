// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/decoder.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "services/detector/core/detection.hpp"

namespace rds::detector {
namespace {

using ::testing::SizeIs;

NamedTensor tensor(const std::string& name, int rows, int columns, float value = 0) {
  const std::array<int, 3> shape{1, rows, columns};
  return {name, cv::Mat(3, shape.data(), CV_32F, cv::Scalar(static_cast<double>(value)))};
}

float* row_of(NamedTensor& t, int row) {
  return t.values.ptr<float>(0, row);
}

void expect_box(const geometry::Box2& box, double x0, double y0, double x1, double y1) {
  EXPECT_NEAR(box.x0, x0, 1e-3);
  EXPECT_NEAR(box.y0, y0, 1e-3);
  EXPECT_NEAR(box.x1, x1, 1e-3);
  EXPECT_NEAR(box.y1, y1, 1e-3);
}

NetworkDescription network(DecoderKind kind, int size) {
  NetworkDescription n;
  n.input.width = size;
  n.input.height = size;
  n.labels = {"cat", "person"};
  n.decoder.kind = kind;
  return n;
}

TEST(SsdPriors, AreInTheOrderOfCaffesPriorBox) {
  InputDescription input;
  input.width = 300;
  input.height = 300;
  const std::vector<SsdMap> maps{{2, 60, 0, {2}}, {1, 105, 150, {2, 3}}};
  const auto priors = ssd_priors(input, maps);
  ASSERT_THAT(priors, SizeIs(2 * 2 * 3 + 6));
  EXPECT_EQ(priors[3].center_x, 225);  // second cell of the first row
  EXPECT_EQ(priors[3].center_y, 75);
  EXPECT_EQ(priors[0].width, 60);
  EXPECT_NEAR(priors[1].width, 60 * std::sqrt(2), 1e-9);
  EXPECT_NEAR(priors[1].height, 60 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(priors[2].width, 60 / std::sqrt(2), 1e-9);
  EXPECT_NEAR(priors[13].width, std::sqrt(105 * 150), 1e-9);
  EXPECT_NEAR(priors[13].height, std::sqrt(105 * 150), 1e-9);
  EXPECT_NEAR(priors[16].width, 105 * std::sqrt(3), 1e-9);
  EXPECT_NEAR(priors[17].height, 105 * std::sqrt(3), 1e-9);
}

class SsdDecoding : public ::testing::Test {
 protected:
  SsdDecoding() {
    description_.decoder.boxes_output = "loc";
    description_.decoder.scores_output = "conf";
    description_.decoder.maps = {{1, 60, 0, {}}};
  }
  NetworkDescription description_ = network(DecoderKind::kSsd, 300);
  NamedTensor boxes_ = tensor("loc", 1, 4);
  NamedTensor scores_ = tensor("conf", 1, 3);
};

TEST_F(SsdDecoding, AppliesTheCentreSizeCode) {
  row_of(scores_, 0)[2] = 0.8F;
  row_of(boxes_, 0)[0] = 1.0F;
  row_of(boxes_, 0)[3] = static_cast<float>(5 * std::log(2.0));
  const auto found = make_decoder(description_)->decode(std::vector{scores_, boxes_}, 0.5F);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].label, 1);
  EXPECT_EQ(found[0].score, 0.8F);
  expect_box(found[0].box, 156 - 30, 150 - 60, 156 + 30, 150 + 60);
}

TEST_F(SsdDecoding, NeverReportsTheBackground) {
  row_of(scores_, 0)[0] = 1.0F;
  EXPECT_THAT(make_decoder(description_)->decode(std::vector{scores_, boxes_}, 0.5F), SizeIs(0));
}

TEST_F(SsdDecoding, SkipsWhatIsNotFinite) {
  row_of(scores_, 0)[1] = std::numeric_limits<float>::quiet_NaN();
  row_of(scores_, 0)[2] = 0.9F;
  row_of(boxes_, 0)[2] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(make_decoder(description_)->decode(std::vector{scores_, boxes_}, 0.5F), SizeIs(0));
}

TEST_F(SsdDecoding, RejectsOutputsOfAnotherShape) {
  const auto decoder = make_decoder(description_);
  EXPECT_THROW(static_cast<void>(decoder->decode(std::vector{scores_}, 0.5F)), DetectorError);
  EXPECT_THROW(
      static_cast<void>(decoder->decode(std::vector{tensor("loc", 2, 4), tensor("conf", 2, 3)}, 0.5F)),
      DetectorError);
  EXPECT_THROW(static_cast<void>(decoder->decode(std::vector{boxes_, tensor("conf", 1, 7)}, 0.5F)),
               DetectorError);
}

TEST(YoloxDecoding, AddsTheCellAndScalesByTheStride) {
  NetworkDescription description = network(DecoderKind::kYolox, 64);
  description.decoder.strides = {32};
  NamedTensor output = tensor("output", 4, 7);
  const std::array<float, 7> row{0.5F, 0.25F, std::log(2.0F), 0.0F, 0.9F, 0.1F, 0.8F};
  std::ranges::copy(row, row_of(output, 3));
  const auto found = make_decoder(description)->decode(std::vector{output}, 0.5F);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].label, 1);
  EXPECT_FLOAT_EQ(found[0].score, 0.72F);
  expect_box(found[0].box, 48 - 32, 40 - 16, 48 + 32, 40 + 16);
  EXPECT_THROW(
      static_cast<void>(make_decoder(description)->decode(std::vector{tensor("output", 3, 7)}, 0.5F)),
      DetectorError);
  EXPECT_THROW(static_cast<void>(make_decoder(description)->decode(std::vector{output, output}, 0.5F)),
               DetectorError);
}

TEST(NanodetDecoding, TakesTheMeanOfEachSidesDistribution) {
  NetworkDescription description = network(DecoderKind::kNanodet, 64);
  description.decoder.strides = {32};
  description.decoder.bins = 4;
  NamedTensor scores = tensor("s", 4, 2);
  NamedTensor distances = tensor("d", 4, 16);  // all equal: the mean is 1.5 strides
  row_of(scores, 2)[0] = 0.9F;
  row_of(distances, 2)[3] = 1000.0F;  // left: the last bin alone
  const auto found = make_decoder(description)->decode(std::vector{distances, scores}, 0.5F);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].label, 0);
  expect_box(found[0].box, 15.5 - 96, 47.5 - 48, 15.5 + 48, 47.5 + 48);
}

TEST(NanodetDecoding, RejectsMissingAndAmbiguousOutputs) {
  NetworkDescription description = network(DecoderKind::kNanodet, 64);
  description.decoder.strides = {32};
  description.decoder.bins = 4;
  const auto decoder = make_decoder(description);
  const NamedTensor scores = tensor("s", 4, 2);
  EXPECT_THROW(static_cast<void>(decoder->decode(std::vector{scores}, 0.5F)), DetectorError);
  EXPECT_THROW(static_cast<void>(decoder->decode(std::vector{scores, scores, tensor("d", 4, 16)}, 0.5F)),
               DetectorError);
}

}  // namespace
}  // namespace rds::detector
