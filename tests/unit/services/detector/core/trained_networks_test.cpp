// SPDX-License-Identifier: Apache-2.0
// The shipped networks on the shared photos, by every back end that is built in. Needs RDS_SHARED (photos,
// most networks) or `rds models fetch` (nanodet_g).
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <tuple>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "services/detector/core/detector.hpp"
#include "tests/unit/services/detector/core/shared_photos.hpp"

namespace rds::detector {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::array<std::string, 4> kNetworks{"mobilenetv2_ssdlite_voc", "nanodet_g", "nanodet_m_320",
                                           "yolox_nano"};
const std::array<std::string, 3> kPictures{"dog.jpg", "tum_rgb.png", "tum_1341846434.710184.png"};
constexpr double kSure = 0.35;

DetectorConfig computed_by(const std::string& backend, int threads = 1) {
  DetectorConfig config;
  config.backend = backend;
  config.threads = threads;
  return config;
}

DetectorConfig sure_boxes_of(const std::string& backend) {
  DetectorConfig config = computed_by(backend);
  config.score_threshold = kSure;
  return config;
}

DetectorConfig everything_the_network_says(const std::string& backend) {
  DetectorConfig config = computed_by(backend);
  config.other_label_iou = 1;
  return config;
}

/// Parameters: network, back end.
class TrainedNetwork : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  void SetUp() override {
    RDS_REQUIRE_SHARED(test::kPhotos);
    const std::string& network = std::get<0>(GetParam());
    if (!test::network_is_there(network)) GTEST_SKIP() << "the file of network " << network << " is missing";
  }
  [[nodiscard]] static Network network() { return load_network(std::get<0>(GetParam()), model_folders()); }
  [[nodiscard]] static Detector detector(int threads = 1) {
    return Detector(network(), computed_by(std::get<1>(GetParam()), threads));
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
  const auto found = detector().detect(test::load_photo("dog.jpg"));
  expect_overlap(with_label(found, "bicycle"), {125, 130, 570, 425});
  expect_overlap(with_label(found, "car"), {466, 75, 693, 172});
  expect_overlap(with_label(found, "dog"), {131, 215, 320, 540});
}

TEST_P(TrainedNetwork, FindsBothPersonsAtTheirDesk) {
  Detector detector(network(), sure_boxes_of(std::get<1>(GetParam())));
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
  Detector detector = TrainedNetwork::detector();
  cv::setNumThreads(1);
  const auto a = detector.detect(bgr);
  cv::setNumThreads(2);
  expect_equal(a, detector.detect(rgb), 0, 0);
  expect_equal(a, detector.detect(bgr), 0, 0);
}

TEST_P(TrainedNetwork, GivesTheSameBitsEveryTimeItIsLoaded) {
  const image::ColorImage photo = test::load_photo("dog.jpg");
  for (const int threads : {1, 2}) {
    Detector first = detector(threads);
    const auto a = first.detect(photo);
    static_cast<void>(first.detect(test::load_photo("tum_rgb.png")));
    expect_equal(a, first.detect(photo), 0, 0);
    expect_equal(a, detector(threads).detect(photo), 0, 0);
  }
}

TEST_P(TrainedNetwork, GivesNearlyTheSameWithMoreThreadsOfItsOwn) {
  const image::ColorImage photo = test::load_photo("tum_rgb.png");
  expect_equal(detector(1).detect(photo), detector(2).detect(photo), 1e-4, 1e-2);
}

TEST_P(TrainedNetwork, RefusesItsOwnFileCutShort) {
  const Network whole = network();
  for (const std::size_t parts : {2U, 3U, 50U, 1000U}) {
    Network cut{whole.description, whole.weights};
    cut.weights.resize(whole.weights.size() / parts);
    EXPECT_THROW(Detector(cut, computed_by(std::get<1>(GetParam()))), DetectorError)
        << "cut to 1 / " << parts;
  }
}

TEST_P(TrainedNetwork, SurvivesUniformAndTinyPictures) {
  Detector detector = TrainedNetwork::detector();
  for (const auto& size : {cv::Size(1, 1), cv::Size(7, 3), cv::Size(641, 1), cv::Size(333, 777)})
    for (const double value : {0.0, 255.0})
      for (const Detection& d : detector.detect(
               {cv::Mat(size, CV_8UC3, cv::Scalar::all(value)), image::ChannelOrder::kRgb, nullptr}))
        EXPECT_EQ(d.box, d.box.clipped(size.width, size.height));
}

INSTANTIATE_TEST_SUITE_P(Shipped, TrainedNetwork,
                         ::testing::Combine(::testing::ValuesIn(kNetworks), ::testing::ValuesIn(backends())),
                         [](const auto& p) { return std::get<0>(p.param) + "_" + std::get<1>(p.param); });

/// Parameters: network, picture.
class BothBackEnds : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

/// Boxes of a that stand out from the threshold are in b, too.
void expect_contained(const std::vector<Detection>& a, const std::vector<Detection>& b, double threshold) {
  constexpr double kScore = 0.005;
  constexpr double kPixels = 1;
  for (const Detection& x : a) {
    if (static_cast<double>(x.score) < threshold + kScore) continue;
    EXPECT_TRUE(std::ranges::any_of(b,
                                    [&](const Detection& y) {
                                      return x.label == y.label &&
                                             std::abs(static_cast<double>(x.score - y.score)) <= kScore &&
                                             std::abs(x.box.x0 - y.box.x0) <= kPixels &&
                                             std::abs(x.box.y0 - y.box.y0) <= kPixels &&
                                             std::abs(x.box.x1 - y.box.x1) <= kPixels &&
                                             std::abs(x.box.y1 - y.box.y1) <= kPixels;
                                    }))
        << x.label << " with score " << x.score;
  }
}

TEST_P(BothBackEnds, FindTheSameBoxes) {
  RDS_REQUIRE_SHARED(test::kPhotos);
  const auto& [name, picture] = GetParam();
  if (backends().size() < 2) GTEST_SKIP() << "built without OpenVINO";
  if (!test::network_is_there(name)) GTEST_SKIP() << "the file of network " << name << " is missing";
  const Network network = load_network(name, model_folders());
  const auto photo = test::load_photo(picture);
  const auto openvino = Detector(network, everything_the_network_says("openvino")).detect(photo);
  const auto opencv = Detector(network, everything_the_network_says("opencv")).detect(photo);
  EXPECT_THAT(openvino, Not(IsEmpty()));
  expect_contained(openvino, opencv, network.description.score_threshold);
  expect_contained(opencv, openvino, network.description.score_threshold);
}

INSTANTIATE_TEST_SUITE_P(Shipped, BothBackEnds,
                         ::testing::Combine(::testing::ValuesIn(kNetworks), ::testing::ValuesIn(kPictures)),
                         [](const auto& p) {
                           const auto* const picture = std::ranges::find(kPictures, std::get<1>(p.param));
                           return std::get<0>(p.param) + "_photo" +
                                  std::to_string(picture - kPictures.begin());
                         });

/// Parameters: picture, back end.
class PapersNetwork : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(PapersNetwork, ReproducesAnIndependentDecoder) {
  RDS_REQUIRE_SHARED(test::kPhotos);
  std::ifstream file(rds::test::shared() / test::kPhotos / "expected_ssdlite.json");
  const auto& [picture, backend] = GetParam();
  const auto expected = nlohmann::json::parse(file).at(picture);
  DetectorConfig config = sure_boxes_of(backend);
  config.other_label_iou = 1;
  Detector detector(load_network("mobilenetv2_ssdlite_voc", model_folders()), config);
  const auto found = detector.detect(test::load_photo(picture));
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
                         ::testing::Combine(::testing::ValuesIn(kPictures), ::testing::ValuesIn(backends())),
                         [](const auto& p) {
                           const auto* const picture = std::ranges::find(kPictures, std::get<0>(p.param));
                           return "photo" + std::to_string(picture - kPictures.begin()) + "_" +
                                  std::get<1>(p.param);
                         });

TEST(TrainedNetworks, OneObjectWithTwoLabelsIsReportedOnceByDefault) {
  RDS_REQUIRE_SHARED(test::kPhotos);
  Detector detector(load_network("mobilenetv2_ssdlite_voc", model_folders()));
  const auto found = detector.detect(test::load_photo("dog.jpg"));
  EXPECT_THAT(found, Contains(Field(&Detection::label, "dog")));
  EXPECT_THAT(with_label(found, "cat"), SizeIs(0));
}

}  // namespace
}  // namespace rds::detector
