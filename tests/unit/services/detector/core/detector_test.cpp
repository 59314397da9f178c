// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/detector.hpp"

#include <gmock/gmock.h>

namespace rds::detector {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Answers every picture with the same YOLOX rows for a 64 × 64 input with one stride of 32: 4 cells, 2
/// labels.
class FixedAnswer final : public InferenceBackend {
 public:
  explicit FixedAnswer(std::vector<std::vector<float>> rows) : rows_(std::move(rows)) {}
  std::vector<NamedTensor> infer(const cv::Mat& input) override {
    EXPECT_EQ(input.total(), 3U * 64 * 64);
    cv::Mat values(static_cast<int>(rows_.size()), 7, CV_32F);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      std::ranges::copy(rows_[i], values.ptr<float>(static_cast<int>(i)));
    return {{"output", values}};
  }
  [[nodiscard]] std::string library() const override { return "fixed answers"; }

 private:
  std::vector<std::vector<float>> rows_;
};

const std::vector<float> kNothing{0, 0, 0, 0, 0, 0, 0};
const std::vector<float> kPersonOfOneCell{0.5F, 0.5F, 0, 0, 1, 0, 0.9F};
const std::vector<float> kHugeTelevision{0.5F, 0.5F, 3, 3, 1, 0.8F, 0};

NetworkDescription description() {
  NetworkDescription n;
  n.name = "fixed";
  n.file = "fixed.onnx";
  n.input.width = 64;
  n.input.height = 64;
  n.decoder.kind = DecoderKind::kYolox;
  n.decoder.strides = {32};
  n.labels = {"tv", "person"};
  return n;
}

Detector detector_answering(std::vector<std::vector<float>> rows) {
  return {description(), std::make_unique<FixedAnswer>(std::move(rows))};
}

image::ColorImage picture(int width, int height) {
  return {cv::Mat(height, width, CV_8UC3, cv::Scalar::all(100)), image::ChannelOrder::kBgr, nullptr};
}

TEST(Detector, GivesBoxesInThePicturesPixels) {
  Detector detector = detector_answering({kNothing, kPersonOfOneCell, kNothing, kNothing});
  const auto found = detector.detect(picture(640, 480));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].label, "person");
  EXPECT_FLOAT_EQ(found[0].score, 0.9F);
  EXPECT_NEAR(found[0].box.x0, 320, 1e-3);
  EXPECT_NEAR(found[0].box.y0, 0, 1e-3);
  EXPECT_NEAR(found[0].box.x1, 640, 1e-3);
  EXPECT_NEAR(found[0].box.y1, 240, 1e-3);
}

TEST(Detector, TakesAnotherThresholdFromTheNextPictureOn) {
  Detector detector = detector_answering({kNothing, kPersonOfOneCell, kNothing, kNothing});
  detector.set_score_threshold(0.95);
  EXPECT_THAT(detector.detect(picture(640, 480)), SizeIs(0));
  detector.set_score_threshold(0);  // the network's own
  EXPECT_THAT(detector.detect(picture(640, 480)), SizeIs(1));
}

TEST(Detector, ClipsBoxesToThePictureAndSpeaksVoc) {
  Detector detector = detector_answering({kHugeTelevision, kNothing, kNothing, kNothing});
  const auto found = detector.detect(picture(101, 33));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].label, "tvmonitor");
  EXPECT_EQ(found[0].box, (geometry::Box2{0, 0, 101, 33}));
}

TEST(Detector, MeasuresTheDepthOfEachBox) {
  Detector detector = detector_answering({kNothing, kNothing, kNothing, kPersonOfOneCell});
  const image::DepthImage depth{cv::Mat(64, 64, CV_16UC1, cv::Scalar(1500)), 0.001F, nullptr};
  const auto found = detector.detect(picture(64, 64), depth);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].depth_m, 1.5F, 1e-4F);
}

TEST(Detector, TakesAnyPictureSizeFromOnePixelOn) {
  Detector detector = detector_answering({kPersonOfOneCell, kNothing, kNothing, kNothing});
  for (const auto& size : {cv::Size(1, 1), cv::Size(1, 999), cv::Size(999, 1), cv::Size(63, 65)})
    EXPECT_THAT(detector.detect(picture(size.width, size.height)), SizeIs(1));
}

TEST(Detector, RefusesWhatIsNoColourPicture) {
  Detector detector = detector_answering({kNothing, kNothing, kNothing, kNothing});
  EXPECT_THROW(static_cast<void>(detector.detect({})), DetectorError);
  const image::ColorImage grey{cv::Mat::zeros(10, 10, CV_8UC1), image::ChannelOrder::kBgr, nullptr};
  EXPECT_THROW(static_cast<void>(detector.detect(grey)), DetectorError);
}

TEST(Detector, RefusesANetworkThatDoesNotFitItsDescription) {
  try {
    static_cast<void>(detector_answering({kNothing, kNothing, kNothing}));
    FAIL() << "three rows for four cells were accepted";
  } catch (const DetectorError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("fixed (fixed.onnx)"), HasSubstr("expected 4 rows")));
  }
}

TEST(Detector, RefusesBytesThatAreNoNetwork) {
  for (const std::string bytes : {"", "x", "this is not ONNX, only a sentence", "\x08\x07\x12\x03"}) {
    const Network network{description(), {bytes.begin(), bytes.end()}};
    for (const std::string& backend : backends()) {
      DetectorConfig config;
      config.backend = backend;
      EXPECT_THROW(Detector(network, config), DetectorError) << bytes << " by " << backend;
    }
  }
}

TEST(Detector, NamesTheBackEndsThatItHas) {
  const auto names = backends();
  EXPECT_EQ(names.back(), "opencv");
  DetectorConfig config;
  config.backend = "abacus";
  try {
    static_cast<void>(Detector({description(), {}}, config));
    FAIL() << "an unknown back end was accepted";
  } catch (const DetectorError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("backend 'abacus' is not built into this program"),
                                HasSubstr(names.front())));
  }
}

TEST(Detector, RefusesAPrecisionThatItsBackEndDoesNotHave) {
  DetectorConfig config;
  config.backend = "opencv";
  config.precision = "bf16";
  try {
    static_cast<void>(Detector({description(), {}}, config));
    FAIL() << "OpenCV was asked for bf16";
  } catch (const DetectorError& e) {
    EXPECT_THAT(e.what(), HasSubstr("precision bf16: backend 'opencv' computes in f32 only"));
  }
}

TEST(Detector, LeavesOpenCvsNumberOfThreadsAlone) {
  cv::setNumThreads(2);
  const int before = cv::getNumThreads();
  DetectorConfig config;
  config.threads = 1;
  Detector detector(description(),
                    std::make_unique<FixedAnswer>(std::vector{kNothing, kNothing, kNothing, kNothing}),
                    config);
  static_cast<void>(detector.detect(picture(64, 64)));
  EXPECT_EQ(cv::getNumThreads(), before);
}

}  // namespace
}  // namespace rds::detector
