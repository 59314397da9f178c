// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/features2d.hpp>

#include "common/geometry/pose.hpp"
#include "common/image/tum_dataset.hpp"
#include "common/vision/place_index.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::vision {
namespace {

struct View {
  geometry::Pose map_from_camera;
  cv::Mat descriptors;
};

/// Every n-th frame of a recording with up to 1000 ORB features.
std::vector<View> read_views(const std::filesystem::path& folder, std::size_t every) {
  const auto dataset = image::TumDataset::open(folder);
  if (!dataset) throw std::runtime_error(dataset.error());
  const auto orb = cv::ORB::create(1000);
  std::vector<View> views;
  for (std::size_t i = 0; i < dataset->frames().size(); i += every) {
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    View view;
    view.map_from_camera = geometry::interpolate(dataset->ground_truth().value(), frame->stamp_ns);
    std::vector<cv::KeyPoint> keypoints;
    orb->detectAndCompute(frame->color.pixels, cv::noArray(), keypoints, view.descriptors);
    views.push_back(view);
  }
  return views;
}

geometry::Pose difference(const View& a, const View& b) {
  return a.map_from_camera.inverse() * b.map_from_camera;
}

/// Nearly the same view: the index must find it.
bool is_revisit(const View& a, const View& b) {
  return difference(a, b).translation().norm() < 0.5 &&
         geometry::rotation_angle_rad(difference(a, b).linear()) < 0.35;
}

/// The pictures may show common things (the optical axes are within a field of view): ranking it is no
/// mistake.
bool may_overlap(const View& a, const View& b) {
  const double cosine = a.map_from_camera.linear().col(2).dot(b.map_from_camera.linear().col(2));
  return difference(a, b).translation().norm() < 2.0 && cosine > std::cos(1.0);
}

struct Counts {
  int revisits = 0;
  int found = 0;
  int elsewhere = 0;  // best candidate above the threshold shows another place
};

/// Walks through the views; each is compared with those at least `gap` earlier and with `strangers` (another
/// room).
Counts count(const std::vector<View>& views, const std::vector<View>& strangers, std::size_t gap) {
  constexpr double kMinScore = 0.02;
  constexpr std::uint64_t kStranger = 1'000'000;
  PlaceIndex index;
  for (std::size_t i = 0; i < strangers.size(); ++i) index.add(kStranger + i, strangers[i].descriptors);
  const auto overlaps = [&](std::size_t i, std::uint64_t id) {
    return id < kStranger && may_overlap(views[i], views[id]);
  };
  Counts counts;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i >= gap) index.add(i - gap, views[i - gap].descriptors);
    bool revisit = false;
    for (std::size_t j = 0; j + gap <= i; ++j) revisit = revisit || is_revisit(views[i], views[j]);
    const auto candidates = index.query(views[i].descriptors, 3);
    const bool hit = std::any_of(candidates.begin(), candidates.end(), [&](const PlaceCandidate& c) {
      return c.score > kMinScore && overlaps(i, c.id);
    });
    counts.revisits += revisit ? 1 : 0;
    counts.found += revisit && hit ? 1 : 0;
    if (!candidates.empty() && candidates[0].score > kMinScore && !overlaps(i, candidates[0].id))
      ++counts.elsewhere;
  }
  return counts;
}

TEST(PlaceIndexOnRecordedPictures, FindsRevisitedPlacesAndRanksNoOtherPlaceFirst) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  RDS_REQUIRE_SHARED("data/tum_fr1_rpy");
  const auto kitchen = read_views(test::shared() / "data/7scenes_kitchen", 4);
  const auto office = read_views(test::shared() / "data/tum_fr1_rpy", 4);
  ASSERT_GE(kitchen.size(), 100U);
  ASSERT_GE(office.size(), 100U);
  const Counts in_kitchen = count(kitchen, office, 12);
  const Counts in_office = count(office, kitchen, 12);
  std::cout << "kitchen: " << in_kitchen.found << " of " << in_kitchen.revisits << " revisits found, "
            << in_kitchen.elsewhere << " elsewhere\noffice: " << in_office.found << " of "
            << in_office.revisits << " revisits found, " << in_office.elsewhere << " elsewhere\n";
  EXPECT_GE(in_kitchen.revisits, 20);
  EXPECT_GE(in_kitchen.found, in_kitchen.revisits * 9 / 10);
  EXPECT_LE(in_kitchen.elsewhere, 1);
  EXPECT_GE(in_office.revisits, 20);
  EXPECT_GE(in_office.found, in_office.revisits * 9 / 10);
  EXPECT_LE(in_office.elsewhere, 1);
}

}  // namespace
}  // namespace rds::vision
