// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/objects/object_file.hpp"

#include <array>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace rds::evaluation {
namespace {

using nlohmann::json;

Eigen::Vector3d vector_from(const json& numbers) {
  const auto n = numbers.get<std::array<double, 3>>();
  return {n[0], n[1], n[2]};
}

/// A run says the orientation, a recording, whose z axis is up, the yaw alone.
Eigen::Quaterniond orientation_from(const json& box) {
  if (box.contains("orientation")) {
    const auto n = box.at("orientation").get<std::array<double, 4>>();
    return Eigen::Quaterniond(n[3], n[0], n[1], n[2]).normalized();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(box.value("yaw", 0.0), Eigen::Vector3d::UnitZ()));
}

LabelledThing thing_from(const json& object) {
  const json& box = object.contains("oriented") ? object.at("oriented") : object;
  return {object.at("label").get<std::string>(),
          {geometry::make_pose(vector_from(box.at("center")), orientation_from(box)),
           vector_from(box.at("size"))}};
}

}  // namespace

tl::expected<std::vector<LabelledThing>, std::string> read_things(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<LabelledThing> things;
  try {
    for (const json& object : json::parse(in))
      if (!object.value("gone", false)) things.push_back(thing_from(object));
  } catch (const json::exception&) {
    return tl::unexpected(fmt::format(
        R"({}: expected [{{"label": "chair", "center": [3 numbers], "size": [3 numbers]}}])", file.string()));
  }
  return things;
}

}  // namespace rds::evaluation
