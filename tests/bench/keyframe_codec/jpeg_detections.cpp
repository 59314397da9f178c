// SPDX-License-Identifier: Apache-2.0
// What JPEG does to a network's boxes: pictures of a recording as they are and after compression.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/image/tum_dataset.hpp"
#include "services/detector/models/model_store.hpp"
#include "tests/bench/keyframe_codec/jpeg_of.hpp"

namespace {

using rds::bench::kSubsamplings;
using rds::bench::Subsampling;
using rds::detector::Detection;
using rds::detector::Detector;
using Detections = std::vector<Detection>;

constexpr double kSameBoxIou = 0.5;
constexpr float kSureScore = 0.5F;

struct Options {
  std::string network;
  std::vector<std::string> datasets;
  std::size_t every = 20;
  double noise = 0;
  std::vector<int> qualities{80, 85, 90, 95};
};

/// Boxes of compressed pictures against those of the same pictures as they were.
struct Comparison {
  std::vector<double> bytes;
  std::size_t raw = 0;
  std::size_t compressed = 0;
  std::size_t sure = 0;       // of the raw ones
  std::size_t lost = 0;       // raw ones without a partner
  std::size_t sure_lost = 0;  // among them
  std::size_t added = 0;      // compressed ones without a partner
  std::size_t sure_added = 0;
  std::vector<double> ious;  // of partners
  std::vector<double> score_changes;
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

/// The best box of the same label, if it overlaps by kSameBoxIou.
const Detection* partner_of(const Detection& box, const Detections& others) {
  const auto overlap = [&](const Detection& d) { return d.label == box.label ? iou(d.box, box.box) : 0; };
  const auto best = std::ranges::max_element(others, {}, overlap);
  return best != others.end() && overlap(*best) >= kSameBoxIou ? &*best : nullptr;
}

void compare(const Detections& raw, const Detections& compressed, Comparison& c) {
  c.raw += raw.size();
  c.compressed += compressed.size();
  for (const Detection& box : raw) {
    const bool sure = box.score >= kSureScore;
    c.sure += sure ? 1 : 0;
    if (const Detection* partner = partner_of(box, compressed)) {
      c.ious.push_back(iou(partner->box, box.box));
      c.score_changes.push_back(std::abs(static_cast<double>(partner->score - box.score)));
    } else {
      ++c.lost;
      c.sure_lost += sure ? 1 : 0;
    }
  }
  for (const Detection& box : compressed) {
    if (partner_of(box, raw) != nullptr) continue;
    ++c.added;
    c.sure_added += box.score >= kSureScore ? 1 : 0;
  }
}

/// The picture as a sensor with a Bayer pattern would see it. Recordings whose pictures were JPEG already
/// hide what compression does.
cv::Mat3b seen_by_a_sensor(const cv::Mat3b& picture, double noise) {
  cv::Mat1b mosaic(picture.size());
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) mosaic(y, x) = picture(y, x)[y % 2 + x % 2];
  cv::Mat1s noise_picture(picture.size());
  cv::randn(noise_picture, 0, noise);
  cv::add(mosaic, noise_picture, mosaic, cv::noArray(), CV_8U);
  cv::Mat3b seen;
  cv::cvtColor(mosaic, seen, cv::COLOR_BayerRG2BGR);  // OpenCV names a pattern by its second row
  return seen;
}

std::vector<cv::Mat> pictures_of(const Options& options) {
  std::vector<cv::Mat> pictures;
  for (const std::string& folder : options.datasets) {
    const auto dataset = rds::image::TumDataset::open(folder);
    if (!dataset) throw std::runtime_error(dataset.error());
    for (std::size_t i = 0; i < dataset->frames().size(); i += options.every) {
      auto frame = dataset->load(dataset->frames()[i]);
      if (!frame) throw std::runtime_error(frame.error());
      const cv::Mat& pixels = frame->color.pixels;
      pictures.push_back(options.noise > 0 ? seen_by_a_sensor(pixels, options.noise) : pixels);
    }
  }
  return pictures;
}

Detections boxes_in(const cv::Mat& bgr, Detector& detector) {
  return detector.detect(rds::image::ColorImage{bgr, rds::image::ChannelOrder::kBgr, nullptr});
}

Comparison compare_all(const std::vector<cv::Mat>& pictures, const std::vector<Detections>& raw,
                       Detector& detector, int quality, const Subsampling& subsampling) {
  Comparison c;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto jpeg = rds::bench::jpeg_of(pictures[i], quality, subsampling);
    c.bytes.push_back(static_cast<double>(jpeg.size()));
    compare(raw[i], boxes_in(cv::imdecode(jpeg, cv::IMREAD_COLOR), detector), c);
  }
  return c;
}

void print(int quality, const Subsampling& subsampling, const Comparison& c) {
  fmt::print(
      "| {} {} | {:.0f} / {:.0f} | {} | {} | {} | {} of {} | {} | {:.3f} / {:.3f} | {:.3f} / {:.3f} |\n",
      quality, subsampling.name, quantile(c.bytes, 0.5) / 1000, quantile(c.bytes, 1) / 1000, c.compressed,
      c.lost, c.added, c.sure_lost, c.sure, c.sure_added, quantile(c.ious, 0.5), quantile(c.ious, 0.05),
      quantile(c.score_changes, 0.5), quantile(c.score_changes, 0.95));
  std::fflush(stdout);
}

void run(const Options& options) {
  cv::theRNG().state = 1;
  const auto folders = rds::detector::model_folders();
  Detector detector(rds::detector::load_network(options.network, folders));
  const std::vector<cv::Mat> pictures = pictures_of(options);
  std::vector<Detections> raw;
  std::size_t boxes = 0;
  for (const cv::Mat& picture : pictures) boxes += raw.emplace_back(boxes_in(picture, detector)).size();
  fmt::print("{}, {} pictures, noise {}, {} boxes\n\n", detector.network().name, pictures.size(),
             options.noise, boxes);
  fmt::print(
      "| quality | kB median / max | boxes | lost | added | sure ones lost | sure ones added | IoU median / "
      "5 % "
      "| score change median / 95 % |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const Subsampling& subsampling : kSubsamplings)
    for (const int quality : options.qualities)
      print(quality, subsampling, compare_all(pictures, raw, detector, quality, subsampling));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Boxes of a network in pictures, and in the same pictures after JPEG");
  app.add_option("network", options.network, "name of a network, or a YAML file that describes one")
      ->required();
  app.add_option("datasets", options.datasets, "TUM folders")->required();
  app.add_option("--every", options.every, "only every n-th frame")->check(CLI::PositiveNumber);
  app.add_option("--noise", options.noise,
                 "pictures as a sensor with this noise [grey levels] sees them; 0: as they are")
      ->check(CLI::Range(0., 50.));
  app.add_option("--quality", options.qualities, "of the JPEG")->check(CLI::Range(1, 100));
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  return 0;
}
