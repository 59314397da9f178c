// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/registration/depth_registration.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rds::doctor {
namespace {
const cv::Size kSize(200, 150);
const cv::Point2d kCenter(98, 77);

struct Pictures {
  cv::Mat gray;
  cv::Mat depth;
};

/// Boards of one grey value each, the near ones before the far ones, before a wall.
Pictures boards(cv::RNG& random) {
  Pictures pictures{cv::Mat(kSize, CV_8UC1, cv::Scalar(90)), cv::Mat(kSize, CV_16UC1, cv::Scalar(4000))};
  for (int millimetres = 3400; millimetres > 800; millimetres -= 300) {
    const cv::Rect board(random.uniform(-20, 170), random.uniform(-20, 120), random.uniform(20, 60),
                         random.uniform(20, 60));
    cv::rectangle(pictures.gray, board, cv::Scalar(random.uniform(0, 255)), cv::FILLED);
    cv::rectangle(pictures.depth, board, cv::Scalar(millimetres), cv::FILLED);
  }
  cv::Mat noise(kSize, CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 12);
  pictures.gray += noise;
  return pictures;
}

/// The depth picture that `placement` puts onto the given one.
cv::Mat displaced(const cv::Mat& depth, const DepthPlacement& placement) {
  const cv::Point2d offset = kCenter - placement.scale * kCenter + placement.shift_px;
  const cv::Matx23d color_from_depth(placement.scale, 0, offset.x, 0, placement.scale, offset.y);
  cv::Mat moved;
  cv::warpAffine(depth, moved, color_from_depth, depth.size(), cv::INTER_NEAREST | cv::WARP_INVERSE_MAP);
  return moved;
}

std::vector<EdgeView> views(std::size_t count, const DepthPlacement& placement) {
  cv::RNG random(3);
  std::vector<EdgeView> result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [gray, depth] = boards(random);
    result.push_back(find_edges(gray, displaced(depth, placement)));
  }
  return result;
}

class MisplacedDepth : public testing::TestWithParam<DepthPlacement> {};

TEST_P(MisplacedDepth, IsFoundWhereItWasPut) {
  const auto& truth = GetParam();
  const auto fit = fit_registration(views(12, truth), kCenter, kSize);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->best.scale, truth.scale, 0.01);
  EXPECT_NEAR(fit->best.shift_px.x, truth.shift_px.x, 1.5);
  EXPECT_NEAR(fit->best.shift_px.y, truth.shift_px.y, 1.5);
  EXPECT_TRUE(is_misplaced(*fit, kSize));
}

INSTANTIATE_TEST_SUITE_P(DepthRegistration, MisplacedDepth,
                         testing::Values(DepthPlacement{0.9, {-3, 1}}, DepthPlacement{1.1, {0, 0}},
                                         DepthPlacement{1, {8, -3}}, DepthPlacement{1.5, {2, 2}}));

TEST(DepthRegistration, LeavesRegisteredDepthAlone) {
  const auto fit = fit_registration(views(12, {}), kCenter, kSize);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->best.scale, 1, 0.01);
  EXPECT_LT(fit->farthest_px, 2);
  EXPECT_GT(fit->agreement_as_is, 1.5 * fit->agreement_beside);
  EXPECT_FALSE(is_misplaced(*fit, kSize));
}

TEST(DepthRegistration, SeesNothingInDepthOfAnotherPlace) {
  auto mixed = views(14, {});
  for (std::size_t i = 0; i + 1 < mixed.size(); ++i)
    std::swap(mixed[i].depth_edges, mixed[i + 1].depth_edges);
  const auto fit = fit_registration(mixed, kCenter, kSize);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(is_misplaced(*fit, kSize));
}

TEST(DepthRegistration, TellsNothingFromFewViewsOrFromAWall) {
  EXPECT_FALSE(fit_registration(views(9, {}), kCenter, kSize));
  const cv::Mat gray(kSize, CV_8UC1, cv::Scalar(90));
  const cv::Mat depth(kSize, CV_16UC1, cv::Scalar(2000));
  EXPECT_FALSE(fit_registration(std::vector<EdgeView>(30, find_edges(gray, depth)), kCenter, kSize));
}

TEST(FindEdges, FindsTheNearSideOfAJumpAndNoSlope) {
  cv::Mat depth(40, 60, CV_16UC1, cv::Scalar(2000));
  depth.colRange(30, 60) = 1000;
  depth.rowRange(0, 20) = 0;  // no measurement, no edge
  for (int x = 0; x < 60; ++x) depth.at<std::uint16_t>(39, x) = static_cast<std::uint16_t>(1000 + 20 * x);
  depth.row(38) = 0;
  const auto view = find_edges(cv::Mat(40, 60, CV_8UC1, cv::Scalar(0)), depth);
  ASSERT_EQ(view.depth_edges.size(), 18U);
  for (const auto& edge : view.depth_edges) EXPECT_EQ(edge.x, 30);
}

}  // namespace
}  // namespace rds::doctor
