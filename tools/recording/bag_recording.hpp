// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/geometry/lens.hpp"
#include "common/image/recording.hpp"
#include "tools/recording/picture_makers.hpp"
#include "tools/recording/stream.hpp"

namespace rds::recording {

class BagTopics;

/// An RGB-D camera's topics in a bag, found by their types: colour and depth (Image or CompressedImage), the
/// CameraInfo beside colour, and, if there is a topic with "ground" and "truth" in its name, the true path
/// (PoseStamped or Odometry); the robot's other sensors (RobotTopics). Depth of another size or frame is
/// registered to colour, by the CameraInfo beside depth and tf_static.
///
/// Of several topics of one kind those of this project's names are taken, then those that a name marks as
/// colour or as registered depth, then those with the most pictures.
class BagRecording final : public image::Recording {
 public:
  /// Reads the whole bag once; keeps where the pictures lie.
  /// @return or one sentence that names the file and what was expected.
  static tl::expected<std::unique_ptr<BagRecording>, std::string> open(const std::filesystem::path& path);

  /// Which topics are read, and what is wrong with a bag that is torn; for the user, one sentence a line.
  [[nodiscard]] const std::string& notes() const { return notes_; }
  [[nodiscard]] const Stream& color_stream() const { return color_; }
  [[nodiscard]] const Stream& depth_stream() const { return depth_; }

  [[nodiscard]] tl::expected<image::ColorImage, std::string> load_color(std::size_t index) const override;
  [[nodiscard]] tl::expected<image::DepthImage, std::string> load_depth(std::size_t index) const override;

 private:
  BagRecording(std::filesystem::path path, std::unique_ptr<Bag> bag)
      : path_(std::move(path)), bag_(std::move(bag)) {}
  tl::expected<void, std::string> choose(const BagTopics& found);
  tl::expected<geometry::Lens, std::string> take_camera(const BagTopics& found);
  tl::expected<void, std::string> register_pictures(const BagTopics& found, const geometry::Lens& color_lens);
  [[nodiscard]] std::optional<cv::Size> first_depth_size() const;
  [[nodiscard]] tl::unexpected<std::string> fault(const std::string& text) const;
  [[nodiscard]] std::string place_of(const Stream& stream, std::size_t index) const;

  std::filesystem::path path_;
  std::unique_ptr<Bag> bag_;
  Stream color_;
  Stream depth_;
  PictureMakers make_;
  cv::Size depth_size_;  // as they are in the bag
  std::string notes_;
};

}  // namespace rds::recording
