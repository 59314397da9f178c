// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/map_image.hpp"

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <octomap/ColorOcTree.h>

#include "tools/rds/picture/map_picture.hpp"
#include "tools/rds/run/output/result_file.hpp"

namespace rds::run {
namespace {

Eigen::Vector3d vector_of(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::vector<tools::SceneObject> read_objects(const std::filesystem::path& file) {
  std::vector<tools::SceneObject> objects;
  const auto json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
  if (!json.is_array()) return objects;
  for (const auto& o : json) {
    if (o.value("gone", false)) continue;
    const auto& oriented = o.at("oriented");
    const auto q = oriented.at("orientation").get<std::array<double, 4>>();
    geometry::OrientedBox box{
        geometry::make_pose(vector_of(oriented.at("center")), Eigen::Quaterniond(q[3], q[0], q[1], q[2])),
        vector_of(oriented.at("size"))};
    objects.push_back({o.at("label").get<std::string>(), box});
  }
  return objects;
}

}  // namespace

void write_map_image(const std::filesystem::path& folder, const std::string& description,
                     std::span<const geometry::StampedPose> trajectory) {
  const std::unique_ptr<octomap::AbstractOcTree> any(
      octomap::AbstractOcTree::read((folder / "map.ot").string()));
  const auto* tree = dynamic_cast<const octomap::ColorOcTree*>(any.get());
  if (tree == nullptr)
    throw std::runtime_error(fmt::format("{}: not a ColorOcTree", (folder / "map.ot").string()));
  tools::MapScene scene{*tree, {}, read_objects(folder / "objects.json"), {}};
  for (const auto& pose : trajectory) scene.trajectory.push_back(pose.map_from_camera.translation());
  tools::PictureOptions options;
  const auto json = nlohmann::json::parse(description, nullptr, false);
  if (json.is_object()) {
    scene.labels = json.value("labels", std::vector<std::string>{});
    if (json.contains("up")) options.up = vector_of(json["up"]);
  }
  write_picture(folder / "map.png", tools::render_map(scene, options));
}

}  // namespace rds::run
