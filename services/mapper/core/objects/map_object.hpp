// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "services/mapper/core/objects/label_distribution.hpp"
#include "services/mapper/core/objects/upright_box.hpp"

namespace rds::mapper {

/// An object as the database knows it, in the map frame.
struct MapObject {
  std::uint64_t id = 0;
  std::string label;                                 // the most probable one
  std::vector<LabelBelief> labels;                   // the most probable ones, that one first
  float score = 0;                                   // observation-weighted mean of the detector's scores
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of the box along the map's axes
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  UprightBox upright;  // turned about the direction up as the object stands
  std::uint32_t observations = 0;
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;
  std::uint32_t seen_through = 0;  // views through its place since it was seen last
  bool has_gone = false;           // it is not there any more
};

}  // namespace rds::mapper
