// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "tools/simulator/simulation.hpp"

namespace rds::simulator {

/// Makes the folder and its sub-folders, empty.
///
/// @throws std::runtime_error with one sentence if it cannot be written, or holds a recording and !force.
void prepare_folder(const std::filesystem::path& folder, bool force);

/// Writes a simulation as a TUM RGB-D folder with its truth.
///
/// rgb/ depth/ masks/ rgb.txt depth.txt groundtruth.txt camera.yaml people.json objects.json
/// detections_truth.jsonl; of a floor also truth.ot (write_truth_map()), and if asked for odometry.txt and
/// imu.txt (dead_reckoning()). The lists come last, so that a folder that was not finished is not taken for a
/// recording.
class DatasetWriter {
 public:
  /// @param folder  as prepare_folder() left it.
  DatasetWriter(const Simulation& simulation, std::filesystem::path folder);

  /// Writes the pictures of one frame; different frames may be written by different threads.
  /// @throws std::runtime_error naming the file that could not be written.
  void write(int index, const SimulatedFrame& frame);

  /// Writes everything that is about the whole recording. Call once, after all frames.
  void finish() const;

 private:
  [[nodiscard]] std::string stamp(int index) const;
  void write_text(const std::string& name, const std::string& text) const;
  [[nodiscard]] std::vector<geometry::StampedPose> path() const;
  [[nodiscard]] std::string groundtruth() const;
  [[nodiscard]] std::string odometry() const;
  [[nodiscard]] std::string imu() const;
  [[nodiscard]] std::string people() const;
  [[nodiscard]] std::string objects() const;
  [[nodiscard]] std::string detections() const;
  [[nodiscard]] std::string camera() const;

  const Simulation& simulation_;
  std::filesystem::path folder_;
  std::vector<std::vector<PersonTruth>> people_;
  std::vector<std::vector<VisibleObject>> visible_;
};

}  // namespace rds::simulator
