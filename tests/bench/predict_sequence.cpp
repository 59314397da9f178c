// SPDX-License-Identifier: Apache-2.0
// Transformation and prediction alone, with exact poses and recorded detections: writes predictions.jsonl as
// a run of the whole system would, so that the box figures can be computed from it.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/config/config_reader.hpp"
#include "common/geometry/stamp.hpp"
#include "common/image/tum_dataset.hpp"
#include "services/tracker/core/prediction/image_projection.hpp"
#include "services/tracker/core/prediction/object_predictor.hpp"
#include "services/transformer/core/box_transform.hpp"

namespace {

namespace geometry = rds::geometry;
using namespace rds::tracker::prediction;
using nlohmann::json;

struct Options {
  std::string dataset;
  std::string detections;
  std::string out;
  std::string config;
  std::string algorithm;
  std::size_t every = 3;
  std::size_t lag = 2;
};

template <class T>
T value_or_throw(tl::expected<T, std::string> result) {
  if (!result) throw std::runtime_error(result.error());
  return *std::move(result);
}

/// Detections by stamp, rounded to milliseconds.
using Detections = std::map<std::int64_t, json>;

std::int64_t milliseconds(double seconds) {
  return std::llround(seconds * 1e3);
}

Detections read_detections(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": expected a file of detections");
  Detections detections;
  for (std::string line; std::getline(file, line);) {
    const json entry = json::parse(line);
    detections[milliseconds(entry.at("stamp").get<double>())] = entry.at("detections");
  }
  return detections;
}

std::vector<ObjectObservation> transform(const json& detections, const geometry::Pose& map_from_camera,
                                         const geometry::CameraModel& camera) {
  std::vector<ObjectObservation> observations;
  for (const json& d : detections) {
    const auto corner = d.at("box").get<std::array<double, 4>>();
    const auto label = d.at("label").get<std::string>();
    const auto box =
        rds::transformer::box_in_map({corner[0], corner[1], corner[2], corner[3]},
                                     d.at("depth_m").get<double>(), label, map_from_camera, camera);
    if (box) observations.push_back({*box, label, d.at("score").get<float>()});
  }
  return observations;
}

json to_json(const PredictedObject& object, const geometry::Box2& box) {
  const geometry::Box3 hull = object.box.axis_aligned_hull();
  const auto list = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
  return {{"id", object.id},
          {"label", object.label},
          {"age_s", object.age_s},
          {"box", {box.x0, box.y0, box.x1, box.y1}},
          {"min", list(hull.min)},
          {"max", list(hull.max)},
          {"velocity", list(object.velocity)}};
}

PredictionConfig read_config(const Options& options) {
  PredictionConfig config;
  auto reader = options.config.empty() ? rds::config::ConfigReader()
                                       : rds::config::ConfigReader::from_file(options.config);
  read(reader, config);
  reader.finish();
  if (!options.algorithm.empty()) config.algorithm = options.algorithm;
  return config;
}

void run(const Options& options) {
  const auto dataset = value_or_throw(rds::image::TumDataset::open(options.dataset));
  if (!dataset.ground_truth()) throw std::runtime_error(options.dataset + ": expected groundtruth.txt");
  const auto detections = read_detections(options.detections);
  ObjectPredictor predictor(read_config(options));
  std::filesystem::create_directories(options.out);
  std::ofstream out(std::filesystem::path(options.out) / "predictions.jsonl");
  for (const auto& frame : dataset.frames()) {
    if (frame.index >= options.lag && (frame.index - options.lag) % options.every == 0) {
      const auto& keyframe = dataset.frames()[frame.index - options.lag];
      const auto found = detections.find(milliseconds(geometry::stamp_seconds(keyframe.stamp_ns)));
      if (found == detections.end())
        throw std::runtime_error(options.detections + ": no line for the frame at " + keyframe.stamp_text);
      const auto pose = geometry::interpolate(*dataset.ground_truth(), keyframe.stamp_ns);
      predictor.update(keyframe.stamp_ns, transform(found->second, pose, dataset.camera()),
                       KeyframeView{pose, dataset.camera()});
    }
    const auto camera_from_map = geometry::interpolate(*dataset.ground_truth(), frame.stamp_ns).inverse();
    json boxes = json::array();
    for (const PredictedObject& object : predictor.predict(frame.stamp_ns))
      if (const auto seen = to_image(object.box, camera_from_map, dataset.camera()))
        boxes.push_back(to_json(
            object,
            with_reach(seen->box, object.movable ? kReachShare : 0, dataset.camera())));
    out << json{{"stamp", geometry::stamp_seconds(frame.stamp_ns)}, {"boxes", boxes}} << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Predicted boxes for every frame of a sequence with exact poses");
  app.add_option("dataset", options.dataset, "TUM folder with groundtruth.txt")->required();
  app.add_option("detections", options.detections, "detections.jsonl with a line for every key frame")
      ->required();
  app.add_option("--out", options.out, "folder for predictions.jsonl")->required();
  app.add_option("--config", options.config, "YAML with the settings of the prediction");
  app.add_option("--algorithm", options.algorithm, "instead of the configured one")
      ->check(CLI::IsMember({"paper", "kalman3d"}));
  app.add_option("--every", options.every, "frames from key frame to key frame")->check(CLI::PositiveNumber);
  app.add_option("--lag", options.lag, "frames from a key frame to the effect of its detections")
      ->check(CLI::NonNegativeNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  return 0;
}
