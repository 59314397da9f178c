// SPDX-License-Identifier: Apache-2.0
// Runs one network on pictures, or on every n-th frame of a TUM folder, and prints one JSON line per picture.
#include <cmath>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/image/tum_dataset.hpp"
#include "services/detector/models/model_store.hpp"

namespace {

using nlohmann::ordered_json;
using rds::detector::Detection;
using rds::detector::Detector;

struct Options {
  std::string network;
  std::vector<std::string> images;
  std::string dataset;
  std::string out;
  std::string model_dir;
  std::size_t every = 1;
  rds::detector::DetectorConfig detector;
};

double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

ordered_json to_json(const std::vector<Detection>& detections) {
  ordered_json list = ordered_json::array();
  for (const Detection& d : detections)
    list.push_back(
        {{"label", d.label},
         {"score", rounded(static_cast<double>(d.score), 1e4)},
         {"box",
          {rounded(d.box.x0, 100), rounded(d.box.y0, 100), rounded(d.box.x1, 100), rounded(d.box.y1, 100)}},
         {"depth_m", rounded(static_cast<double>(d.depth_m), 1e3)}});
  return list;
}

rds::image::ColorImage load_color(const std::string& path) {
  rds::image::ColorImage picture{cv::imread(path, cv::IMREAD_COLOR), rds::image::ChannelOrder::kBgr, nullptr};
  if (picture.pixels.empty()) throw std::runtime_error(path + ": expected a picture");
  return picture;
}

void detect_in_images(Detector& detector, const Options& options, std::ostream& out) {
  for (const std::string& path : options.images)
    out << ordered_json{{"image", path}, {"detections", to_json(detector.detect(load_color(path)))}} << '\n';
}

void detect_in_dataset(Detector& detector, const Options& options, std::ostream& out) {
  const auto dataset = rds::image::TumDataset::open(options.dataset);
  if (!dataset) throw std::runtime_error(dataset.error());
  for (std::size_t i = 0; i < dataset->frames().size(); i += options.every) {
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    out << ordered_json{{"stamp", ordered_json::parse(dataset->frames()[i].stamp_text)},
                        {"detections", to_json(detector.detect(frame->color, frame->depth))}}
        << '\n';
  }
}

void run(const Options& options) {
  const auto folders = rds::detector::model_folders(options.model_dir);
  Detector detector(rds::detector::load_network(options.network, folders), options.detector);
  std::ofstream file;
  if (!options.out.empty()) file.open(options.out);
  if (!options.out.empty() && !file) throw std::runtime_error(options.out + ": cannot be written");
  std::ostream& out = options.out.empty() ? std::cout : file;
  detect_in_images(detector, options, out);
  if (!options.dataset.empty()) detect_in_dataset(detector, options, out);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Objects that a network finds in pictures, as JSON lines");
  app.add_option("network", options.network, "name of a network, or a YAML file that describes one")
      ->required();
  app.add_option("images", options.images, "pictures");
  app.add_option("--dataset", options.dataset, "TUM folder; writes lines of the form of detections.jsonl");
  app.add_option("--every", options.every, "only every n-th frame of the dataset")
      ->check(CLI::PositiveNumber);
  app.add_option("--out", options.out, "file instead of the standard output");
  app.add_option("--model-dir", options.model_dir, "folder that is searched for networks first");
  app.add_option("--precision", options.detector.precision, "f32 or bf16")
      ->check(CLI::IsMember({"f32", "bf16"}));
  app.add_option("--backend", options.detector.backend, "inference library: openvino or opencv");
  app.add_option("--score", options.detector.score_threshold, "lowest score; 0: the network's own")
      ->check(CLI::Range(0., 1.));
  app.add_option("--threads", options.detector.threads, "of the inference library")->check(CLI::Range(1, 64));
  app.add_option("--other-label-iou", options.detector.other_label_iou,
                 "1 keeps boxes of different labels that overlap");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  return 0;
}
