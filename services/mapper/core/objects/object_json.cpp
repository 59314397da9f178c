// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_json.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace rds::mapper {
namespace {

using nlohmann::json;

double rounded(double value, double per_unit = 1e4) {
  return std::round(value * per_unit) / per_unit + 0.0;  // no −0
}

json rounded(const Eigen::Vector3d& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

double seconds(std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns) * 1e-9;
}

json to_json(const std::vector<LabelBelief>& beliefs) {
  json labels = json::array();
  for (const LabelBelief& belief : beliefs)
    labels.push_back({{"label", belief.label}, {"probability", rounded(belief.probability)}});
  return labels;
}

json to_json(const UprightBox& upright) {
  Eigen::Quaterniond q(upright.box.map_from_box.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const json orientation{rounded(q.x(), 1e6), rounded(q.y(), 1e6), rounded(q.z(), 1e6), rounded(q.w(), 1e6)};
  return {{"center", rounded(upright.box.center())},
          {"size", rounded(upright.box.size)},
          {"yaw", rounded(upright.yaw_rad)},
          {"orientation", orientation}};
}

}  // namespace

std::string to_json(std::span<const MapObject> objects) {
  json list = json::array();
  for (const auto& o : objects)
    list.push_back({{"id", o.id},
                    {"label", o.label},
                    {"labels", to_json(o.labels)},
                    {"score", rounded(double{o.score})},
                    {"center", rounded(o.center)},
                    {"size", rounded(o.size)},
                    {"oriented", to_json(o.upright)},
                    {"observations", o.observations},
                    {"movable", false},
                    {"first_seen", seconds(o.first_seen_ns)},
                    {"last_seen", seconds(o.last_seen_ns)},
                    {"gone", o.has_gone}});
  return list.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace rds::mapper
