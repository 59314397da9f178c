// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <opencv2/core.hpp>

#include "tools/simulator/rendering/lens.hpp"
#include "tools/simulator/rendering/rasterizer.hpp"

namespace rds::simulator {

/// Objects from here on are people: object = kFirstPerson + id.
inline constexpr std::uint16_t kFirstPerson = 0xF000;

/// Soft round shadow on the floor.
struct Shadow {
  Eigen::Vector2f center = Eigen::Vector2f::Zero();  // in the world [m]
  float radius = 0.4F;
  float strength = 0.4F;
};

/// What an ideal camera sees.
struct Rendering {
  cv::Mat color;     // CV_32FC3, BGR, 0 … 255 and above
  cv::Mat depth;     // CV_32FC1 along the optical axis at the pixel's middle [m]; 0 where nothing is
  cv::Mat object;    // CV_16UC1, Triangle::object
  cv::Mat cosine;    // CV_32FC1 between ray and surface normal
  cv::Mat infrared;  // CV_32FC1, Material::infrared
};

/// Renders meshes with textures, baked light and 2×2 anti-aliasing, as seen through the camera's lens. One
/// instance per thread; keeps its buffers.
class Renderer {
 public:
  explicit Renderer(const geometry::CameraModel& camera);

  /// The camera without distortion that sees all that the camera sees.
  [[nodiscard]] const geometry::CameraModel& ideal_camera() const { return lens_.ideal(); }

  /// @param meshes  all share `appearance`.
  void render(std::span<const Mesh* const> meshes, const Appearance& appearance,
              std::span<const Shadow> shadows, const geometry::Pose& world_from_camera, Rendering& out);

 private:
  void shade_row(int y, const Appearance& appearance, std::span<const Shadow> shadows,
                 const geometry::Pose& world_from_camera, Rendering& out) const;

  Lens lens_;
  Rasterizer rasterizer_;
};

}  // namespace rds::simulator
