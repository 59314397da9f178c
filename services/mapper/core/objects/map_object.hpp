// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

namespace rds::mapper {

/// An object as the database knows it, in the map frame.
struct MapObject {
  std::uint64_t id = 0;
  std::string label;
  float score = 0;  // observation-weighted mean of the detector's scores
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::uint32_t observations = 0;
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;
  std::uint32_t seen_through = 0;  // views through its place since it was seen last
  bool has_gone = false;           // it is not there any more
};

}  // namespace rds::mapper
