// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/mapper/recording.hpp"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/mapper/core/config/mapper_config.hpp"

namespace rds::bench {
namespace {

template <class T>
T or_throw(tl::expected<T, std::string> result) {
  if (!result) throw std::runtime_error(result.error());
  return std::move(*result);
}

}  // namespace

Recording::Recording(const std::filesystem::path& folder, const std::filesystem::path& boxes_file)
    : dataset_(or_throw(image::TumDataset::open(folder))) {
  if (!dataset_.ground_truth()) throw std::runtime_error(folder.string() + "/groundtruth.txt: missing");
  if (boxes_file.empty()) return;
  read_boxes(boxes_file);
  if (boxes_file.extension() == ".jsonl") return;
  if (std::filesystem::exists(folder / "objects.json")) read_static_objects(folder / "objects.json");
}

void Recording::read_boxes(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  has_boxes_ = true;
  if (file.extension() == ".jsonl") return read_detections(in);
  const auto truth = nlohmann::json::parse(in);
  for (const auto& frame : truth.at("frames")) {
    const double stamp_s = std::stod(frame.at("timestamp").get<std::string>());
    auto& boxes = boxes_[std::llround(stamp_s * 1e6)];
    for (const auto& person : frame.at("people")) {
      const auto b = person.at("box").get<std::vector<double>>();
      boxes.push_back({"person",
                       1.0F,
                       {b.at(0), b.at(1), b.at(2), b.at(3)},
                       std::nullopt,
                       person.at("distance").get<float>(),
                       true});
    }
  }
}

void Recording::read_detections(std::istream& in) {
  const mapper::MapperConfig config;
  for (std::string line; std::getline(in, line);) {
    const auto frame = nlohmann::json::parse(line);
    auto& boxes = boxes_[std::llround(frame.at("stamp").get<double>() * 1e6)];
    for (const auto& detection : frame.at("detections")) {
      const auto b = detection.at("box").get<std::vector<double>>();
      const auto label = detection.at("label").get<std::string>();
      boxes.push_back({label,
                       detection.at("score").get<float>(),
                       {b.at(0), b.at(1), b.at(2), b.at(3)},
                       std::nullopt,
                       detection.at("depth_m").get<float>(),
                       config.is_movable(label)});
    }
  }
}

void Recording::read_static_objects(const std::filesystem::path& file) {
  std::ifstream in(file);
  const auto objects = nlohmann::json::parse(in);
  for (const auto& object : objects) {
    const auto center = object.at("center").get<std::vector<double>>();
    const auto size = object.at("size").get<std::vector<double>>();
    const Eigen::Vector3d c(center.at(0), center.at(1), center.at(2));
    const Eigen::Vector3d half = Eigen::Vector3d(size.at(0), size.at(1), size.at(2)) / 2;
    static_objects_.push_back(
        {object.at("label").get<std::string>(), 0.9F, {}, geometry::Box3{c - half, c + half}, 0.0F, false});
  }
}

mapper::KeyframeInput Recording::keyframe(std::size_t i) const {
  const auto frame = or_throw(dataset_.load(dataset_.frames().at(i)));
  mapper::KeyframeInput input{.id = i,
                              .stamp_ns = frame.stamp_ns,
                              .map_from_camera = {},
                              .color = frame.color,
                              .depth = frame.depth,
                              .camera = frame.camera,
                              .boxes = std::nullopt,
                              .movable_cells = {}};
  input.map_from_camera = geometry::interpolate(*dataset_.ground_truth(), frame.stamp_ns);
  if (!has_boxes_) return input;
  const auto found = boxes_.find(std::llround(static_cast<double>(frame.stamp_ns) * 1e-3));
  input.boxes = found == boxes_.end() ? std::vector<mapper::LabelledBox>{} : found->second;
  input.boxes->insert(input.boxes->end(), static_objects_.begin(), static_objects_.end());
  return input;
}

}  // namespace rds::bench
