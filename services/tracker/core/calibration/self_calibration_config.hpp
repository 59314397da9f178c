// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// What is learned about the camera while it runs.
struct SelfCalibrationConfig {
  bool readout = true;            // how long reading a picture takes; false: readout_s is true
  double readout_s = 0;           // from the first row to the last (rolling shutter), to start with
  double readout_sigma_s = 0.02;  // its standard deviation
  double tolerated_readout_error_s = 0.001;  // nearer to readout_s than this nothing is changed
  bool focal_length = true;                  // false: the given one is true
  double focal_sigma = 0.05;                 // standard deviation of the given one, as a share of it
  double tolerated_focal_error =
      0.01;             // share; nearer to the given focal length than this nothing is changed
  double memory = 0.9;  // share of what was known that still counts after the next keyframe
  bool operator==(const SelfCalibrationConfig&) const = default;
};

}  // namespace rds::tracker
