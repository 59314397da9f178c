// SPDX-License-Identifier: Apache-2.0
// The shipped networks on the shared photos. Needs RDS_SHARED (photos, most networks) or `rds models fetch`
// (nanodet_g).
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "services/detector/core/detector.hpp"
#include "tests/unit/services/detector/core/shared_photos.hpp"

namespace rds::detector {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::SizeIs;

DetectorConfig everything_the_network_says() {
  DetectorConfig config;
  config.other_label_iou = 1;
  return config;
}

class TrainedNetwork : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    RDS_REQUIRE_SHARED(test::kPhotos);
    if (!test::network_is_there(GetParam()))
      GTEST_SKIP() << "the file of network " << GetParam() << " is missing";
  }
};

std::vector<Detection> with_label(const std::vector<Detection>& all, const std::string& label) {
  std::vector<Detection> some;
  std::ranges::copy_if(all, std::back_inserter(some), [&](const Detection& d) { return d.label == label; });
  return some;
}

void expect_overlap(const std::vector<Detection>& found, const geometry::Box2& truth) {
  const auto overlap = [&](const Detection& d) { return geometry::iou(d.box, truth); };
  double best = 0;
  for (const Detection& d : found) best = std::max(best, overlap(d));
  EXPECT_GT(best, 0.7);
}

TEST_P(TrainedNetwork, FindsDogBicycleAndCar) {
  Detector detector(load_network(GetParam(), model_folders()));
  const auto found = detector.detect(test::load_photo("dog.jpg"));
  expect_overlap(with_label(found, "bicycle"), {125, 130, 570, 425});
  expect_overlap(with_label(found, "car"), {466, 75, 693, 172});
  expect_overlap(with_label(found, "dog"), {131, 215, 320, 540});
}

TEST_P(TrainedNetwork, FindsBothPersonsAtTheirDesk) {
  Detector detector(load_network(GetParam(), model_folders()));
  const auto found = with_label(detector.detect(test::load_photo("tum_rgb.png")), "person");
  EXPECT_THAT(found, SizeIs(2));
  expect_overlap(found, {236, 172, 536, 461});
  expect_overlap(found, {0, 102, 180, 459});
}

void expect_equal(const std::vector<Detection>& a, const std::vector<Detection>& b, double score,
                  double pixels) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].label, b[i].label);
    EXPECT_NEAR(static_cast<double>(a[i].score), static_cast<double>(b[i].score), score);
    EXPECT_NEAR(a[i].box.x0, b[i].box.x0, pixels);
    EXPECT_NEAR(a[i].box.y0, b[i].box.y0, pixels);
    EXPECT_NEAR(a[i].box.x1, b[i].box.x1, pixels);
    EXPECT_NEAR(a[i].box.y1, b[i].box.y1, pixels);
  }
}

TEST_P(TrainedNetwork, GivesTheSameBitsForEitherChannelOrderAndAnyThreadsOfTheProcess) {
  const image::ColorImage bgr = test::load_photo("tum_rgb.png");
  image::ColorImage rgb{{}, image::ChannelOrder::kRgb, nullptr};
  cv::cvtColor(bgr.pixels, rgb.pixels, cv::COLOR_BGR2RGB);
  Detector detector(load_network(GetParam(), model_folders()));
  cv::setNumThreads(1);
  const auto a = detector.detect(bgr);
  cv::setNumThreads(2);
  expect_equal(a, detector.detect(rgb), 0, 0);
  expect_equal(a, detector.detect(bgr), 0, 0);
}

TEST_P(TrainedNetwork, GivesNearlyTheSameWithMoreThreadsOfItsOwn) {
  const Network network = load_network(GetParam(), model_folders());
  DetectorConfig two_threads;
  two_threads.threads = 2;
  const image::ColorImage photo = test::load_photo("tum_rgb.png");
  expect_equal(Detector(network).detect(photo), Detector(network, two_threads).detect(photo), 1e-4, 1e-2);
}

TEST_P(TrainedNetwork, RefusesItsOwnFileCutShort) {
  const Network whole = load_network(GetParam(), model_folders());
  for (const std::size_t parts : {2U, 3U, 50U, 1000U}) {
    Network cut{whole.description, whole.weights};
    cut.weights.resize(whole.weights.size() / parts);
    EXPECT_THROW(Detector{cut}, DetectorError) << "cut to 1 / " << parts;
  }
}

TEST_P(TrainedNetwork, SurvivesUniformAndTinyPictures) {
  Detector detector(load_network(GetParam(), model_folders()));
  for (const auto& size : {cv::Size(1, 1), cv::Size(7, 3), cv::Size(641, 1), cv::Size(333, 777)})
    for (const double value : {0.0, 255.0})
      for (const Detection& d : detector.detect(
               {cv::Mat(size, CV_8UC3, cv::Scalar::all(value)), image::ChannelOrder::kRgb, nullptr}))
        EXPECT_EQ(d.box, d.box.clipped(size.width, size.height));
}

INSTANTIATE_TEST_SUITE_P(Shipped, TrainedNetwork,
                         ::testing::Values("mobilenetv2_ssdlite_voc", "nanodet_g", "nanodet_m_320",
                                           "yolox_nano"),
                         [](const auto& p) { return p.param; });

class PapersNetwork : public ::testing::TestWithParam<std::string> {};

TEST_P(PapersNetwork, ReproducesAnIndependentDecoder) {
  RDS_REQUIRE_SHARED(test::kPhotos);
  std::ifstream file(rds::test::shared() / test::kPhotos / "expected_ssdlite.json");
  const auto expected = nlohmann::json::parse(file).at(GetParam());
  Detector detector(load_network("mobilenetv2_ssdlite_voc", model_folders()), everything_the_network_says());
  const auto found = detector.detect(test::load_photo(GetParam()));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].label, expected[i].at("label").get<std::string>());
    EXPECT_NEAR(static_cast<double>(found[i].score), expected[i].at("score").get<double>(), 0.005);
    const auto box = expected[i].at("box").get<std::vector<double>>();
    EXPECT_NEAR(found[i].box.x0, box[0], 1);
    EXPECT_NEAR(found[i].box.y0, box[1], 1);
    EXPECT_NEAR(found[i].box.x1, box[2], 1);
    EXPECT_NEAR(found[i].box.y1, box[3], 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Photos, PapersNetwork,
                         ::testing::Values("dog.jpg", "tum_rgb.png", "tum_1341846434.710184.png"),
                         [](const auto& p) { return "photo" + std::to_string(p.index); });

TEST(TrainedNetworks, OneObjectWithTwoLabelsIsReportedOnceByDefault) {
  RDS_REQUIRE_SHARED(test::kPhotos);
  Detector detector(load_network("mobilenetv2_ssdlite_voc", model_folders()));
  const auto found = detector.detect(test::load_photo("dog.jpg"));
  EXPECT_THAT(found, Contains(Field(&Detection::label, "dog")));
  EXPECT_THAT(with_label(found, "cat"), SizeIs(0));
}

}  // namespace
}  // namespace rds::detector
